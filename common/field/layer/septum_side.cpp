#include "common/field/layer/septum_side.h"

#include <algorithm>
#include <cstddef>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr double kMost = 0.75;       // of a part's area that says what all of it is
constexpr double kNearlyAll = 0.95;  // likewise, of a cavity that creases do not part

/// What the way through the wall ends in.
enum class Behind : std::uint8_t { kUnknown, kFree, kLeft };

/// Fills what is not known from beside, within a part of the right ventricle, and takes single triangles for what
/// most of those beside them are.
void spread(const WallBorder& border, const std::vector<std::int64_t>& part_of, std::vector<Behind>& of) {
  std::vector<std::vector<std::uint32_t>> beside(of.size());
  for (const auto& [a, b] : border.joints) {
    if (part_of[a] < 0 || part_of[a] != part_of[b]) continue;
    beside[a].push_back(b);
    beside[b].push_back(a);
  }
  std::vector<std::uint32_t> front;
  for (std::size_t t = 0; t < of.size(); ++t)
    if (of[t] != Behind::kUnknown) front.push_back(static_cast<std::uint32_t>(t));
  for (std::size_t i = 0; i < front.size(); ++i) {
    const std::uint32_t from = front[i];  // `front` may move
    for (const std::uint32_t t : beside[from]) {
      if (of[t] != Behind::kUnknown) continue;
      of[t] = of[from];
      front.push_back(t);
    }
  }
  constexpr int kRounds = 4;
  for (int round = 0; round < kRounds; ++round) {
    const std::vector<Behind> before = of;
    for (std::size_t t = 0; t < of.size(); ++t) {
      const auto others = std::count_if(beside[t].begin(), beside[t].end(),
                                        [&](std::uint32_t b) { return before[b] != before[t]; });
      if (2 * as_size(others) > beside[t].size()) {
        const auto other = std::find_if(beside[t].begin(), beside[t].end(),
                                        [&](std::uint32_t b) { return before[b] != before[t]; });
        of[t] = before[*other];
      }
    }
  }
}

}  // namespace

SeptumSide find_septum_side(const TetMesh& mesh, const WallBorder& border, std::span<const BorderRole> roles,
                            std::span<const RightPart> parts) {
  const WallCrossing crossing(mesh, border);
  std::vector<Behind> behind(border.triangles.size(), Behind::kUnknown);
  std::vector<std::int64_t> part_of(border.triangles.size(), -1);
  double mixed = 0.0, right = 0.0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    double left = 0.0, free = 0.0;
    for (const std::uint32_t t : parts[p].triangles) {
      part_of[t] = static_cast<std::int64_t>(p);
      const std::size_t met = crossing.from(t);
      const BorderRole role = met < roles.size() ? roles[met] : BorderRole::kLeft;
      if (role == BorderRole::kInner) behind[t] = Behind::kLeft;
      if (role == BorderRole::kOuter || role == BorderRole::kRight) behind[t] = Behind::kFree;
      if (behind[t] == Behind::kLeft) left += glm::length(border.areas[t]);
      if (behind[t] == Behind::kFree) free += glm::length(border.areas[t]);
    }
    right += parts[p].area;
    // The septum of a cavity of one part may be a small share of it.
    const double most = parts[p].one_of_several ? kMost : kNearlyAll;
    const bool all_left = left > most * (left + free), all_free = !(left > (1.0 - most) * (left + free));
    if (!all_left && !all_free) mixed += parts[p].area;
    for (const std::uint32_t t : parts[p].triangles) {
      if (all_left) behind[t] = Behind::kLeft;
      if (all_free) behind[t] = Behind::kFree;
    }
  }
  spread(border, part_of, behind);
  SeptumSide side{.septum = std::vector<bool>(behind.size()), .area = 0.0, .mixed = mixed > 0.5 * right};
  for (std::size_t t = 0; t < behind.size(); ++t) {
    if (part_of[t] < 0 || behind[t] != Behind::kLeft) continue;
    side.septum[t] = true;
    side.area += glm::length(border.areas[t]);
  }
  return side;
}

}  // namespace palpate
