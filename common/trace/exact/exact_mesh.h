/// A tetrahedral mesh with its vectors, packed for the walks through it.
#pragma once

#include <memory>

#include "common/field/vector_field.h"
#include "common/trace/exact/exact_kernel.h"

namespace palpate {

/// Points and vectors of a mesh packed for the walk, frame L: 64 bytes a point.
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

 private:
  const TetMesh* mesh_;
  std::unique_ptr<PackedVertex[]> vertices_;
  ExactMeshView view_;
};

}  // namespace palpate
