#include "lab/data/line_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace palpate {
namespace {

// Arc lengths that are meant to be equal differ by rounding, which grows along a line of many steps.
constexpr double kSameArc = 1e-7;

/// Index of the point of `line` at `arc`, from `from` on, or the number of points.
std::size_t point_at(const Line& line, double arc, double slack, std::size_t from) {
  std::size_t i = from;
  while (i < line.points.size() && line.points[i].arc < arc - slack) ++i;
  const bool found = i < line.points.size() && line.points[i].arc <= arc + slack;
  return found ? i : line.points.size();
}

/// The smallest value that a part `q` of the values does not exceed. @pre not empty.
double quantile(std::vector<double>& values, double q) {
  std::sort(values.begin(), values.end());
  const auto rank = static_cast<std::size_t>(std::ceil(q * static_cast<double>(values.size())));
  return values[std::clamp<std::size_t>(rank, 1, values.size()) - 1];
}

constexpr double kWoundUp = 0.05;  // of the diagonal

}  // namespace

bool ends_inside(const Line& line, double diagonal) {
  if (line.end == End::kStagnation || line.end == End::kLoop) return true;
  if (line.points.empty() || !(line.points.back().arc > diagonal)) return false;
  Box reach;
  for (auto p = line.points.rbegin(); p != line.points.rend() && p->arc >= 0.5 * line.points.back().arc;
       ++p) {
    reach.include(p->position);
  }
  return reach.diagonal() < kWoundUp * diagonal;
}

double line_distance(const Line& line, const Line& reference, double spacing, bool with_ends) {
  if (line.points.empty() || reference.points.empty()) return std::nan("");
  const double common = std::min(line.points.back().arc, reference.points.back().arc);
  const double slack = kSameArc * spacing;
  double worst = std::nan("");
  const auto include = [&worst](const Vec3& x, const Vec3& y) {
    const double d = glm::distance(x, y);
    if (!(worst >= d)) worst = d;
  };
  std::size_t i = 0;
  std::size_t j = 0;
  for (double k = 1.0; k * spacing <= common + slack; k += 1.0) {
    const std::size_t at = point_at(line, k * spacing, slack, i);
    const std::size_t there = point_at(reference, k * spacing, slack, j);
    if (at == line.points.size() || there == reference.points.size()) continue;
    include(line.points[at].position, reference.points[there].position);
    i = at;
    j = there;
  }
  if (with_ends) include(line.points.back().position, reference.points.back().position);
  return worst;
}

LineComparison compare_lines(std::span<const Line> lines, std::span<const Line> reference, double spacing,
                             double diagonal) {
  std::map<std::pair<std::uint32_t, TraceDirection>, const Line*> references;
  for (const Line& line : reference) references[{line.seed, line.direction}] = &line;

  LineComparison result;
  std::vector<double> errors;
  std::vector<double> stated;
  std::size_t covered = 0;
  for (const Line& line : lines) {
    const auto found = references.find({line.seed, line.direction});
    if (found == references.end()) continue;
    const Line& other = *found->second;
    if (ends_inside(line, diagonal) || ends_inside(other, diagonal)) {
      ++result.sinks;
      continue;
    }
    const bool same_end = line.end == other.end;
    if (!same_end) ++result.different_ends;
    const double distance = line_distance(line, other, spacing, same_end);
    if (std::isnan(distance)) continue;
    errors.push_back(distance / diagonal);
    stated.push_back(line.points.back().error / diagonal);
    if (distance <= line.points.back().error) ++covered;
  }
  result.compared = errors.size();
  if (errors.empty()) {
    result.median = result.p95 = result.max = result.stated = result.covered = std::nan("");
    return result;
  }
  result.median = quantile(errors, 0.5);
  result.p95 = quantile(errors, 0.95);
  result.max = quantile(errors, 1.0);
  result.stated = quantile(stated, 0.95);
  result.covered = static_cast<double>(covered) / static_cast<double>(errors.size());
  return result;
}

}  // namespace palpate
