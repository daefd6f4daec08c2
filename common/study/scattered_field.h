/// Smooth vector fields through a few random vectors: the stimuli of Ikits 2006, sec. 7.1.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

/// A vector and where it was drawn.
struct ScatteredVector {
  Vec3 place{0.0};
  Vec3 vector{0.0};
};

/// Values at `places` of the biharmonic spline through the vectors in the plane (Sandwell 1987, Geophys. Res.
/// Lett. 14:139; `griddata` with 'v4' in Matlab):
///
///   f(x) = sum_j w_j g(|x - x_j|),   g(r) = r^2 (ln r - 1),   f(x_j) = v_j
///
/// of x and y, z is not looked at. @pre no two places are the same.
[[nodiscard]] std::vector<Vec3> biharmonic_spline(std::span<const ScatteredVector> vectors,
                                                  std::span<const Vec3> places);

/// Values at `places` weighted by inverse distance (Shepard 1968):
///
///   f(x) = sum_j w_j v_j / sum_j w_j,   w_j = |x - x_j|^-2;   f(x_j) = v_j
[[nodiscard]] std::vector<Vec3> inverse_distance(std::span<const ScatteredVector> vectors,
                                                 std::span<const Vec3> places);

/// Points of a grid of n.x * n.y * n.z over `bounds`, x fastest. @pre n >= 2 on every axis.
[[nodiscard]] std::vector<Vec3> grid_places(const Index3& n, const Box& bounds);
/// The field with those values at the points of that grid.
[[nodiscard]] std::shared_ptr<const VectorField> grid_field(const Index3& n, const Box& bounds,
                                                            std::span<const Vec3> values);

}  // namespace palpate
