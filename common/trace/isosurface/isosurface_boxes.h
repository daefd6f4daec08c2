/// Isosurfaces of trilinear cells and of formulas (isosurface.h): smooth in each cell.
#pragma once

#include <memory>

#include "common/trace/isosurface/axes_metric.h"
#include "common/trace/isosurface/isosurface.h"

namespace palpate {

/// On a uniform or rectilinear grid. Searches run along its axes (box_grid.h).
class BoxIsosurfaceSearch final : public IsosurfaceSearch {
 public:
  /// @pre field->box_grid().
  explicit BoxIsosurfaceSearch(std::shared_ptr<const ScalarField> field);

  [[nodiscard]] int advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                            SearchWork& work) const noexcept override;
  [[nodiscard]] SurfaceFit settle(const Vec3& x, SurfacePoint& point,
                                  SearchWork& work) const noexcept override;

 private:
  std::shared_ptr<const ScalarField> field_;
  /// advance() with places along the axes.
  [[nodiscard]] int advance_along_axes(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                       SearchWork& work) const noexcept;

  const BoxGrid& grid_;
  AxesMetric metric_;
  IsosurfaceScale scale_;
};

/// Of a formula. A path is sampled at kSamples places to a diagonal: what it crosses twice between two of
/// them is missed, alone among the searches.
class FormulaIsosurfaceSearch final : public IsosurfaceSearch {
 public:
  static constexpr double kSamples = 256.0;

  /// @pre field->analytic().
  explicit FormulaIsosurfaceSearch(std::shared_ptr<const ScalarField> field);

  [[nodiscard]] int advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                            SearchWork& work) const noexcept override;
  [[nodiscard]] SurfaceFit settle(const Vec3& x, SurfacePoint& point,
                                  SearchWork& work) const noexcept override;

 private:
  std::shared_ptr<const ScalarField> field_;
  const AnalyticScalar& formula_;
  IsosurfaceScale scale_;
};

}  // namespace palpate
