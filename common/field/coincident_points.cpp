#include "common/field/coincident_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string>

#include "common/base/index.h"

namespace palpate {

CoincidentPoints::CoincidentPoints(std::span<const DataSet> blocks, const PointValue* value)
    : blocks_(blocks), value_(value), first_point_{0} {
  for (const DataSet& block : blocks) first_point_.push_back(first_point_.back() + block.point_count());
}

Vec3 CoincidentPoints::value(std::uint32_t input) const {
  const auto above = std::ranges::upper_bound(first_point_, std::size_t{input});
  const auto block = as_size(above - first_point_.begin()) - 1;
  return (*value_)(blocks_[block], input - first_point_[block]);
}

double CoincidentPoints::jump(std::uint32_t a, std::uint32_t b) const {
  const Vec3 u = value(a), v = value(b);
  // Two places without a value are alike.
  if (!is_finite(u) || !is_finite(v)) return is_finite(u) == is_finite(v) ? 0.0 : HUGE_VAL;
  return glm::distance(u, v);
}

PointsAgree CoincidentPoints::agree() const {
  if (value_ == nullptr || !*value_) return {};
  return [this](std::uint32_t a, std::uint32_t b) {
    const double step = jump(a, b);
    if (step == 0.0 || !std::isfinite(step)) return step == 0.0;
    return step <= kSameValue * std::max({glm::length(value(a)), glm::length(value(b)), largest_});
  };
}

std::vector<std::uint32_t> CoincidentPoints::first_of(const TetMesh& mesh,
                                                      std::span<const std::uint32_t> point_of_input) {
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
  std::vector<std::uint32_t> input_of(points.size(), kNoPoint);
  for (std::size_t i = point_of_input.size(); i-- > 0;) {
    if (point_of_input[i] != kNoPoint) input_of[point_of_input[i]] = static_cast<std::uint32_t>(i);
  }
  const bool told_apart = value_ != nullptr && static_cast<bool>(*value_);
  std::vector<MergeCandidate> candidates;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (!(spacing[p] > 0.0) || input_of[p] == kNoPoint) continue;
    candidates.push_back({static_cast<std::uint32_t>(p), spacing[p], 0, true});
    if (!told_apart) continue;
    const double size = glm::length(value(input_of[p]));
    if (std::isfinite(size)) largest_ = std::max(largest_, size);
  }
  const std::vector<std::uint32_t> place = merge_points(points, candidates, kMergeDistance);
  std::vector<std::uint32_t> joined = place;
  if (told_apart) {
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (place[p] == p) continue;
      const double size = jump(input_of[p], input_of[place[p]]);
      if (size > widest_ && std::isfinite(size)) widest_ = size;
    }
    const PointsAgree alike = agree();
    joined = merge_points(points, candidates, kMergeDistance,
                          [&](std::uint32_t a, std::uint32_t b) { return alike(input_of[a], input_of[b]); });
  }
  std::size_t merged = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    merged += joined[p] != p ? 1 : 0;
    apart_ += joined[p] == p && place[p] != p ? 1 : 0;
  }
  if (merged == 0) return {};
  std::vector<std::uint32_t> out(point_of_input.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const std::uint32_t p = point_of_input[i];
    out[i] = p == kNoPoint ? static_cast<std::uint32_t>(i) : input_of[joined[p]];
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
