#include "loaders/cardiac/ex_reader.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <optional>
#include <string_view>
#include <utility>

#include "common/base/number_text.h"
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

/// The number behind `key` in a line: "#Versions= 3".
std::optional<double> number_behind(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + key.size());
  const std::size_t first = rest.find_first_not_of(" \t=");
  if (first == std::string_view::npos) return {};
  rest = rest.substr(first);
  return palpate::number(rest.substr(0, rest.find_first_of(" ,(")));
}

class Reader {
 public:
  Reader(const std::string& file, Model& model) : lines_(file), model_(model) {}

  void read() {
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.empty() || line.starts_with('!')) continue;
      if (line.starts_with("EX Version")) {
        lines_.refuse("is EX format version 2 or later", "a format before it",
                      "write it with Zinc's FIELDML or as VTK, or with an older cmgui");
      }
      if (line.starts_with("Group name") || line.starts_with("Region")) continue;
      if (line.starts_with("Shape.")) {
        shape();
      } else if (line.starts_with("#Scale factor sets")) {
        scale_sets();
      } else if (line.starts_with("#Nodes")) {
        nodes_of_element_ = static_cast<int>(claim("#Nodes", 0, kMostComponents));
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
    in_elements_ = true;
    const std::string_view line = lines_.line();
    for (const char* other : {"simplex", "polygon"}) {
      if (dimension_ == 3 && line.find(other) != std::string_view::npos)
        lines_.refuse(std::string("has ") + other + " elements", "products of three lines");
    }
  }

  void scale_sets() {
    in_elements_ = true;
    const std::int64_t sets = claim("#Scale factor sets", 0, kMostFields);
    scales_of_element_ = 0;
    for (std::int64_t s = 0; s < sets; ++s) {
      next_line("a set of scale factors");
      scales_of_element_ += claim("#Scale factors", 0, kMostScales);
      if (scales_of_element_ > kMostScales) lines_.refuse("claims too many scale factors", "100000 at most");
    }
  }

  void fields() {
    const std::int64_t count = claim("#Fields", 0, kMostFields);
    if (in_elements_) {
      std::vector<ElementField> header;
      for (std::int64_t f = 0; f < count; ++f) header.push_back(element_field());
      model_.element_headers.push_back(std::move(header));
    } else {
      values_of_node_ = 0;
      std::vector<NodeField> header;
      for (std::int64_t f = 0; f < count; ++f) header.push_back(node_field());
      model_.node_headers.push_back(std::move(header));
    }
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

  NodeField node_field() {
    NodeField field;
    const std::int64_t components = begin_field(field);
    for (std::int64_t c = 0; c < components; ++c) {
      const std::string_view line = next_line("a component");
      NodeComponent component;
      component.name = line.substr(0, line.find('.'));
      component.first = static_cast<int>(claim("Value index", 1, kMostNumber)) - 1;
      component.derivatives = static_cast<int>(claim("#Derivatives", 0, kMostDerivatives));
      if (line.find("#Versions") != std::string_view::npos)
        component.versions = static_cast<int>(claim("#Versions", 1, kMostVersions));
      if (component.first != values_of_node_)
        lines_.refuse("puts its first value at " + std::to_string(component.first + 1),
                      std::to_string(values_of_node_ + 1) + ", behind the component before");
      values_of_node_ += (component.derivatives + 1) * component.versions;
      field.components.push_back(std::move(component));
    }
    return field;
  }

  void node() {
    if (model_.node_headers.empty()) lines_.refuse("comes before the fields", "#Fields first");
    (void)lines_.word_here();  // "Node:"
    const std::int64_t name = lines_.integer("the number of a node", 0, kMostNumber);
    Node node;
    node.header = static_cast<std::uint32_t>(model_.node_headers.size() - 1);
    const std::size_t line = lines_.line_number();
    for (int v = 0; v < values_of_node_; ++v) node.values.push_back(lines_.number("a value of the node"));
    if (!model_.nodes.emplace(name, std::move(node)).second)
      lines_.refuse(
          "ends node " + std::to_string(name) + " (line " + std::to_string(line) + ") for a second time",
          "every node once");
  }

  ElementField element_field() {
    ElementField field;
    const std::int64_t components = begin_field(field);
    for (std::int64_t c = 0; c < components; ++c) field.components.push_back(element_component());
    return field;
  }

  Basis basis(std::string_view word) {
    static constexpr std::array<std::pair<std::string_view, Basis>, 4> kKnown{
        {{"l.Lagrange", Basis::kLinear},
         {"q.Lagrange", Basis::kQuadratic},
         {"c.Lagrange", Basis::kCubic},
         {"c.Hermite", Basis::kHermite}}};
    for (const auto& [name, value] : kKnown)
      if (word == name) return value;
    lines_.refuse("has the basis " + std::string(word.substr(0, 40)),
                  "l.Lagrange, q.Lagrange, c.Lagrange or c.Hermite");
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
    std::size_t corners = 1;
    std::size_t each = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      component.basis[axis] = basis(trimmed(axes[axis]));
      corners *= static_cast<std::size_t>(node_count(component.basis[axis]));
      each *= static_cast<std::size_t>(parameter_count(component.basis[axis]));
    }
    component.winding = winding(trimmed(parts[1]));
    const std::string_view map = trimmed(parts[2]);
    if (!map.starts_with("standard node based") && !map.starts_with("general node based"))
      lines_.refuse("is " + std::string(map.substr(0, 40)), "standard or general node based");
    next_line("#Nodes");
    if (claim("#Nodes", 1, kMostComponents) != static_cast<std::int64_t>(corners))
      lines_.refuse("has another number of nodes than the basis", std::to_string(corners));
    for (std::size_t k = 0; k < corners; ++k) component.corners.push_back(corner(each));
    return component;
  }

