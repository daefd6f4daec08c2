/// A tetrahedral mesh with its vectors, packed for the walks through it.
#pragma once

#include <cstddef>
#include <memory>

#include "common/field/vector_field.h"
#include "common/trace/exact/exact_kernel.h"

namespace palpate {

/// Points and vectors of a mesh packed for the walk, frame L: 64 bytes a point.
///
/// A point rests if some cell has no corner that is faster than rest_speed(): a solid block's. A slow point
/// between fast ones alone does not: it may lie on the slow manifold of a stiff flow.
class ExactMesh {
 public:
  /// That of a field: packed at the first call, and kept as long as the field lives.
  /// @pre field.tet_mesh() is not null.
  [[nodiscard]] static const ExactMesh& of(const VectorField& field, int threads);
  /// @pre field.tet_mesh() is not null and outlives this.
  ExactMesh(const VectorField& field, int threads);

  [[nodiscard]] const TetMesh& mesh() const noexcept { return *mesh_; }
  [[nodiscard]] const PackedVertex* vertices() const noexcept { return vertices_.get(); }
  [[nodiscard]] const ExactMeshView& view() const noexcept { return view_; }
  [[nodiscard]] double rest_speed() const noexcept { return rest_speed_; }  ///< rest_speed.h
  /// By which velocities may be off everywhere, in frame L: curved cells are linear in parts.
  [[nodiscard]] double value_error() const noexcept { return value_error_; }
  /// By which part of itself a value may be off, and by how much a point may lie elsewhere, in frame L (value_rounding.h).
  [[nodiscard]] double value_rounding() const noexcept { return value_rounding_; }
  [[nodiscard]] double point_rounding() const noexcept { return point_rounding_; }
  /// Whether that vertex rests.
  [[nodiscard]] bool rests(std::size_t vertex) const noexcept;

 private:
  const TetMesh* mesh_;
  void mark_resting();

  std::unique_ptr<PackedVertex[]> vertices_;
  double rest_speed_ = 0.0, value_error_ = 0.0, value_rounding_ = 0.0;
  ExactMeshView view_;
  double point_rounding_ = 0.0;
};

}  // namespace palpate
