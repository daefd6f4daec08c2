/// Isosurfaces of linear tetrahedra (isosurface.h): polygons, on which every answer is exact to rounding.
#pragma once

#include <memory>

#include "common/field/grid/tet_mesh.h"
#include "common/trace/isosurface/isosurface.h"

namespace palpate {

class TetIsosurfaceSearch final : public IsosurfaceSearch {
 public:
  /// @pre field->tet_mesh().
  explicit TetIsosurfaceSearch(std::shared_ptr<const ScalarField> field);

  [[nodiscard]] int advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                            SearchWork& work) const noexcept override;
  [[nodiscard]] SurfaceFit settle(const Vec3& x, SurfacePoint& point,
                                  SearchWork& work) const noexcept override;

 private:
  [[nodiscard]] bool begin(SurfacePath& path, const SurfaceLevels& levels) const noexcept;
  [[nodiscard]] int jump(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                         SearchWork& work) const noexcept;

  std::shared_ptr<const ScalarField> field_;
  const TetMesh& mesh_;
  IsosurfaceScale scale_;
};

}  // namespace palpate
