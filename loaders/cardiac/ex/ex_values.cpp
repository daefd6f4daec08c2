#include "loaders/cardiac/ex/ex_values.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate::ex {
namespace {

/// Whether a line is one of numbers, or empty.
bool is_of_numbers(std::string_view line) {
  return line.empty() || std::isdigit(static_cast<unsigned char>(line.front())) != 0 || line.front() == '-';
}

constexpr std::int64_t kMostElement = 2'000'000'000;

void pass_over_string(TextLines& lines) {
  std::string_view word = lines.word();
  if (word.empty()) lines.refuse("ends too early", "a string");
  const char quote = word.front();
  if (quote != '"' && quote != '\'') return;
  word.remove_prefix(1);
  const auto ends = [quote](std::string_view text) {
    const bool escaped = text.size() > 1 && text[text.size() - 2] == '\\';
    return text.ends_with(quote) && !escaped;
  };
  while (!ends(word)) {
    word = lines.word();
    if (word.empty()) lines.refuse("ends within a string", std::string(1, quote));
  }
}

void pass_over_place(TextLines& lines, int xi) {
  std::string_view word = lines.word();
  if (word.starts_with('/')) word = lines.word();  // a region
  if (word.empty()) lines.refuse("ends too early", "a place in an element");
  if (!number(word)) {
    (void)lines.integer("the number of an element", -1, kMostElement);
    xi = static_cast<int>(lines.integer("the dimension of an element", 0, 3));
  }
  for (int n = 0; n < xi; ++n) (void)lines.number("a place in an element");
}

/// Of a field whose components stand one behind the other.
std::span<const double> values_of(const Node& node, const NodeField& field) {
  std::size_t count = 0;
  for (const NodeComponent& component : field.components) count += as_size(component.count);
  return std::span(node.values).subspan(as_size(field.components.front().first), count);
}

/// Whether a component means the same in both lists of an element's nodes, factors and values.
bool same_component(const ElementComponent& a, const Element& in_a, const ElementComponent& b,
                    const Element& in_b) {
  if (a.name != b.name || a.basis != b.basis || a.winding != b.winding ||
      a.grid.has_value() != b.grid.has_value())
    return false;
  if (a.grid) {
    const auto values = [](const ElementGrid& grid, const Element& element) {
      return std::span(element.values).subspan(grid.first, grid.count());
    };
    return a.grid->intervals == b.grid->intervals &&
           std::ranges::equal(values(*a.grid, in_a), values(*b.grid, in_b));
  }
  const auto node = [](const Parameter& p, const Element& element) {
    return p.node >= 0 && p.node < static_cast<int>(element.nodes.size()) ? element.nodes[as_size(p.node)]
                                                                          : -1;
  };
  const auto factor = [](const Parameter& p, const Element& element) {
    return p.scale >= 0 && p.scale < static_cast<int>(element.scales.size())
               ? element.scales[as_size(p.scale)]
               : 1.0;
  };
  return std::ranges::equal(a.parameters, b.parameters, [&](const Parameter& p, const Parameter& q) {
    return node(p, in_a) == node(q, in_b) && p.value == q.value && p.label == q.label &&
           factor(p, in_a) == factor(q, in_b);
  });
}

bool same_field(const ElementField& a, const Element& in_a, const ElementField& b, const Element& in_b) {
  return a.system == b.system && a.focus == b.focus &&
         std::ranges::equal(a.components, b.components,
                            [&](const ElementComponent& p, const ElementComponent& q) {
                              return same_component(p, in_a, q, in_b);
                            });
}

}  // namespace

double node_value(TextLines& lines, const NodeField& field) {
  if (field.kind == ValueKind::kNumber) return lines.number("a value of the node");
  if (field.kind == ValueKind::kString) pass_over_string(lines);
  if (field.kind == ValueKind::kElementXi) pass_over_place(lines, field.xi);
  return std::numeric_limits<double>::quiet_NaN();
}

std::string add_fields(const Node& again, Model& model, Node& there) {
  std::vector<NodeField> header = model.node_headers[there.header];
  for (const NodeField& field : model.node_headers[again.header]) {
    const auto before = std::find_if(header.begin(), header.end(),
                                     [&](const NodeField& known) { return known.name == field.name; });
    const std::span<const double> values = values_of(again, field);
    if (before != header.end()) {
      const std::span<const double> known = values_of(there, *before);
      const bool same =
          std::equal(values.begin(), values.end(), known.begin(), known.end(),
                     [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); });
      if (same) continue;
      return field.name;
    }
    NodeField added = field;
    const int shift = static_cast<int>(there.values.size()) - field.components.front().first;
    for (NodeComponent& component : added.components) component.first += shift;
    header.push_back(std::move(added));
    there.values.insert(there.values.end(), values.begin(), values.end());
  }
  if (header.size() == model.node_headers[there.header].size()) return {};
  const auto [joined, is_new] = model.joined_headers.try_emplace(
      {there.header, again.header}, static_cast<std::uint32_t>(model.node_headers.size()));
  if (is_new) model.node_headers.push_back(std::move(header));
  there.header = joined->second;
  return {};
}

std::string add_fields(const Element& again, Model& model, Element& there) {
  std::vector<ElementField> header = model.element_headers[there.header];
  const std::size_t before = header.size();
  for (const ElementField& field : model.element_headers[again.header]) {
    const auto known = std::find_if(header.begin(), header.begin() + static_cast<std::ptrdiff_t>(before),
                                    [&](const ElementField& one) { return one.name == field.name; });
    if (known != header.begin() + static_cast<std::ptrdiff_t>(before)) {
      if (!same_field(*known, there, field, again)) return field.name;
      continue;
    }
    ElementField added = field;
    for (ElementComponent& component : added.components) {
      if (component.grid) component.grid->first += there.values.size();
      for (Parameter& parameter : component.parameters) {
        if (parameter.node >= 0) parameter.node += static_cast<int>(there.nodes.size());
        if (parameter.scale >= 0) parameter.scale += static_cast<int>(there.scales.size());
      }
    }
    header.push_back(std::move(added));
  }
  if (header.size() == before) return {};
  const auto [joined, is_new] = model.joined_element_headers.try_emplace(
      {there.header, again.header}, static_cast<std::uint32_t>(model.element_headers.size()));
  if (is_new) model.element_headers.push_back(std::move(header));
  there.header = joined->second;
  there.nodes.insert(there.nodes.end(), again.nodes.begin(), again.nodes.end());
  there.scales.insert(there.scales.end(), again.scales.begin(), again.scales.end());
  there.values.insert(there.values.end(), again.values.begin(), again.values.end());
  return {};
}

void pass_numbers(TextLines& lines) {
  while (lines.next()) {
    if (is_of_numbers(lines.line())) continue;
    lines.give_back();
    return;
  }
}

std::vector<std::int64_t> faces_of(TextLines& lines, bool triples) {
  constexpr std::size_t kMostNumbers = 100;
  std::vector<std::int64_t> numbers;
  (void)lines.word_here();  // "Faces:"
  do {
    for (std::string_view word = lines.word_here(); !word.empty(); word = lines.word_here())
      if (numbers.size() < kMostNumbers) numbers.push_back(parsed<std::int64_t>(word).value_or(0));
    if (!lines.next()) break;
    if (is_of_numbers(lines.line())) continue;
    lines.give_back();
    break;
  } while (true);
  if (!triples) return numbers;
  std::vector<std::int64_t> faces;
  for (std::size_t n = 1; n < numbers.size(); n += 3) faces.push_back(numbers[n]);
  return faces;
}

}  // namespace palpate::ex
