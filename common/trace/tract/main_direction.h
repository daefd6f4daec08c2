/// The main eigenvector of a diffusion tensor from a direction that is close to it, as it is along a line.
///
/// Rayleigh quotient iteration (Parlett, The Symmetric Eigenvalue Problem, sec. 4.6) converges cubically:
/// from a few degrees away two steps reach rounding. It may find another eigenvector, and it is slow where
/// eigenvalues meet; what it finds is therefore certified as the largest one's, or else found anew by Jacobi
/// rotations (common/math/symmetric3.h).
#pragma once

#include <cmath>

#include "common/math/symmetric3.h"
#include "common/trace/tract/main_direction_rule.h"
#include "common/trace/tract/tensor6.h"

namespace palpate {

/// By Jacobi rotations, for whatever tensor. @rt Safe.
[[nodiscard]] inline Vec3 rotated_main_direction(const Tensor6& d, const Vec3& toward) noexcept {
  const Vec3 found = symmetric_eigen(d.matrix()).vectors[0];
  return glm::dot(found, toward) < 0.0 ? -found : found;
}

/// The unit main eigenvector of `d` that makes an acute angle with `toward`. @pre `d` finite, of a size
/// near one (so that products of six entries are in range), `toward` of unit length. @rt Safe.
/// Inlined: called for every stage of every step, one waiting for the other.
[[nodiscard, gnu::always_inline]] inline Vec3 main_direction(const Tensor6& d, const Vec3& toward) noexcept {
  using namespace direction_rule;
  const double trace = d.trace();
  Vec3 v = toward;
  double length2 = 1.0;
  double rho = glm::dot(v, d * v);
  for (int step = 0; step < kMostSteps; ++step) {
    // The adjugate of B = D - rho is the inverse but for a factor, and finite where B is singular.
    const double x = d.xx - rho, y = d.yy - rho, z = d.zz - rho;
    const Tensor6 adjugate{.xx = y * z - d.yz * d.yz,
                           .xy = d.xz * d.yz - d.xy * z,
                           .xz = d.xy * d.yz - d.xz * y,
                           .yy = x * z - d.xz * d.xz,
                           .yz = d.xy * d.xz - x * d.yz,
                           .zz = x * y - d.xy * d.xy};
    const Vec3 next = adjugate * v;
    const double next2 = glm::dot(next, next), along = glm::dot(v, next);
    const bool settled = next2 * length2 - along * along < kTurnDone * next2 * length2;
    v = next;
    length2 = next2;
    if (!settled) {
      rho = glm::dot(v, d * v) / length2;
      continue;
    }
    // trace(adj B) = (l_2 - rho)(l_3 - rho) > 0: rho is an outer eigenvalue; 3 rho > trace: the upper one.
    if (!(adjugate.trace() > kLeastGap * trace * trace && 3.0 * rho > trace)) break;
    return v * ((glm::dot(v, toward) < 0.0 ? -1.0 : 1.0) / std::sqrt(length2));
  }
  return rotated_main_direction(d, toward);
}

}  // namespace palpate
