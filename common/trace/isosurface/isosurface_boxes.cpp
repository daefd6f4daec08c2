#include "common/trace/isosurface/isosurface_boxes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/ode/root.h"
#include "common/trace/isosurface/isosurface_tets.h"
#include "common/trace/isosurface/surface_descent.h"
#include "common/trace/polynomial_root.h"

namespace palpate {
namespace {

/// The cells of a grid, for surface_descent.h.
class GridBoxes {
 public:
  using Patch = ScalarBoxCell;

  GridBoxes(const BoxGrid& grid, const AxesMetric& metric, const PointScalars& values,
            const Vec3& start) noexcept
      : grid_(grid), metric_(metric), values_(values) {
    Index3 cell;
    if (!grid.locate(start, cell)) return;
    const Vec3 lower{grid.coordinate(0, cell.x), grid.coordinate(1, cell.y), grid.coordinate(2, cell.z)};
    const Vec3 upper{grid.coordinate(0, cell.x + 1), grid.coordinate(1, cell.y + 1),
                     grid.coordinate(2, cell.z + 1)};
    reach_ = metric.length(upper - lower);
  }

  template <class Visit>
  bool visit(const Vec3& p, Visit&& visit) const noexcept {
    Index3 last;
    if (!grid_.locate(p, last)) return true;
    Index3 first = last;
    for (int axis = 0; axis < 3; ++axis) {
      if (last[axis] > 0 && p[axis] == grid_.coordinate(axis, last[axis])) --first[axis];
    }
    bool good = true;
    Patch patch;
    for (int k = first.z; k <= last.z; ++k) {
      for (int j = first.y; j <= last.y; ++j) {
        for (int i = first.x; i <= last.x; ++i) {
          load_scalar_cell(grid_, values_, {i, j, k}, patch);
          if (patch.bad_data) {
            good = false;
          } else {
            visit(std::as_const(patch));
          }
        }
      }
    }
    return good;
  }
  /// The diagonal of the cell where the search began.
  [[nodiscard]] double reach() const noexcept { return reach_; }
  [[nodiscard]] const AxesMetric& metric() const noexcept { return metric_; }

 private:
  const BoxGrid& grid_;
  const AxesMetric& metric_;
  const PointScalars& values_;
  double reach_ = 0.0;
};

/// A formula over its bounds: one box.
struct FormulaPatch {
  const AnalyticScalar* formula = nullptr;
  Vec3 lower{0.0}, upper{0.0};

  [[nodiscard]] double value(const Vec3& x) const noexcept { return formula->value(x); }
  [[nodiscard]] Vec3 gradient(const Vec3& x) const noexcept { return formula->jet(x).gradient; }
  [[nodiscard]] Mat3 hessian(const Vec3& x) const noexcept { return formula->jet(x).hessian; }
};

class FormulaBoxes {
 public:
  using Patch = FormulaPatch;

  explicit FormulaBoxes(const AnalyticScalar& formula, double diagonal) noexcept
      : patch_{&formula, formula.bounds().lower, formula.bounds().upper}, reach_(0x1p-4 * diagonal) {}

  template <class Visit>
  bool visit(const Vec3& p, Visit&& visit) const noexcept {
    const Jet3 jet = patch_.formula->jet(p);
    if (!std::isfinite(jet.value) || !is_finite(jet.gradient)) return false;
    visit(patch_);
    return true;
  }
  [[nodiscard]] double reach() const noexcept { return reach_; }
  [[nodiscard]] static const AxesMetric& metric() noexcept { return kRightAngles; }

 private:
  inline static const AxesMetric kRightAngles{};
  FormulaPatch patch_;
  double reach_;
};

/// Coefficients of s - level along p + theta d, theta from 0 to 1, within a cell.
std::array<double, 4> along(const ScalarBoxCell& cell, const Vec3& p, const Vec3& d, double level) noexcept {
  const Vec3 u = (p - cell.lower) * cell.inverse_size, w = d * cell.inverse_size;
  const auto& c = cell.c;
  return {cell.value(p) - level,
          c[1] * w.x + c[2] * w.y + c[3] * w.z + c[4] * (u.x * w.y + w.x * u.y) +
              c[5] * (u.y * w.z + w.y * u.z) + c[6] * (u.z * w.x + w.z * u.x) +
              c[7] * (w.x * u.y * u.z + u.x * w.y * u.z + u.x * u.y * w.z),
          c[4] * w.x * w.y + c[5] * w.y * w.z + c[6] * w.z * w.x +
              c[7] * (w.x * w.y * u.z + w.x * u.y * w.z + u.x * w.y * w.z),
          c[7] * w.x * w.y * w.z};
}

bool inside(const Box& box, const Vec3& x) noexcept {
  return glm::all(glm::greaterThanEqual(x, box.lower)) && glm::all(glm::lessThanEqual(x, box.upper));
}

}  // namespace

BoxIsosurfaceSearch::BoxIsosurfaceSearch(std::shared_ptr<const ScalarField> field)
    : field_(std::move(field)), grid_(*field_->box_grid()), scale_(*field_) {
  if (grid_.sheared()) metric_ = AxesMetric(grid_.directions());
}

SurfaceFit BoxIsosurfaceSearch::settle(const Vec3& x, SurfacePoint& point, SearchWork& work) const noexcept {
  Vec3 y = grid_.along_axes(point.position);
  const GridBoxes boxes(grid_, metric_, field_->values(), y);
  SurfaceFit fit = SurfaceDescent<GridBoxes>(boxes, scale_, point.level, work).settle(grid_.along_axes(x), y);
  point.position = grid_.in_frame(y);
  fit.gradient = grid_.gradient_in_frame(fit.gradient);
  if (grid_.sheared()) fit.jacobian = grid_.directions() * fit.jacobian * glm::transpose(grid_.gradients());
  return fit;
}

int BoxIsosurfaceSearch::advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                 SearchWork& work) const noexcept {
  if (!grid_.sheared()) return advance_along_axes(path, to, levels, work);
  const Vec3 end = grid_.along_axes(to);
  path.at = grid_.along_axes(path.at);
  const int crossed = advance_along_axes(path, end, levels, work);
  path.at = path.at == end ? to : grid_.in_frame(path.at);
  return crossed;
}

