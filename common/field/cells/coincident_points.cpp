#include "common/field/cells/coincident_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "common/base/index.h"

namespace palpate {

LostValues find_lost_values(const FieldGrid& grid, std::span<const DataSet> blocks, const PointValue& value) {
  LostValues out;
  if (grid.point_of_input.empty()) return out;
  std::vector<Vec3> first(grid.point_count());
  std::vector<std::uint8_t> known(first.size(), 0);
  std::vector<double> jumps;
  double largest = 0.0;
  std::size_t input = 0;
  for (const DataSet& block : blocks) {
    for (std::size_t i = 0; i < block.point_count(); ++i, ++input) {
      const std::uint32_t p = grid.point_of_input[input];
      if (p == kNoPoint || (!block.visible.empty() && block.visible[i] == 0)) continue;
      const Vec3 here = value(block, i);
      if (is_finite(here)) largest = std::max(largest, glm::length(here));
      if (std::exchange(known[p], std::uint8_t{1}) == 0) {
        first[p] = here;
      } else if (is_finite(here) && is_finite(first[p]) && here != first[p]) {
        jumps.push_back(glm::distance(here, first[p]));
      }
    }
  }
  for (const double jump : jumps) {
    if (!(jump > kSameValue * largest)) continue;
    ++out.points;
    out.most = std::max(out.most, jump);
  }
  return out;
}

CoincidentPoints::CoincidentPoints(std::span<const DataSet> blocks, const PointValue& value)
    : blocks_(blocks), value_(value), first_point_{0} {
  for (const DataSet& block : blocks) first_point_.push_back(first_point_.back() + block.point_count());
}

std::size_t CoincidentPoints::block_of(std::uint32_t input) const {
  const auto above = std::ranges::upper_bound(first_point_, std::size_t{input});
  return as_size(above - first_point_.begin()) - 1;
}

Vec3 CoincidentPoints::value(std::uint32_t input) const {
  const std::size_t block = block_of(input);
  return value_(blocks_[block], input - first_point_[block]);
}

double CoincidentPoints::jump(std::uint32_t a, std::uint32_t b) const {
  const Vec3 u = value(a), v = value(b);
  // Two places without a value are alike.
  if (!is_finite(u) || !is_finite(v)) return is_finite(u) == is_finite(v) ? 0.0 : HUGE_VAL;
  return glm::distance(u, v);
}

PointsAgree CoincidentPoints::agree() const {
  if (!distinguishable()) return {};
  return [this](std::uint32_t a, std::uint32_t b) {
    const double step = jump(a, b);
    if (step == 0.0 || !std::isfinite(step)) return step == 0.0;
    return step <= kSameValue * std::max({glm::length(value(a)), glm::length(value(b)), largest_});
  };
}

void CoincidentPoints::find(const TetMesh& mesh, std::span<const std::uint32_t> point_of_input) {
  const std::span<const Vec3> points = mesh.points();
  std::vector<double> spacing(points.size(), -1.0);
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    for (std::size_t face = 0; face < 4; ++face) {
      if (mesh.neighbors()[c][face] != kNoCell) continue;
      for (std::size_t i = 1; i < 4; ++i) spacing[mesh.cells()[c][(face + i) % 4]] = 0.0;
    }
  }
  for (const TetMesh::Tet& tet : mesh.cells()) {
    for (std::size_t i = 0; i < 4; ++i) {
      for (std::size_t j = i + 1; j < 4; ++j) {
        const double length = glm::distance(points[tet[i]], points[tet[j]]);
        for (const std::uint32_t v : {tet[i], tet[j]}) {
          if (spacing[v] >= 0.0 && length > 0.0 && (spacing[v] == 0.0 || length < spacing[v]))
            spacing[v] = length;
        }
      }
    }
  }
  input_of_.assign(points.size(), kNoPoint);
  for (std::size_t i = point_of_input.size(); i-- > 0;) {
    if (point_of_input[i] != kNoPoint) input_of_[point_of_input[i]] = static_cast<std::uint32_t>(i);
  }
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!(spacing[p] > 0.0) || input_of_[p] == kNoPoint) continue;
    const auto block = static_cast<std::uint32_t>(block_of(input_of_[p]));
    candidates_.push_back({static_cast<std::uint32_t>(p), spacing[p], block, true});
    if (!distinguishable()) continue;
    const double size = glm::length(value(input_of_[p]));
    if (std::isfinite(size)) largest_ = std::max(largest_, size);
  }
  place_ = merge_points(points, candidates_, kMergeDistance);
}

std::vector<std::uint32_t> CoincidentPoints::first_of(const TetMesh& mesh,
                                                      std::span<const std::uint32_t> point_of_input,
                                                      std::span<const std::uint8_t> apart) {
  const std::span<const Vec3> points = mesh.points();
  const auto at_wall = [&](std::size_t p) { return !apart.empty() && apart[p] != 0; };
  for (MergeCandidate& p : candidates_) p.within_block = !at_wall(p.point);
  std::vector<std::uint32_t> joined = place_;
  if (distinguishable()) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (place_[p] == p || at_wall(p)) continue;
      const double size = jump(input_of_[p], input_of_[place_[p]]);
      if (size > widest_ && std::isfinite(size)) widest_ = size;
    }
  }
  if (distinguishable() || !apart.empty()) {
    const PointsAgree alike = agree();
    const PointsAgree points_agree = [&](std::uint32_t a, std::uint32_t b) {
      return !alike || alike(input_of_[a], input_of_[b]);
    };
    joined = merge_points(points, candidates_, kMergeDistance, points_agree, apart.empty());
  }
  std::size_t merged = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    merged += joined[p] != p ? 1 : 0;
    apart_ += joined[p] == p && place_[p] != p && !at_wall(p) ? 1 : 0;
  }
  if (merged == 0) return {};
  std::vector<std::uint32_t> out(point_of_input.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t p = point_of_input[i];
    out[i] = p == kNoPoint ? static_cast<std::uint32_t>(i) : input_of_[joined[p]];
  }
  return out;
}

void CoincidentPoints::note(FieldNotes& notes) const {
  if (apart_ == 0) return;
  std::array<char, 200> text{};
  std::snprintf(
      text.data(), text.size(),
      "%zu %s of values of their own, which jump by up to %.3g: each cell keeps its own, and the jump "
      "counts into the error of the lines that cross",
      apart_, apart_ == 1 ? "point shares its place with one" : "points share their places with others",
      widest_);
  notes.lines.emplace_back(text.data());
}

}  // namespace palpate
