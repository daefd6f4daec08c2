#include "common/field/vector_field.h"

#include "common/base/index.h"
#include "common/field/analytic/analytic_field.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

/// Values at the vertices of a tetrahedron as columns, local units; `finite` tells whether they all are.
struct VertexVectors {
  std::array<Vec3, 4> v;
  bool finite;
};

template <typename T>
VertexVectors read_vertices(const T* values, double scale, const TetMesh::Tet& cell) noexcept {
  VertexVectors out{};
  double sum = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const T* at = values + std::size_t{3} * cell[i];
    out.v[i] = Vec3{static_cast<double>(at[0]) * scale, static_cast<double>(at[1]) * scale,
                    static_cast<double>(at[2]) * scale};
    // Zero, unless one is NaN or infinite.
    sum += 0.0 * (out.v[i].x + out.v[i].y + out.v[i].z);
  }
  out.finite = sum == 0.0;
  return out;
}

VertexVectors read_vertices(const PointVectors& values, const TetMesh::Tet& cell) noexcept {
  if (const auto* floats = std::get_if<std::span<const float>>(&values.values)) {
    return read_vertices(floats->data(), values.scale, cell);
  }
  if (const auto* doubles = std::get_if<std::span<const double>>(&values.values)) {
    return read_vertices(doubles->data(), values.scale, cell);
  }
  return {};
}

/// The column v times the row g^T: m[j][i] = v_i g_j.
CellIndex tet_hint(const CellHint& hint) noexcept {
  return hint.cell >= 0 && hint.cell <= INT32_MAX ? static_cast<CellIndex>(hint.cell) : kNoCell;
}

}  // namespace

VectorSample VectorField::sample(const Vec3& x_data, CellHint& hint) const noexcept {
  VectorSample out;
  const Vec3 x = frame_.local_from_data(x_data);
  Vec3 v{0.0};
  if (tets_) {
    TetPoint at;
    if (!tets_->locate(x, tet_hint(hint), at)) return out;
    hint.cell = at.cell;
    const VertexVectors vertices = read_vertices(values_, tets_->cells()[as_size(at.cell)]);
    out.status = vertices.finite ? SampleStatus::kOk : SampleStatus::kBadData;
    v = at.b[0] * vertices.v[0] + at.b[1] * vertices.v[1] + at.b[2] * vertices.v[2] + at.b[3] * vertices.v[3];
  } else if (box_) {
    const Vec3 y = box_->along_axes(x);
    Index3 index;
    if (!box_->locate(y, index)) return out;
    BoxCell cell;
    box_->load(index, values_, cell);
    out.status = cell.bad_data ? SampleStatus::kBadData : SampleStatus::kOk;
    v = cell.velocity(y);
  } else {
    if (!bounds_.contains(x_data)) return out;
    v = analytic_->velocity(x);
    out.status = is_finite(v) ? SampleStatus::kOk : SampleStatus::kBadData;
  }
  if (out.status == SampleStatus::kOk) out.value = frame_.data_from_local_velocity(v);
  return out;
}

SampleStatus VectorField::jacobian(const Vec3& x_data, CellHint& hint, Mat3& m) const noexcept {
  m = Mat3{0.0};
  const Vec3 x = frame_.local_from_data(x_data);
  Mat3 local{0.0};
  if (tets_) {
    TetPoint at;
    if (!tets_->locate(x, tet_hint(hint), at)) return SampleStatus::kOutside;
    hint.cell = at.cell;
    const VertexVectors vertices = read_vertices(values_, tets_->cells()[as_size(at.cell)]);
    if (!vertices.finite) return SampleStatus::kBadData;
    const Mat3 gradients = tets_->barycentric_gradients(at.cell);
    for (std::size_t i = 0; i < 3; ++i) {
      local += glm::outerProduct(vertices.v[i + 1] - vertices.v[0], gradients[static_cast<int>(i)]);
    }
  } else if (box_) {
    const Vec3 y = box_->along_axes(x);
    Index3 index;
    if (!box_->locate(y, index)) return SampleStatus::kOutside;
    BoxCell cell;
    box_->load(index, values_, cell);
    if (cell.bad_data) return SampleStatus::kBadData;
    local = cell.jacobian(y);
    if (box_->sheared()) local = local * glm::transpose(box_->gradients());
  } else {
    if (!bounds_.contains(x_data)) return SampleStatus::kOutside;
    local = analytic_->jacobian(x);
  }
  if (frame_.rotated) local = frame_.rotation * local * glm::transpose(frame_.rotation);
  m = local * power_of_two(frame_.speed_exponent - frame_.length_exponent);
  return SampleStatus::kOk;
}

}  // namespace palpate