int BoxIsosurfaceSearch::advance_along_axes(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                            SearchWork& work) const noexcept {
  Index3 index;
  if (!grid_.locate(path.at, index)) {
    path.at = to;
    path.side.fill(0);
    // What comes from outside begins where it is now.
    if (!grid_.locate(to, index)) return -1;
  }
  ScalarBoxCell cell;
  for (;;) {
    load_scalar_cell(grid_, field_->values(), index, cell);
    const Vec3 d = to - path.at;
    double part = 1.0;
    int out = -1;
    for (int axis = 0; axis < 3; ++axis) {
      const double bound = d[axis] > 0.0 ? cell.upper[axis] : cell.lower[axis];
      const bool beyond = d[axis] > 0.0 ? to[axis] > bound : to[axis] < bound;
      if (!beyond) continue;
      const double at = std::max(0.0, (bound - path.at[axis]) / d[axis]);
      if (at < part || out < 0) {
        part = at;
        out = axis;
      }
    }
    const Vec3 leg = part * d;
    double first = 2.0;
    int crossed = -1;
    if (cell.bad_data) path.side.fill(0);
    for (int l = 0; l < levels.count && !cell.bad_data; ++l) {
      auto& side = path.side[as_size(l)];
      std::array<double, 4> f = along(cell, path.at, leg, levels.value[as_size(l)]);
      if (side == 0) side = f[0] >= 0.0 ? 1 : -1;
      for (double& each : f) each *= side;
      f[0] += scale_.beyond();
      constexpr double kResolution = 0x1p-40;
      const double at = first_fall<3>(f, kResolution);
      if (at <= 1.0 && at < first) {
        first = at;
        crossed = l;
      }
    }
    if (crossed >= 0) {
      path.at += first * leg;
      path.side[as_size(crossed)] *= -1;
      return crossed;
    }
    if (out < 0) {
      path.at = to;
      return -1;
    }
    path.at += leg;
    path.at[out] = d[out] > 0.0 ? cell.upper[out] : cell.lower[out];
    index[out] += d[out] > 0.0 ? 1 : -1;
    if (index[out] < 0 || index[out] > grid_.points()[out] - 2) {
      path.at = to;
      path.side.fill(0);
      return -1;
    }
    if (!work.take()) return -1;
  }
}

FormulaIsosurfaceSearch::FormulaIsosurfaceSearch(std::shared_ptr<const ScalarField> field)
    : field_(std::move(field)), formula_(*field_->analytic()), scale_(*field_) {}

SurfaceFit FormulaIsosurfaceSearch::settle(const Vec3& x, SurfacePoint& point,
                                           SearchWork& work) const noexcept {
  const FormulaBoxes boxes(formula_, scale_.diagonal);
  return SurfaceDescent<FormulaBoxes>(boxes, scale_, point.level, work).settle(x, point.position);
}

int FormulaIsosurfaceSearch::advance(SurfacePath& path, const Vec3& to, const SurfaceLevels& levels,
                                     SearchWork& work) const noexcept {
  const Box box = formula_.bounds();
  const Vec3 from = path.at, d = to - from;
  // A leap may be longer than any int, or no number: in that order min and max make 1 of NaN.
  const int samples = static_cast<int>(
      std::min(std::max(1.0, std::ceil(glm::length(d) * kSamples / scale_.diagonal)), double{1 << 16}));
  double before = inside(box, from) ? formula_.value(from) : NAN;
  for (int n = 1; n <= samples; ++n) {
    if (n > 1 && !work.take()) return -1;
    const double start = static_cast<double>(n - 1) / samples, end = static_cast<double>(n) / samples;
    const Vec3 next = n == samples ? to : from + end * d;
    const double here = inside(box, next) ? formula_.value(next) : NAN;
    if (!std::isfinite(here) || !std::isfinite(before)) path.side.fill(0);
    double first = 2.0;
    int crossed = -1;
    for (int l = 0; l < levels.count && std::isfinite(here); ++l) {
      auto& side = path.side[as_size(l)];
      const double level = levels.value[as_size(l)];
      if (side == 0 && std::isfinite(before)) side = before >= level ? 1 : -1;
      if (side == 0) side = here >= level ? 1 : -1;
      if (!(side * (here - level) < -scale_.beyond())) continue;
      const auto f = [&](double at) { return side * (formula_.value(from + at * d) - level); };
      const double f_start = side * (before - level);
      const double at =
          f_start > 0.0 ? bracketed_root(f, start, end, f_start, side * (here - level), 0x1p-44) : start;
      if (at < first) {
        first = at;
        crossed = l;
      }
    }
    if (crossed >= 0) {
      path.at = from + first * d;
      path.side[as_size(crossed)] *= -1;
      return crossed;
    }
    path.at = next;
    before = here;
  }
  return -1;
}

std::unique_ptr<const IsosurfaceSearch> make_isosurface_search(std::shared_ptr<const ScalarField> field) {
  if (field->tet_mesh() != nullptr) return std::make_unique<TetIsosurfaceSearch>(std::move(field));
  if (field->box_grid() != nullptr) return std::make_unique<BoxIsosurfaceSearch>(std::move(field));
  return std::make_unique<FormulaIsosurfaceSearch>(std::move(field));
}

}  // namespace palpate
