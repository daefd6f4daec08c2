/// The flow inside one linear tetrahedron, solved exactly.
///
/// With v_j the vectors at the vertices and g_i the gradients of the barycentric coordinates b_i,
///
///   b' = B b,   B_ij = g_i . v_j,   the columns of B sum to zero                                    (1)
///
/// so w = b' obeys w' = C w with C_ij = g_i . (v_j - v_3), j < 3, and for a step h
///
///   w(h) = sum_k u_k,   b(h) = b(0) + h sum_k u_k / (k + 1),   u_0 = w(0),  u_k = (h C) u_(k-1) / k     (2)
///
/// summed to rounding. Nothing is located again at a face: three coordinates are carried over to the
/// neighbour under its own numbering. All in frame L. This is the fast path, for |h C| <= kMaxRate; what it
/// cannot certify goes to affine_modes.h.
#pragma once

#include <array>

#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"
#include "common/trace/pack4.h"

namespace palpate {

/// Position and vector of a mesh point, side by side so that a cell gathers four short runs.
struct PackedVertex {
  Vec3 x{0.0};
  Vec3 v{0.0};
};

/// One tetrahedron with its rates.
class AffineCell {
 public:
  static constexpr double kMaxRate = 2.0;  ///< largest |h C| of (2)
  static constexpr int kNodes = 3;         ///< inner nodes of the five-point Lobatto rule

  /// @param sign 1, or -1 to trace backward.
  /// @return false where a vertex's vector is not finite.
  [[nodiscard]] bool load(const PackedVertex* vertices, const TetMesh::Tet& tet, double sign) noexcept;

  /// w = B b.
  [[nodiscard]] Pack4 rate(const Pack4& b) const noexcept {
    return offset_ + (b[0] * column_[0] + b[1] * column_[1]) + b[2] * column_[2];
  }
  /// C u.
  [[nodiscard]] Pack4 apply(const Pack4& u) const noexcept {
    return (u[0] * column_[0] + u[1] * column_[1]) + u[2] * column_[2];
  }
  [[nodiscard]] Vec3 position(const Pack4& b) const noexcept {
    return corner_ + (b[0] * edge_[0] + b[1] * edge_[1] + b[2] * edge_[2]);
  }
  /// The vector that belongs to w: sum_j w_j x_j.
  [[nodiscard]] Vec3 velocity(const Pack4& w) const noexcept {
    return w[0] * edge_[0] + w[1] * edge_[1] + w[2] * edge_[2];
  }
  /// Largest row sum of |C|.
  [[nodiscard]] double norm() const noexcept { return norm_; }
  /// Longest edge at vertex 3.
  [[nodiscard]] double size() const noexcept { return size_; }
  /// Spatial gradient of the field applied to a small displacement.
  [[nodiscard]] Vec3 gradient_times(const Vec3& d) const noexcept {
    return velocity(
        apply(Pack4{glm::dot(gradient_[0], d), glm::dot(gradient_[1], d), glm::dot(gradient_[2], d), 0.0}));
  }
  [[nodiscard]] const Vec3& barycentric_gradient(int i) const noexcept { return gradient_[i]; }

  struct Flow {
    Pack4 b;
    Pack4 w;
    std::array<Pack4, kNodes> inner;  ///< w at the inner nodes
  };
  /// Evaluates (2). @pre |h| norm() <= kMaxRate.
  [[nodiscard]] Flow flow(const Pack4& b, const Pack4& w, double h) const noexcept;

  /// Arc length of a flow of duration h that begins at speed `first`. `sound` is set to false where the rule
  /// has not converged.
  [[nodiscard]] double arc(double first, const Flow& flow, double h, bool& sound) const noexcept;

 private:
  std::array<Pack4, 3> column_;
  Pack4 offset_;
  std::array<Vec3, 3> edge_{};
  std::array<Vec3, 3> gradient_{};
  Vec3 corner_{0.0};
  double norm_ = 0.0;
  double size_ = 0.0;
};

}  // namespace palpate
