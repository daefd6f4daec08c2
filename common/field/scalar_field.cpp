#include "common/field/scalar_field.h"

#include <cmath>
#include <cstdint>

#include "common/base/index.h"
#include "common/field/field_grid.h"

namespace palpate {
namespace {

/// Locates `x` in `mesh` and loads the values around it.
SampleStatus load(const TetMesh& mesh, const PointScalars& values, const Vec3& x, CellHint& hint,
                  TetPoint& at, ScalarTet& tet) noexcept {
  const auto start = hint.cell >= 0 && hint.cell <= INT32_MAX ? static_cast<CellIndex>(hint.cell) : kNoCell;
  if (!mesh.locate(x, start, at)) return SampleStatus::kOutside;
  hint.cell = at.cell;
  tet = load_scalar_tet(values, mesh.cells()[as_size(at.cell)]);
  return tet.bad_data ? SampleStatus::kBadData : SampleStatus::kOk;
}

/// @param y along the grid's axes.
SampleStatus load(const BoxGrid& grid, const PointScalars& values, const Vec3& y,
                  ScalarBoxCell& cell) noexcept {
  Index3 index;
  if (!grid.locate(y, index)) return SampleStatus::kOutside;
  load_scalar_cell(grid, values, index, cell);
  return cell.bad_data ? SampleStatus::kBadData : SampleStatus::kOk;
}

}  // namespace

SampleStatus ScalarField::jet(const Vec3& x_local, CellHint& hint, Jet3& out) const noexcept {
  out = Jet3{};
  if (tets_) {
    TetPoint at;
    ScalarTet tet;
    const SampleStatus status = load(*tets_, values_, x_local, hint, at, tet);
    if (status != SampleStatus::kOk) return status;
    const Mat3 gradients = tets_->barycentric_gradients(at.cell);
    out.value = glm::dot(at.b, tet.s);
    out.gradient = gradients * Vec3{tet.s[1] - tet.s[0], tet.s[2] - tet.s[0], tet.s[3] - tet.s[0]};
    return status;
  }
  if (box_) {
    ScalarBoxCell cell;
    const Vec3 y = box_->along_axes(x_local);
    const SampleStatus status = load(*box_, values_, y, cell);
    if (status == SampleStatus::kOk) {
      out = {cell.value(y), box_->gradient_in_frame(cell.gradient(y)),
             box_->hessian_in_frame(cell.hessian(y))};
    }
    return status;
  }
  if (!analytic_->bounds().contains(x_local)) return SampleStatus::kOutside;
  const Jet3 jet = analytic_->jet(x_local);
  if (!std::isfinite(jet.value) || !is_finite(jet.gradient)) return SampleStatus::kBadData;
  out = jet;
  return SampleStatus::kOk;
}

ScalarSample ScalarField::sample(const Vec3& x_data, CellHint& hint) const noexcept {
  const Vec3 x = frame_.local_from_data(x_data);
  ScalarSample out;
  double value = 0.0;
  if (tets_) {
    TetPoint at;
    ScalarTet tet;
    out.status = load(*tets_, values_, x, hint, at, tet);
    value = glm::dot(at.b, tet.s);
  } else if (box_) {
    ScalarBoxCell cell;
    const Vec3 y = box_->along_axes(x);
    out.status = load(*box_, values_, y, cell);
    if (out.status == SampleStatus::kOk) value = cell.value(y);
  } else if (bounds_.contains(x_data)) {
    value = analytic_->value(x);
    out.status = std::isfinite(value) ? SampleStatus::kOk : SampleStatus::kBadData;
  }
  if (out.status == SampleStatus::kOk) out.value = value / values_.scale;
  return out;
}

VectorSample ScalarField::gradient(const Vec3& x_data, CellHint& hint) const noexcept {
  Jet3 at;
  VectorSample out;
  out.status = jet(frame_.local_from_data(x_data), hint, at);
  if (out.status != SampleStatus::kOk) return out;
  const Vec3 turned = frame_.rotated ? frame_.rotation * at.gradient : at.gradient;
  out.value = turned / values_.scale * power_of_two(-frame_.length_exponent);
  return out;
}

}  // namespace palpate