  Corner corner(std::size_t each) {
    Corner corner;
    const std::string_view line = next_line("a node of the component");
    const auto node = number(line.substr(0, line.find('.')));
    if (!node || !(*node >= 1.0 && *node <= static_cast<double>(kMostComponents)))
      lines_.refuse("names no node of the element", "\"1. #Values=…\"");
    corner.node = static_cast<int>(*node) - 1;
    if (claim("#Values", 1, kMostComponents) != static_cast<std::int64_t>(each))
      lines_.refuse("has another number of values than the basis", std::to_string(each));
    const auto indices = [&](const char* keyword, std::int64_t least, std::vector<int>& out) {
      if (!next_line(keyword).starts_with(keyword)) lines_.refuse("is out of place", keyword);
      while (lines_.word_here().find(':') == std::string_view::npos) {
        if (lines_.line().find(':') == std::string_view::npos) lines_.refuse("lacks a colon", keyword);
      }
      for (std::size_t v = 0; v < each; ++v)
        out.push_back(static_cast<int>(lines_.integer("an index", least, kMostNumber)) - 1);
    };
    indices("Value indices", 1, corner.values);
    indices("Scale factor indices", 0, corner.scales);
    return corner;
  }

  void element() {
    (void)lines_.word_here();  // "Element:"
    const std::int64_t name = lines_.integer("the number of an element", 0, kMostNumber);
    Element element;
    element.name = name;
    element.line = lines_.line_number();
    // A face or line has a zero first and its own number behind; its parts are passed over.
    const bool volume = dimension_ == 3 && name != 0;
    while (lines_.next()) {
      const std::string_view line = lines_.line();
      if (line.starts_with("Faces")) {
        skip_numbers();
      } else if (line.starts_with("Nodes:")) {
        (void)lines_.word_here();
        for (int n = 0; n < nodes_of_element_; ++n)
          element.nodes.push_back(lines_.integer("a node of the element", 0, kMostNumber));
      } else if (line.starts_with("Scale factors:")) {
        (void)lines_.word_here();
        (void)lines_.word_here();
        for (std::int64_t s = 0; s < scales_of_element_; ++s)
          element.scales.push_back(lines_.number("a scale factor"));
      } else if (!line.empty()) {
        lines_.give_back();
        break;
      }
    }
    if (!volume) return;
    if (model_.element_headers.empty()) lines_.refuse("comes before the fields", "#Fields first");
    element.header = static_cast<std::uint32_t>(model_.element_headers.size() - 1);
    if (static_cast<int>(element.nodes.size()) != nodes_of_element_)
      lines_.refuse("ends element " + std::to_string(name) + " without its nodes",
                    std::to_string(nodes_of_element_) + " nodes");
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

  TextLines lines_;
  Model& model_;
  bool in_elements_ = false;
  int dimension_ = 3;
  int nodes_of_element_ = 0;
  int values_of_node_ = 0;
  std::int64_t scales_of_element_ = 0;
};

}  // namespace

void read_ex_file(const std::string& file, Model& model) { Reader(file, model).read(); }

}  // namespace palpate::ex
