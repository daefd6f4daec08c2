#include "loaders/cardiac/ex_reader.h"

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
#include "loaders/cardiac/ex_values.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate::ex {
namespace {

/// More fields, components, versions, corners or factors than any model has: a claim that is a mistake.
constexpr std::int64_t kMostFields = 1000;
constexpr std::int64_t kMostComponents = 100;
constexpr std::int64_t kMostVersions = 10'000;
constexpr std::int64_t kMostDerivatives = 7;
constexpr std::int64_t kMostNumber = 2'000'000'000;
constexpr std::int64_t kMostScales = 100'000;
constexpr int kNewestVersion = 3;
constexpr int kLabels = 2;       // from which on parameters have labels in place of indices
constexpr int kLocalScales = 3;  // from which on scale factors are counted in their own set

/// The number behind `key` in a line: "#Versions= 3".
std::optional<double> number_behind(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + key.size());
  const std::size_t first = rest.find_first_not_of(" \t=");
  if (first == std::string_view::npos) return {};
  rest = rest.substr(first);
  return palpate::number(rest.substr(0, rest.find_first_of(" ,;(")));
}

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
      if (line.starts_with("Group name") || line.starts_with("Region")) continue;
      if (line.starts_with("Node group") || line.starts_with("Element group")) {
        skip_numbers();
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
      } else if (line.starts_with("Values")) {
        lines_.refuse("has values at grid points of an element", "values at nodes");
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
    const std::string_view line = lines_.line();
    if (dimension_ != 3) return;
    if (line.find("polygon") != std::string_view::npos)
      lines_.refuse("has polygon elements", "products of lines and simplices");
    // "Shape. Dimension=3, simplex(2;3)*simplex*simplex", with or without the comma
    const std::size_t first = line.find_first_of("ls", line.find('=') + 1);
    if (first == std::string_view::npos) return;
    const std::vector<std::string_view> axes = split(line.substr(first), '*');
    if (axes.size() != 3) lines_.refuse("is no shape of three dimensions", "\"line*line*line\"");
    for (std::size_t a = 0; a < 3; ++a) linked_[a] = trimmed(axes[a]).starts_with("simplex");
    if (std::count(linked_.begin(), linked_.end(), true) == 1)
      lines_.refuse("has a simplex of one axis", "two or three that are linked");
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

  /// "value", "d/ds1", "d2/ds1ds2(2)": with a number in brackets, which is 1 where there is none.
  std::pair<int, int> label_and_number(std::string_view word) {
    static constexpr std::array<std::string_view, 8> kKinds{
        "value", "d/ds1", "d/ds2", "d2/ds1ds2", "d/ds3", "d2/ds1ds3", "d2/ds2ds3", "d3/ds1ds2ds3"};
    const std::size_t bracket = word.find('(');
    const auto* const kind = std::find(kKinds.begin(), kKinds.end(), word.substr(0, bracket));
    double count = 1.0;
    if (bracket != std::string_view::npos)
      count = number(word.substr(bracket + 1, word.find(')', bracket) - bracket - 1)).value_or(0.0);
    if (kind == kKinds.end() || !(count >= 1.0 && count <= static_cast<double>(kMostVersions)) ||
        count != static_cast<double>(static_cast<int>(count)))
      lines_.refuse("has \"" + std::string(word.substr(0, 40)) + "\"", "value, d/ds1, … or d3/ds1ds2ds3");
    return {static_cast<int>(kind - kKinds.begin()), static_cast<int>(count)};
  }

  /// " x. #Values=5 (value(2),d/ds1(2),d/ds2)": of each label all versions, one after the other.
  void labels(NodeComponent& component) {
    const std::int64_t count = claim("#Values", 1, kMostVersions);
    const std::string_view line = lines_.line();
    const std::size_t open = line.find('(', line.find("#Values"));
    const std::size_t close = line.rfind(')');
    if (open == std::string_view::npos || close < open) lines_.refuse("lists no values", "\"(value,d/ds1)\"");
    for (const std::string_view word : split(line.substr(open + 1, close - open - 1), ',')) {
      const auto [kind, versions] = label_and_number(trimmed(word));
      for (int v = 0; v < versions; ++v) component.labels.push_back({kind, v});
    }
    if (static_cast<std::int64_t>(component.labels.size()) != count)
      lines_.refuse("lists " + std::to_string(component.labels.size()) + " values", std::to_string(count));
    component.count = static_cast<int>(count);
  }

  void node() {
    if (model_.node_headers.empty()) lines_.refuse("comes before the fields", "#Fields first");
    (void)lines_.word_here();  // "Node:"
    const std::int64_t name = lines_.integer("the number of a node", 0, kMostNumber);
    if (data_points_) ++model_.data_points;
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
                    "the same ones, or every node once");
  }

  ElementField element_field() {
    ElementField field;
    const std::int64_t components = begin_field(field);
    for (std::int64_t c = 0; c < components; ++c) field.components.push_back(element_component());
    return field;
  }

  Basis basis(std::string_view word) {
    static constexpr std::array<std::pair<std::string_view, Basis>, 6> kKnown{
        {{"l.Lagrange", Basis::kLinear},
         {"q.Lagrange", Basis::kQuadratic},
         {"c.Lagrange", Basis::kCubic},
         {"c.Hermite", Basis::kHermite},
         {"l.simplex", Basis::kLinearSimplex},
         {"q.simplex", Basis::kQuadraticSimplex}}};
    // The first axis of a simplex names those that are linked to it: "l.simplex(2;3)".
    for (const auto& [name, value] : kKnown)
      if (word == name || (is_simplex(value) && word.substr(0, word.find('(')) == name)) return value;
    lines_.refuse("has the basis " + std::string(word.substr(0, 40)),
                  "l.Lagrange, q.Lagrange, c.Lagrange, c.Hermite, l.simplex or q.simplex");
  }

  Winding winding(std::string_view text) {
    static constexpr std::array<std::pair<std::string_view, Winding>, 5> kKnown{
        {{"no modify", Winding::kNone},
         {"increasing in xi1", Winding::kIncreasing},
         {"decreasing in xi1", Winding::kDecreasing},
         {"non-increasing in xi1", Winding::kNonIncreasing},
         {"non-decreasing in xi1", Winding::kNonDecreasing}}};
    for (const auto& [name, value] : kKnown)
      if (text == name) return value;
    lines_.refuse("has the modification \"" + std::string(text.substr(0, 40)) + "\"",
                  "no modify, or increasing or decreasing in xi1");
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
    if (axes.size() != 3 || parts.size() < 3)
      lines_.refuse("is no component of three dimensions", "\"NAME. BASIS*BASIS*BASIS, no modify, …\"");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      component.basis[axis] = basis(trimmed(axes[axis]));
      if (is_simplex(component.basis[axis]) != linked_[axis])
        lines_.refuse("has the basis " + std::string(trimmed(parts.front()).substr(0, 60)),
                      "one of the element's shape");
    }
    const auto simplex = std::find_if(component.basis.begin(), component.basis.end(), is_simplex);
    if (std::any_of(component.basis.begin(), component.basis.end(),
                    [&](Basis b) { return is_simplex(b) && b != *simplex; }))
      lines_.refuse("links axes of two bases", "one basis for them");
    const std::size_t corners = node_count(component.basis), each = component.of_corner();
    component.winding = winding(trimmed(parts[1]));
    const std::string_view map = trimmed(parts[2]);
    if (!map.starts_with("standard node based") && !map.starts_with("general node based"))
      lines_.refuse("is " + std::string(map.substr(0, 40)), "standard or general node based");
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
      const auto [kind, version] = label_and_number(word);
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
    // A face or line has a zero first and its own number behind; its parts are passed over.
    const bool volume = dimension_ == 3 && name != 0;
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.starts_with("Faces")) {
        skip_numbers();
      } else if (line.starts_with("Nodes:")) {
        (void)lines_.word_here();
        for (int n = 0; n < current_.nodes; ++n)
          element.nodes.push_back(lines_.integer("a node of the element", 0, kMostNumber));
      } else if (line.starts_with("Scale factors:")) {
        (void)lines_.word_here();
        (void)lines_.word_here();
        for (std::int64_t s = 0; s < current_.scales; ++s)
          element.scales.push_back(lines_.number("a scale factor"));
      } else if (!line.empty()) {
        lines_.give_back();
        break;
      }
    }
    if (!volume) return;
    if (!current_.in_elements) lines_.refuse("comes before the fields", "#Fields first");
    element.header = current_.header;
    if (model_.element_headers[element.header].empty()) return;  // a member of a group
    if (static_cast<int>(element.nodes.size()) != current_.nodes)
      lines_.refuse("ends element " + std::to_string(name) + " without its nodes",
                    std::to_string(current_.nodes) + " nodes");
    model_.elements.push_back(std::move(element));
  }

  /// Passes over lines of numbers.
  void skip_numbers() {
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      const bool numbers =
          line.empty() || std::isdigit(static_cast<unsigned char>(line.front())) != 0 || line.front() == '-';
      if (numbers) continue;
      lines_.give_back();
      return;
    }
  }

  /// What the nodes or elements that follow are like.
  struct Template {
    std::uint32_t header = 0;
    int nodes = 0;            ///< of an element
    int values = 0;           ///< of a node
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
  std::string defined_;  ///< the template whose definition is being read
  std::map<std::string, Template> templates_;
  std::map<std::string, std::int64_t> scale_set_first_;
};

}  // namespace

void read_ex_file(const std::string& file, Model& model) { Reader(file, model).read(); }

}  // namespace palpate::ex
