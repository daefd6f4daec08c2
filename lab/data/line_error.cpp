#include "lab/data/line_error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/base/quantile.h"

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

const char* name_of(Meeting meeting) noexcept {
  switch (meeting) {
    case Meeting::kCompared:
      return "compared";
    case Meeting::kInside:
      return "inside";
    case Meeting::kElsewhere:
      return "ended elsewhere";
    case Meeting::kUnfinished:
      return "not finished";
    case Meeting::kMissing:
      break;
  }
  return "missing";
}

LineComparison compare_lines(std::span<const Line> lines, std::span<const Line> reference, double spacing,
                             double diagonal, bool to_the_end) {
  std::map<std::pair<std::uint32_t, TraceDirection>, const Line*> by_seed;
  for (const Line& line : lines) by_seed[{line.seed, line.direction}] = &line;
  const auto judge = [&](const Line& truth) {
    LineJudgement judgement{.seed = truth.seed,
                            .direction = truth.direction,
                            .reference_end = truth.end,
                            .error = HUGE_VAL,
                            .stated = std::nan("")};
    const auto found = by_seed.find({truth.seed, truth.direction});
    if (found == by_seed.end() || found->second->points.empty() || truth.points.empty()) return judgement;
    const Line& line = *found->second;
    judgement.end = line.end;
    judgement.stated = line.points.back().error / diagonal;
    if (ends_inside(line, diagonal) && ends_inside(truth, diagonal)) {
      judgement.meeting = Meeting::kInside;
      return judgement;
    }
    const bool same_end = to_the_end && line.end == truth.end;
    if (!same_end && std::abs(line.points.back().arc - truth.points.back().arc) > spacing) {
      judgement.meeting = line.end == End::kMaxSteps ? Meeting::kUnfinished : Meeting::kElsewhere;
      return judgement;
    }
    double distance = line_distance(line, truth, spacing, same_end);
    if (std::isnan(distance)) distance = line_distance(line, truth, spacing, true);  // shorter than S
    judgement.meeting = Meeting::kCompared;
    judgement.error = distance / diagonal;
    return judgement;
  };

  LineComparison result;
  std::vector<double> errors, stated;
  std::size_t covered = 0;
  for (const Line& truth : reference) {
    const LineJudgement& judgement = result.lines.emplace_back(judge(truth));
    switch (judgement.meeting) {
      case Meeting::kInside:
        ++result.inside;
        continue;
      case Meeting::kCompared:
        ++result.compared;
        if (!std::isnan(judgement.stated)) stated.push_back(judgement.stated);
        result.max = std::max(result.max, judgement.error);
        if (judgement.error <= judgement.stated) ++covered;
        break;
      case Meeting::kElsewhere:
        ++result.elsewhere;
        break;
      case Meeting::kUnfinished:
        ++result.unfinished;
        break;
      case Meeting::kMissing:
        ++result.missing;
    }
    errors.push_back(judgement.error);
  }
  result.judged = errors.size();
  result.median = quantile(errors, 0.5);
  result.p95 = quantile(errors, 0.95);
  result.stated = quantile(stated, 0.95);
  if (result.compared == 0) result.max = std::nan("");
  result.covered = result.judged > 0 && (result.compared == 0 || !stated.empty())
                       ? static_cast<double>(covered) / static_cast<double>(result.judged)
                       : std::nan("");
  return result;
}

}  // namespace palpate
