#include "common/field/tensor/peak_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/index.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// [mm^2/s].
constexpr double kMeanDiffusivity = 0.7e-3;
/// Of the outer voxels' centres [voxels]: a place that rounding has put beyond.
constexpr double kRounding = 1e-9;
/// Of kWidest.
constexpr double kLeastCosine = 0.5 * std::numbers::sqrt2;
static_assert(PeakField::kWidest == 45.0);
/// Of lengths: peaks of a voxel that are as long but for rounding.
constexpr double kLonger = 1.0 + 1e-4;

}  // namespace

Mat3 fibre_tensor(const Vec3& unit, double fa) noexcept {
  // Eigenvalues MD (1 + 2 t), MD (1 - t) twice: FA = sqrt(3 t^2 / (1 + 2 t^2)).
  const double t = fa / std::sqrt(3.0 - 2.0 * fa * fa);
  return kMeanDiffusivity * (Mat3{1.0 - t} + 3.0 * t * glm::outerProduct(unit, unit));
}

PeakField::PeakField(const UniformTopology& voxels, const DataArray& peaks)
    : voxels_(voxels),
      index_from_data_(glm::inverse(voxels.axes)),
      most_(as_size(peaks.components) / 3),
      peaks_(peaks.tuples * 3 * most_) {
  for (std::size_t p = 0; p < peaks.tuples; ++p) {
    for (std::size_t n = 0; n < most_; ++n) {
      Vec3 peak{0.0};
      for (int c = 0; c < 3; ++c) peak[c] = peaks.at(p, static_cast<int>(3 * n) + c);
      const double length = glm::length(peak);
      if (!(length > 0.0) || !std::isfinite(length)) peak = Vec3{0.0};
      for (int c = 0; c < 3; ++c) peaks_[3 * (p * most_ + n) + as_size(c)] = static_cast<float>(peak[c]);
    }
  }
}

Vec3 PeakField::at(std::size_t voxel, std::size_t n) const noexcept {
  const float* const peak = peaks_.data() + 3 * (voxel * most_ + n);
  return {peak[0], peak[1], peak[2]};
}

Vec3 PeakField::nearest_of(std::size_t voxel, const Vec3& toward) const noexcept {
  Vec3 nearest{0.0};
  double best = -1.0;
  for (std::size_t n = 0; n < most_; ++n) {
    const Vec3 peak = at(voxel, n);
    if (peak == Vec3{0.0}) continue;
    const double cosine = std::abs(glm::dot(peak, toward)) / glm::length(peak);
    if (!(cosine > best)) continue;
    best = cosine;
    nearest = peak;
  }
  return nearest;
}

PeakField::Sample PeakField::sample(const Vec3& x, const Vec3& toward) const noexcept {
  Sample result;
  Vec3 u = index_from_data_ * (x - voxels_.origin);
  Index3 cell{0};
  for (int axis = 0; axis < 3; ++axis) {
    const int last = voxels_.points[axis] - 1;
    if (!(u[axis] >= -kRounding && u[axis] <= last + kRounding)) return result;
    cell[axis] = std::clamp(static_cast<int>(u[axis]), 0, std::max(last - 1, 0));
    u[axis] = std::clamp(u[axis] - cell[axis], 0.0, 1.0);
  }
  Mat3 sum{0.0};
  double followed = 0.0, there = 0.0;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Index3 step{static_cast<int>(corner & 1U), static_cast<int>((corner >> 1U) & 1U),
                      static_cast<int>(corner >> 2U)};
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) weight *= step[axis] == 1 ? u[axis] : 1.0 - u[axis];
    if (!(weight > 0.0)) continue;
    const Vec3 peak = nearest_of(index_in(voxels_.points, cell + step), toward);
    const double length = glm::length(peak);
    if (!(length > 0.0)) continue;
    there += weight;
    if (std::abs(glm::dot(peak, toward)) < kLeastCosine * length) continue;
    followed += weight;
    sum += weight * fibre_tensor(peak / length, std::min(length, 1.0));
  }
  constexpr double kMostMissing = 0.5;
  result.status = followed > kMostMissing ? SampleStatus::kOk : SampleStatus::kBadData;
  if (result.status == SampleStatus::kOk) {
    result.value = sum / followed;
  } else {
    result.turned_away = there > kMostMissing;
  }
  return result;
}

std::size_t PeakField::voxel_at(const Vec3& x) const noexcept {
  const Vec3 u = glm::round(index_from_data_ * (x - voxels_.origin));
  for (int axis = 0; axis < 3; ++axis) {
    if (!(u[axis] >= 0.0 && u[axis] < voxels_.points[axis])) return kNone;
  }
  return index_in(voxels_.points, Index3{u});
}

Vec3 PeakField::peak(const Vec3& x, std::size_t n) const noexcept {
  const std::size_t voxel = voxel_at(x);
  return voxel == kNone ? Vec3{0.0} : at(voxel, n);
}

Vec3 PeakField::longest(const Vec3& x) const noexcept {
  Vec3 longest{0.0};
  for (std::size_t n = 0; n < most_; ++n) {
    const Vec3 one = peak(x, n);
    if (glm::length(one) > kLonger * glm::length(longest)) longest = one;
  }
  return longest;
}

Vec3 PeakField::nearest(const Vec3& x, const Vec3& toward) const noexcept {
  const std::size_t voxel = voxel_at(x);
  return voxel == kNone ? Vec3{0.0} : nearest_of(voxel, toward);
}

}  // namespace palpate
