#include "loaders/cardiac/ex/ex_words.h"

#include <algorithm>
#include <array>
#include <string>

#include "common/base/text.h"

namespace palpate::ex {

std::optional<double> number_behind(std::string_view line, std::string_view key) {
  const std::size_t at = line.find(key);
  if (at == std::string_view::npos) return {};
  std::string_view rest = line.substr(at + key.size());
  const std::size_t first = rest.find_first_not_of(" \t=");
  if (first == std::string_view::npos) return {};
  rest = rest.substr(first);
  return number(rest.substr(0, rest.find_first_of(" ,;(")));
}

Basis basis_of(const TextLines& lines, std::string_view word) {
  static constexpr std::array<std::pair<std::string_view, Basis>, 7> kKnown{
      {{"constant", Basis::kConstant},
       {"l.Lagrange", Basis::kLinear},
       {"q.Lagrange", Basis::kQuadratic},
       {"c.Lagrange", Basis::kCubic},
       {"c.Hermite", Basis::kHermite},
       {"l.simplex", Basis::kLinearSimplex},
       {"q.simplex", Basis::kQuadraticSimplex}}};
  // The first axis of a simplex names those that are linked to it: "l.simplex(2;3)".
  for (const auto& [name, value] : kKnown)
    if (word == name || (is_simplex(value) && word.substr(0, word.find('(')) == name)) return value;
  lines.refuse("has the basis " + std::string(word.substr(0, 40)),
               "constant, l.Lagrange, q.Lagrange, c.Lagrange, c.Hermite, l.simplex or q.simplex");
}

Winding winding_of(const TextLines& lines, std::string_view text) {
  static constexpr std::array<std::pair<std::string_view, Winding>, 5> kKnown{
      {{"no modify", Winding::kNone},
       {"increasing in xi1", Winding::kIncreasing},
       {"decreasing in xi1", Winding::kDecreasing},
       {"non-increasing in xi1", Winding::kNonIncreasing},
       {"non-decreasing in xi1", Winding::kNonDecreasing}}};
  for (const auto& [name, value] : kKnown)
    if (text == name) return value;
  lines.refuse("has the modification \"" + std::string(text.substr(0, 40)) + "\"",
               "no modify, or increasing or decreasing in xi1");
}

std::pair<int, int> label_and_number(const TextLines& lines, std::string_view word) {
  static constexpr std::array<std::string_view, 8> kKinds{"value", "d/ds1",     "d/ds2",     "d2/ds1ds2",
                                                          "d/ds3", "d2/ds1ds3", "d2/ds2ds3", "d3/ds1ds2ds3"};
  const std::size_t bracket = word.find('(');
  const auto* const kind = std::find(kKinds.begin(), kKinds.end(), word.substr(0, bracket));
  double count = 1.0;
  if (bracket != std::string_view::npos)
    count = number(word.substr(bracket + 1, word.find(')', bracket) - bracket - 1)).value_or(0.0);
  if (kind == kKinds.end() || !(count >= 1.0 && count <= static_cast<double>(kMostVersions)) ||
      count != static_cast<double>(static_cast<int>(count)))
    lines.refuse("has \"" + std::string(word.substr(0, 40)) + "\"", "value, d/ds1, … or d3/ds1ds2ds3");
  return {static_cast<int>(kind - kKinds.begin()), static_cast<int>(count)};
}

std::vector<ValueLabel> labels_of(const TextLines& lines, std::size_t count) {
  const std::string_view line = lines.line();
  const std::size_t open = line.find('(', line.find("#Values"));
  const std::size_t close = line.rfind(')');
  if (open == std::string_view::npos || close < open) lines.refuse("lists no values", "\"(value,d/ds1)\"");
  std::vector<ValueLabel> labels;
  for (const std::string_view word : split(line.substr(open + 1, close - open - 1), ',')) {
    const auto [kind, versions] = label_and_number(lines, trimmed(word));
    for (int v = 0; v < versions; ++v) labels.push_back({kind, v});
  }
  if (labels.size() != count)
    lines.refuse("lists " + std::to_string(labels.size()) + " values", std::to_string(count));
  return labels;
}

Linked linked_axes(const TextLines& lines) {
  const std::string_view line = lines.line();
  Linked linked{};
  if (line.find("polygon") != std::string_view::npos)
    lines.refuse("has polygon elements", "products of lines and simplices");
  const std::size_t first = line.find_first_of("ls", line.find('=') + 1);
  if (first == std::string_view::npos) return linked;
  const std::vector<std::string_view> axes = split(line.substr(first), '*');
  if (axes.size() != linked.size()) lines.refuse("is no shape of three dimensions", "\"line*line*line\"");
  for (std::size_t a = 0; a < linked.size(); ++a) linked[a] = trimmed(axes[a]).starts_with("simplex");
  if (std::count(linked.begin(), linked.end(), true) == 1)
    lines.refuse("has a simplex of one axis", "two or three that are linked");
  return linked;
}

}  // namespace palpate::ex
