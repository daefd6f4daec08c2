#include "loaders/cardiac/ex_values.h"

#include <algorithm>
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

}  // namespace palpate::ex
