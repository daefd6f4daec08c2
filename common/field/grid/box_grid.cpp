#include "common/field/grid/box_grid.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/field/vector_field.h"

namespace palpate {
namespace {

/// Three adjacent numbers, as a vector in local units.
template <typename T>
Vec3 read(const T* at, double scale) noexcept {
  return {static_cast<double>(at[0]) * scale, static_cast<double>(at[1]) * scale,
          static_cast<double>(at[2]) * scale};
}

/// Equation (1)'s coefficients from the eight corner values, whose first is at `corner`; steps in numbers.
template <typename T>
void load_coefficients(const T* corner, std::size_t step_y, std::size_t step_z, double scale,
                       std::array<Vec3, 8>& c) noexcept {
  constexpr std::size_t kStepX = 3;
  const Vec3 v000 = read(corner, scale);
  const Vec3 v100 = read(corner + kStepX, scale);
  const Vec3 v010 = read(corner + step_y, scale);
  const Vec3 v110 = read(corner + step_y + kStepX, scale);
  const Vec3 v001 = read(corner + step_z, scale);
  const Vec3 v101 = read(corner + step_z + kStepX, scale);
  const Vec3 v011 = read(corner + step_y + step_z, scale);
  const Vec3 v111 = read(corner + step_y + step_z + kStepX, scale);

  // Differences along x on the four edges, then along y, then along z.
  const Vec3 x00 = v100 - v000;
  const Vec3 x10 = v110 - v010;
  const Vec3 x01 = v101 - v001;
  const Vec3 x11 = v111 - v011;
  const Vec3 y0 = v010 - v000;
  const Vec3 xy0 = x10 - x00;
  const Vec3 y1 = v011 - v001;
  const Vec3 xy1 = x11 - x01;
  c[0] = v000;
  c[1] = x00;
  c[2] = y0;
  c[3] = v001 - v000;
  c[4] = xy0;
  c[5] = y1 - y0;
  c[6] = x01 - x00;
  c[7] = xy1 - xy0;
}

}  // namespace

BoxGrid::BoxGrid(const Index3& points, const Vec3& origin, const Vec3& spacing)
    : points_(points), origin_(origin), spacing_(spacing), inverse_spacing_(1.0 / spacing) {
  for (int axis = 0; axis < 3; ++axis) {
    PALPATE_CHECK(points[axis] >= 2);
    PALPATE_CHECK(spacing[axis] > 0.0 && std::isfinite(inverse_spacing_[axis]));
  }
}

BoxGrid::BoxGrid(const Index3& points, const Vec3& origin, const Vec3& spacing, const Mat3& directions)
    : BoxGrid(points, origin, spacing) {
  PALPATE_CHECK(glm::determinant(directions) > 0.0);
  sheared_ = true;
  directions_ = directions;
  inverse_ = glm::inverse(directions);
}

BoxGrid::BoxGrid(std::array<std::vector<double>, 3> coordinates) : coordinates_(std::move(coordinates)) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::vector<double>& x = coordinates_[as_size(axis)];
    PALPATE_CHECK(x.size() >= 2);
    std::vector<double>& inverse = inverse_widths_[as_size(axis)];
    inverse.reserve(x.size() - 1);
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      PALPATE_CHECK(x[i] < x[i + 1]);
      inverse.push_back(1.0 / (x[i + 1] - x[i]));
    }
    points_[axis] = static_cast<int>(x.size());
  }
}

void BoxGrid::hide_cells(std::vector<std::uint8_t> hidden) {
  PALPATE_CHECK(hidden.size() == as_size(points_.x - 1) * as_size(points_.y - 1) * as_size(points_.z - 1));
  hidden_ = std::move(hidden);
}

Box BoxGrid::bounds() const noexcept {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = coordinate(axis, 0);
    box.upper[axis] = coordinate(axis, points_[axis] - 1);
  }
  return box;
}

double BoxGrid::coordinate(int axis, int i) const noexcept {
  if (uniform()) return origin_[axis] + spacing_[axis] * i;
  return coordinates_[as_size(axis)][as_size(i)];
}

Vec3 BoxGrid::sheared_along_axes(const Vec3& x) const noexcept {
  constexpr double kRounding = 0x1p-49;  // of B y, of the frame that x has come through, and of B^-1 x
  Vec3 y = inverse_ * x;
  const double size =
      std::abs(x.x) + std::abs(x.y) + std::abs(x.z) + std::abs(y.x) + std::abs(y.y) + std::abs(y.z);
  for (int axis = 0; axis < 3; ++axis) {
    const double norm =
        std::abs(inverse_[0][axis]) + std::abs(inverse_[1][axis]) + std::abs(inverse_[2][axis]);
    const double lower = coordinate(axis, 0), upper = coordinate(axis, points_[axis] - 1);
    const double slack = kRounding * norm * size;
    if (y[axis] < lower && y[axis] >= lower - slack) y[axis] = lower;
    if (y[axis] > upper && y[axis] <= upper + slack) y[axis] = upper;
  }
  return y;
}

bool BoxGrid::locate(const Vec3& y, Index3& cell) const noexcept {
  for (int axis = 0; axis < 3; ++axis) {
    const int last = points_[axis] - 2;
    // The comparison is false for NaN.
    if (!(y[axis] >= coordinate(axis, 0) && y[axis] <= coordinate(axis, last + 1))) return false;
    int i = 0;
    if (uniform()) {
      i = std::clamp(static_cast<int>((y[axis] - origin_[axis]) * inverse_spacing_[axis]), 0, last);
      // The product may round across a grid line; the line's own position decides.
      if (y[axis] < coordinate(axis, i)) --i;
      if (i < last && y[axis] >= coordinate(axis, i + 1)) ++i;
    } else {
      const std::vector<double>& lines = coordinates_[as_size(axis)];
      const auto above = std::upper_bound(lines.begin(), lines.end(), y[axis]);
      i = std::min(static_cast<int>(above - lines.begin()) - 1, last);
    }
    cell[axis] = i;
  }
  return true;
}

void BoxGrid::load(const Index3& cell, const PointVectors& values, BoxCell& out) const noexcept {
  PALPATE_ASSERT(cell.x >= 0 && cell.y >= 0 && cell.z >= 0);
  PALPATE_ASSERT(cell.x < points_.x - 1 && cell.y < points_.y - 1 && cell.z < points_.z - 1);
  const auto row = as_size(points_.x);
  const std::size_t slice = row * as_size(points_.y);
  const std::size_t first = 3 * (as_size(cell.x) + row * as_size(cell.y) + slice * as_size(cell.z));
  if (const auto* floats = std::get_if<std::span<const float>>(&values.values)) {
    load_coefficients(floats->data() + first, 3 * row, 3 * slice, values.scale, out.c);
  } else if (const auto* doubles = std::get_if<std::span<const double>>(&values.values)) {
    load_coefficients(doubles->data() + first, 3 * row, 3 * slice, values.scale, out.c);
  }
  // c_xyz is a sum over all corners: finite if and only if they all are.
  out.bad_data = !is_finite(out.c[7]) || hidden(cell);

  out.index = cell;
  if (uniform()) {
    out.lower = origin_ + spacing_ * Vec3{cell};
    out.size = spacing_;
    out.inverse_size = inverse_spacing_;
    return;
  }
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = as_size(axis);
    const auto i = as_size(cell[axis]);
    out.lower[axis] = coordinates_[a][i];
    out.size[axis] = coordinates_[a][i + 1] - coordinates_[a][i];
    out.inverse_size[axis] = inverse_widths_[a][i];
  }
}

}  // namespace palpate
