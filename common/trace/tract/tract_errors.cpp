#include "common/trace/tract/tract_errors.h"

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

#include "common/base/index.h"

namespace palpate {

LineErrors tract_errors(const TractResult& result, double diagonal, std::optional<double> tolerance) {
  // Points are single, and chords are shorter than curves.
  constexpr double kSlack = 1.01;
  LineErrors errors;
  if (tolerance) errors.within = 0;
  std::vector<double> held;
  const std::vector<float>& stated = result.lines.of_points[0].values;
  for (std::size_t l = 0; l < result.lines.line_count(); ++l) {
    const auto line = result.lines.line(l);
    if (line.empty()) continue;
    const auto first = as_size(&line.front() - result.lines.points.data());
    const std::span<const float> of_line = std::span(stated).subspan(first, line.size());
    const double error = *std::ranges::max_element(of_line);
    errors.max = std::max(errors.max, error);
    if (error < kUnheldError * diagonal) {
      held.push_back(error);
    } else {
      errors.unheld_seeds.push_back(result.seeds[l]);
    }
    if (!tolerance) continue;
    const auto seed = as_size(std::ranges::min_element(of_line) - of_line.begin());
    double before = 0.0, after = 0.0;
    for (std::size_t i = 1; i < line.size(); ++i)
      (i <= seed ? before : after) += glm::distance(Vec3{line[i]}, Vec3{line[i - 1]});
    if (of_line.front() <= kSlack * *tolerance * before && of_line.back() <= kSlack * *tolerance * after)
      ++*errors.within;
  }
  summarise(std::move(held), errors);
  return errors;
}

}  // namespace palpate
