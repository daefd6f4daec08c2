#include "loaders/cardiac/ex/ex_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/cardiac/ex/ex_values.h"
#include "loaders/cardiac/ex/ex_words.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate::ex {
namespace {

/// More fields, components, versions, corners or factors than any model has: a claim that is a mistake.
constexpr std::int64_t kMostFields = 1000;
constexpr std::int64_t kMostComponents = 100;
constexpr std::int64_t kMostDerivatives = 7;
constexpr std::int64_t kMostNumber = 2'000'000'000;
constexpr std::int64_t kMostScales = 100'000;
constexpr int kMostGridValues = 10'000'000;  // of an element
constexpr int kNewestVersion = 3;
constexpr int kLabels = 2;       // from which on parameters have labels in place of indices
constexpr int kLocalScales = 3;  // from which on scale factors are counted in their own set

class Reader {
 public:
  Reader(const std::string& file, Model& model) : lines_(file), model_(model) {}

  void read() {
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.starts_with("!#")) {
        // Points of data share the numbers of nodes.
        if (line.starts_with("!#nodeset")) data_points_ = line.find("datapoints") != std::string_view::npos;
        continue;
      }
      if (line.empty() || line.starts_with('!')) continue;
      if (line.starts_with("EX Version")) {
        version_ = static_cast<int>(claim("EX Version:", 1, kNewestVersion));
        continue;
      }
      if (line.starts_with("Group name") || line.starts_with("Region")) {
        group_ = line.starts_with("Group") ? name_behind_colon() : std::string();
        continue;
      }
      if (line.starts_with("Node group") || line.starts_with("Element group")) {
        pass_numbers(lines_);
      } else if (line.starts_with("Define ")) {
        defined_ = name_behind_colon();
      } else if (line.starts_with("Node template") || line.starts_with("Element template")) {
        use_template();
      } else if (line.starts_with("Shape.")) {
        shape();
      } else if (line.starts_with("#Scale factor sets")) {
        scale_sets();
      } else if (line.starts_with("#Nodes")) {
        current_.nodes = static_cast<int>(claim("#Nodes", 0, kMostComponents));
      } else if (line.starts_with("#Fields")) {
        fields();
      } else if (line.starts_with("Node:")) {
        node();
      } else if (line.starts_with("Element:")) {
        element();
      } else {
        lines_.refuse("has \"" + std::string(line.substr(0, 40)) + "\"", "a keyword of the EX format");
      }
    }
  }

 private:
  /// The whole number behind `key` in this line.
  std::int64_t claim(std::string_view key, std::int64_t least, std::int64_t most) {
    const auto value = number_behind(lines_.line(), key);
    if (!value || !(*value >= static_cast<double>(least) && *value <= static_cast<double>(most)) ||
        *value != static_cast<double>(static_cast<std::int64_t>(*value))) {
      lines_.refuse("does not say how many there are behind " + std::string(key),
                    "a whole number from " + std::to_string(least) + " to " + std::to_string(most));
    }
    return static_cast<std::int64_t>(*value);
  }

  /// Goes to the next line that is not empty.
  std::string_view next_line(const char* expected) {
    do {
      if (!lines_.next()) lines_.refuse("ends too early", expected);
    } while (lines_.line().empty());
    return lines_.line();
  }

  void shape() {
    dimension_ = static_cast<int>(claim("Dimension", 0, 3));
    in_elements_ = dimension_ > 0;
    linked_ = {};
    if (dimension_ == 3) linked_ = linked_axes(lines_);
  }

  std::string name_behind_colon() const {
    const std::size_t colon = lines_.line().find(':');
    return colon == std::string_view::npos ? std::string()
                                           : std::string(trimmed(lines_.line().substr(colon + 1)));
  }

  /// Version 3 of the format names its headers, and goes back to them.
  void use_template() {
    const auto found = templates_.find(name_behind_colon());
    if (found == templates_.end())
      lines_.refuse("names a template that is not defined", "one defined before");
    current_ = found->second;
    in_elements_ = current_.in_elements;
    dimension_ = current_.dimension;
    linked_ = current_.linked;
  }

  void scale_sets() {
    in_elements_ = true;
    scale_set_first_.clear();
    const std::int64_t sets = claim("#Scale factor sets", 0, kMostFields);
    current_.scales = 0;
    for (std::int64_t s = 0; s < sets; ++s) {
      const std::string_view line = next_line("a set of scale factors");
      scale_set_first_[std::string(trimmed(line.substr(0, line.find(','))))] = current_.scales;
      current_.scales += claim("#Scale factors", 0, kMostScales);
      if (current_.scales > kMostScales) lines_.refuse("claims too many scale factors", "100000 at most");
    }
  }

  void fields() {
    const std::int64_t count = claim("#Fields", 0, kMostFields);
    if (in_elements_) {
      current_.values = 0;
      std::vector<ElementField> header;
      for (std::int64_t f = 0; f < count; ++f) header.push_back(element_field());
      current_.header = static_cast<std::uint32_t>(model_.element_headers.size());
      model_.element_headers.push_back(std::move(header));
    } else {
      current_.values = 0;
      std::vector<NodeField> header;
      for (std::int64_t f = 0; f < count; ++f) header.push_back(node_field());
      current_.header = static_cast<std::uint32_t>(model_.node_headers.size());
      model_.node_headers.push_back(std::move(header));
    }
    current_.in_elements = in_elements_;
    current_.dimension = dimension_;
    current_.linked = linked_;
    if (!defined_.empty()) templates_[std::exchange(defined_, {})] = current_;
  }

  /// " 1) coordinates, coordinate, prolate spheroidal, focus= 0.3525E+02, #Components=3"
  template <typename Field>
  std::int64_t begin_field(Field& field) {
    const std::string_view line = next_line("a field");
    const std::size_t after = line.find(')');
    if (after == std::string_view::npos) lines_.refuse("is no field", "\"1) NAME, TYPE, SYSTEM, …\"");
    std::vector<std::string_view> parts = split(line.substr(after + 1), ',');
    for (std::string_view& part : parts) part = trimmed(part);
    field.name = parts.front();
    const auto says = [&](std::string_view word) {
      return std::find(parts.begin(), parts.end(), word) != parts.end();
    };
    if (says("prolate spheroidal")) {
      field.system = System::kProlate;
      const auto focus = number_behind(line, "focus");
      if (!focus || !(*focus > 0.0)) lines_.refuse("has no focus above zero", "focus= NUMBER");
      field.focus = *focus;
    } else if (says("cylindrical polar")) {
      field.system = System::kCylindrical;
    } else if (says("oblate spheroidal") || says("spherical polar")) {
      lines_.refuse("has coordinates that are not read",
                    "rectangular cartesian, cylindrical polar or prolate spheroidal ones");
    }
    return claim("#Components", 1, kMostComponents);
  }

  /// Of the current line.
  void kind_of(NodeField& field) {
    const std::string_view line = lines_.line();
    for (std::string_view part : split(line.substr(std::min(line.find(','), line.size())), ',')) {
      part = trimmed(part);
      if (part == "string") field.kind = ValueKind::kString;
      if (part == "element_xi") field.kind = ValueKind::kElementXi;
    }
    if (field.kind == ValueKind::kNumber) return;
    if (line.find("#xi") != std::string_view::npos) field.xi = static_cast<int>(claim("#xi", 1, 3));
    model_.left_out.insert(field.name +
                           (field.kind == ValueKind::kString ? " (string)" : " (places in elements)"));
  }

  NodeField node_field() {
    NodeField field;
    const std::int64_t components = begin_field(field);
    kind_of(field);
    for (std::int64_t c = 0; c < components; ++c) {
      const std::string_view line = next_line("a component");
      NodeComponent component;
      component.name = line.substr(0, line.find('.'));
      if (line.find("#Values") != std::string_view::npos) {
        component.first = current_.values;
        labels(component);
      } else {
        component.first = static_cast<int>(claim("Value index", 1, kMostNumber)) - 1;
        component.count = 1 + static_cast<int>(claim("#Derivatives", 0, kMostDerivatives));
        if (line.find("#Versions") != std::string_view::npos)
          component.count *= static_cast<int>(claim("#Versions", 1, kMostVersions));
        if (component.first != current_.values)
          lines_.refuse("puts its first value at " + std::to_string(component.first + 1),
                        std::to_string(current_.values + 1) + ", behind the component before");
      }
      current_.values += component.count;
      field.components.push_back(std::move(component));
    }
    return field;
  }

  /// " x. #Values=5 (value(2),d/ds1(2),d/ds2)": of each label all versions, one after the other.
  void labels(NodeComponent& component) {
    const std::int64_t count = claim("#Values", 1, kMostVersions);
    component.labels = labels_of(lines_, as_size(count));
    component.count = static_cast<int>(count);
  }

  void node() {
    if (model_.node_headers.empty()) lines_.refuse("comes before the fields", "#Fields first");
    (void)lines_.word_here();  // "Node:"
    const std::int64_t name = lines_.integer("the number of a node", 0, kMostNumber);
    if (data_points_) ++model_.data_points;
    if (!data_points_ && !group_.empty()) model_.groups[group_].nodes.insert(name);
    if (current_.in_elements || current_.values == 0) return;  // a member of a group
    Node node;
    node.header = current_.header;
    const std::size_t line = lines_.line_number();
    for (const NodeField& field : model_.node_headers[node.header])
      for (const NodeComponent& component : field.components)
        for (int v = 0; v < component.count; ++v) node.values.push_back(node_value(lines_, field));
    if (data_points_) return;
    const auto [at, is_new] = model_.nodes.try_emplace(name, node);
    if (is_new) return;
    const std::string differs = add_fields(node, model_, at->second);
    if (!differs.empty())
      lines_.refuse("ends node " + std::to_string(name) + " (line " + std::to_string(line) +
                        ") for a second time, with other values of \"" + differs + "\"",
                    "the same ones, or every node once", "write each time to an .exnode file of its own");
  }

  ElementField element_field() {
    ElementField field;
    const std::int64_t components = begin_field(field);
    for (std::int64_t c = 0; c < components; ++c) field.components.push_back(element_component());
    return field;
  }

  /// "lambda.  c.Hermite*c.Hermite*c.Hermite, no modify, standard node based." and its corners
  ElementComponent element_component() {
    const std::string_view line = next_line("a component");
    ElementComponent component;
    const std::size_t dot = line.find('.');
    if (dot == std::string_view::npos) lines_.refuse("is no component", "\"NAME. BASIS, …\"");
    component.name = line.substr(0, dot);
    const std::vector<std::string_view> parts = split(line.substr(dot + 1), ',');
    const std::vector<std::string_view> axes = split(trimmed(parts.front()), '*');
    component.basis.fill(Basis::kConstant);  // along what axes a line or a face lacks
    if (static_cast<int>(axes.size()) != dimension_ || parts.size() < 3)
      lines_.refuse("is no component of " + counted(as_size(dimension_), "dimension"),
                    "\"NAME. BASIS*BASIS*BASIS, no modify, …\", a basis for each");
    for (std::size_t axis = 0; axis < axes.size(); ++axis) {
      component.basis[axis] = basis_of(lines_, trimmed(axes[axis]));
      if (dimension_ == 3 && component.basis[axis] != Basis::kConstant &&
          is_simplex(component.basis[axis]) != linked_[axis])
        lines_.refuse("has the basis " + std::string(trimmed(parts.front()).substr(0, 60)),
                      "one of the element's shape");
    }
    const auto simplex = std::find_if(component.basis.begin(), component.basis.end(), is_simplex);
    if (std::any_of(component.basis.begin(), component.basis.end(),
                    [&](Basis b) { return is_simplex(b) && b != *simplex; }))
      lines_.refuse("links axes of two bases", "one basis for them");
    const std::size_t corners = node_count(component.basis), each = component.of_corner();
    component.winding = winding_of(lines_, trimmed(parts[1]));
    const std::string_view map = trimmed(parts[2]);
    if (map.starts_with("grid based") || map.starts_with("element based")) {
      component.grid = grid_of(component, map.starts_with("grid"));
      return component;
    }
    if (!map.starts_with("standard node based") && !map.starts_with("general node based"))
      lines_.refuse("is " + std::string(map.substr(0, 40)),
                    "standard or general node based, grid based or element based");
    std::int64_t first_scale = 0;
    const std::string set = scale_set(map);
    if (!set.empty() && version_ >= kLocalScales) first_scale = scale_set_first_[set];
    next_line("#Nodes");
    const std::int64_t nodes = claim("#Nodes", 0, kMostComponents);
    if (version_ < kLabels) {
      if (nodes != static_cast<std::int64_t>(corners))
        lines_.refuse("has another number of nodes than the basis", std::to_string(corners));
      for (std::size_t k = 0; k < corners; ++k) corner(each, component.parameters);
    } else {
      while (component.parameters.size() < corners * each)
        labelled(corners * each, !set.empty(), first_scale, component.parameters);
    }
    return component;
  }

  /// " #xi1=4, #xi2=4, #xi3=4" behind a component that is linear or constant between places of its own.
  ElementGrid grid_of(const ElementComponent& component, bool stated) {
    constexpr std::int64_t kMostIntervals = 1000;
    ElementGrid grid{.intervals = {}, .first = as_size(current_.values)};
    for (std::size_t a = 0; a < 3; ++a) {
      const Basis basis = component.basis[a];
      if (basis != Basis::kLinear && basis != Basis::kConstant)
        lines_.refuse("has a basis that values of an element's own are not read with",
                      "l.Lagrange or constant along each axis");
      grid.intervals[a] = basis == Basis::kLinear ? 1 : 0;
    }
    if (stated) {
      next_line("#xi1=");
      for (std::size_t a = 0; a < as_size(dimension_); ++a)
        grid.intervals[a] = static_cast<int>(claim("#xi" + std::to_string(a + 1), 0, kMostIntervals));
    }
    if (grid.count() > kMostGridValues)
      lines_.refuse("claims too many values of an element", "10000000 at most");
    current_.values += static_cast<int>(grid.count());
    if (current_.values > kMostGridValues)
      lines_.refuse("claims too many values of an element", "10000000 at most");
    return grid;
  }

  /// Of "standard node based. scale factor set=NAME"; empty where factors are one.
  std::string scale_set(std::string_view map) {
    constexpr std::string_view kKey = "scale factor set=";
    const std::size_t at = map.find(kKey);
    if (at == std::string_view::npos) return {};
    std::string name(trimmed(map.substr(at + kKey.size())));
    if (!scale_set_first_.contains(name))
      lines_.refuse("names the scale factor set " + name, "one declared above");
    return name;
  }

  /// The local node before ". #Values=": -1 for 0, where functions have no parameter.
  int local_node(int least) {
    const std::string_view word = lines_.line().substr(0, lines_.line().find('.'));
    if (word.find('+') != std::string_view::npos)
      lines_.refuse("sums parameters of several nodes", "one node for each parameter");
    const auto node = number(trimmed(word));
    if (!node || !(*node >= least && *node <= static_cast<double>(kMostComponents)) ||
        *node != static_cast<double>(static_cast<int>(*node)))
      lines_.refuse("names no node of the element", "\"1. #Values=…\"");
    return static_cast<int>(*node) - 1;
  }

  /// Goes behind the colon of a line that begins with `keyword`.
  void begin_list(const char* keyword) {
    if (!next_line(keyword).starts_with(keyword)) lines_.refuse("is out of place", keyword);
    while (lines_.word_here().find(':') == std::string_view::npos) {
      if (lines_.line().find(':') == std::string_view::npos) lines_.refuse("lacks a colon", keyword);
    }
  }

  void corner(std::size_t each, std::vector<Parameter>& parameters) {
    next_line("a node of the component");
    const int node = local_node(1);
    if (claim("#Values", 1, kMostComponents) != static_cast<std::int64_t>(each))
      lines_.refuse("has another number of values than the basis", std::to_string(each));
    const std::size_t first = parameters.size();
    parameters.resize(first + each, {.node = node});
    const auto index = [this](std::int64_t least) {
      return static_cast<int>(lines_.integer("an index", least, kMostNumber)) - 1;
    };
    begin_list("Value indices");
    for (std::size_t v = 0; v < each; ++v) parameters[first + v].value = index(1);
    begin_list("Scale factor indices");
    for (std::size_t v = 0; v < each; ++v) parameters[first + v].scale = index(0);
  }

  /// "1. #Values=3" and its labels: parameters of the next functions, from one node or from none.
  void labelled(std::size_t most, bool scaled, std::int64_t first_scale, std::vector<Parameter>& parameters) {
    next_line("a node of the component");
    const int node = local_node(0);
    const auto count = as_size(claim("#Values", 1, kMostComponents));
    const std::size_t first = parameters.size();
    if (first + count > most)
      lines_.refuse("has more values than the basis", std::to_string(most) + " in all");
    parameters.resize(first + count, {.node = node});
    begin_list("Value labels");
    for (std::size_t v = 0; v < count; ++v) {
      const std::string_view word = lines_.word();
      if (node < 0) {
        if (word != "zero") lines_.refuse("has a parameter without a node", "zero");
        continue;
      }
      if (word.find('+') != std::string_view::npos)
        lines_.refuse("sums parameters", "one label for each function");
      const auto [kind, version] = label_and_number(lines_, word);
      parameters[first + v].label = ValueLabel{kind, version - 1};
    }
    if (!scaled) return;
    begin_list("Scale factor indices");
    for (std::size_t v = 0; v < count; ++v) {
      const int scale = static_cast<int>(lines_.integer("an index of one scale factor", 0, kMostNumber)) - 1;
      if (scale >= 0) parameters[first + v].scale = static_cast<int>(first_scale) + scale;
    }
  }

  void element() {
    (void)lines_.word_here();  // "Element:"
    const std::int64_t name = lines_.integer("the number of an element", 0, kMostNumber);
    Element element;
    element.name = name;
    element.line = lines_.line_number();
    element.linked = current_.linked;
    if (dimension_ == 2 && !group_.empty()) {
      const std::int64_t face = name != 0 ? name : lines_.integer("the number of a face", 0, kMostNumber);
      model_.groups[group_].faces.insert(face);
    }
    // A face or line has a zero first and its own number behind; its parts are passed over.
    const bool volume = dimension_ == 3 && name != 0;
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.starts_with("Faces")) {
        element.faces = faces_of(lines_, version_ < kLabels);
      } else if (line.starts_with("Nodes:")) {
        (void)lines_.word_here();
        for (int n = 0; n < current_.nodes; ++n)
          element.nodes.push_back(lines_.integer("a node of the element", 0, kMostNumber));
      } else if (line.starts_with("Scale factors:")) {
        (void)lines_.word_here();
        (void)lines_.word_here();
        for (std::int64_t s = 0; s < current_.scales; ++s)
          element.scales.push_back(lines_.number("a scale factor"));
      } else if (line.starts_with("Values")) {
        while (lines_.word_here().find(':') == std::string_view::npos)
          if (lines_.line().find(':') == std::string_view::npos) lines_.refuse("lacks a colon", "Values:");
        for (int v = 0; v < current_.values; ++v)
          element.values.push_back(lines_.number("a value of the element"));
      } else if (!line.empty()) {
        lines_.give_back();
        break;
      }
    }
    if (dimension_ < 3 && name != 0 && current_.in_elements &&
        !model_.element_headers[current_.header].empty())
      ++model_.flat_elements[dimension_];
    if (!volume) return;
    if (!current_.in_elements) lines_.refuse("comes before the fields", "#Fields first");
    element.header = current_.header;
    if (model_.element_headers[element.header].empty()) return;  // a member of a group
    if (static_cast<int>(element.nodes.size()) != current_.nodes)
      lines_.refuse("ends element " + std::to_string(name) + " without its nodes",
                    std::to_string(current_.nodes) + " nodes");
    if (static_cast<int>(element.values.size()) != current_.values)
      lines_.refuse("ends element " + std::to_string(name) + " without its values",
                    std::to_string(current_.values) + " values");
    const auto [there, is_new] = model_.element_of_name.try_emplace(name, model_.elements.size());
    if (is_new) {
      model_.elements.push_back(std::move(element));
      return;
    }
    const std::string differs = add_fields(element, model_, model_.elements[there->second]);
    if (!differs.empty())
      lines_.refuse("ends element " + std::to_string(name) + " (line " + std::to_string(element.line) +
                        ") for a second time, with another \"" + differs + "\"",
                    "the same one, or every element once");
  }

  /// What the nodes or elements that follow are like.
  struct Template {
    std::uint32_t header = 0;
    int nodes = 0;            ///< of an element
    int values = 0;           ///< of a node, or of an element's own
    std::int64_t scales = 0;  ///< of an element
    bool in_elements = false;
    int dimension = 3;
    Linked linked{};
  };

  TextLines lines_;
  Model& model_;
  int version_ = 1;
  bool in_elements_ = false, data_points_ = false;
  int dimension_ = 3;
  Linked linked_{};  ///< of the shape that was named last
  Template current_;
  std::string group_;    ///< that is being read; empty: the region itself
  std::string defined_;  ///< the template whose definition is being read
  std::map<std::string, Template> templates_;
  std::map<std::string, std::int64_t> scale_set_first_;
};

}  // namespace

void read_ex_file(const std::string& file, Model& model) { Reader(file, model).read(); }

}  // namespace palpate::ex
