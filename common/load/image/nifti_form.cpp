#include "common/load/image/nifti_form.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"
#include "common/math/quaternion.h"

namespace palpate {

bool spans_volume(const UniformTopology& topology) noexcept {
  constexpr double kFlat = 1e-9;
  const Mat3& axes = topology.axes;
  const double steps = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return std::abs(glm::determinant(axes)) > kFlat * steps && std::isfinite(steps) &&
         is_finite(topology.origin);
}

std::optional<UniformTopology> place_by(const NiftiQform& qform, const Index3& points, double unit) noexcept {
  const auto [b, c, d] = qform.quaternion;
  const double squares = b * b + c * c + d * d;
  constexpr double kRounding = 1e-3;  // of writers in single precision
  if (!(squares <= 1.0 + kRounding)) return std::nullopt;
  // So near to one the rest is rounding, as niftilib has it: half a turn.
  constexpr double kHalfTurn = 1e-7;
  const bool half = 1.0 - squares < kHalfTurn;
  const double length = half ? std::sqrt(squares) : 1.0;
  const Quat rotation(half ? 0.0 : std::sqrt(1.0 - squares), b / length, c / length, d / length);
  UniformTopology place{.points = points};
  place.axes = glm::mat3_cast(rotation);
  for (int axis = 0; axis < 3; ++axis) {
    const double step = std::abs(qform.steps[as_size(axis) + 1]);
    place.axes[axis] *= unit * (step == 0.0 ? 1.0 : step);
    place.origin[axis] = unit * qform.offset[as_size(axis)];
  }
  if (qform.steps[0] < 0.0) place.axes[2] = -place.axes[2];
  return spans_volume(place) ? std::optional(place) : std::nullopt;
}

std::optional<NiftiQform> qform_of(const Mat3& axes) noexcept {
  constexpr double kSquare = 1e-4;
  NiftiQform qform;
  Mat3 unit{1.0};
  for (int c = 0; c < 3; ++c) {
    const double step = glm::length(axes[c]);
    qform.steps[as_size(c) + 1] = step;
    unit[c] = axes[c] / step;
  }
  for (int c = 0; c < 3; ++c)
    if (!(std::abs(glm::dot(unit[c], unit[(c + 1) % 3])) <= kSquare)) return std::nullopt;
  qform.steps[0] = glm::determinant(unit) < 0.0 ? -1.0 : 1.0;
  unit[2] *= qform.steps[0];
  Vec3 part = short_vector_part(glm::normalize(glm::quat_cast(unit)));
  // Of half a turn readers find the scalar part as the root of what single precision leaves of one: none is left.
  constexpr double kRounded = 2.5e-4, kOverOne = 1.0 + 1.2e-7;
  if (1.0 - glm::dot(part, part) < kRounded * kRounded) part *= kOverOne / glm::length(part);
  qform.quaternion = {part.x, part.y, part.z};
  return qform;
}

}  // namespace palpate
