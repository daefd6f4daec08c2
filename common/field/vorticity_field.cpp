#include "common/field/vorticity_field.h"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/math/lattice.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr double kUlp = std::numeric_limits<double>::epsilon();

/// Part of a value that rounding may take from it: stored, scaled and subtracted.
double rounding_of(const PointVectors& values) noexcept {
  const bool single = std::holds_alternative<std::span<const float>>(values.values);
  constexpr double kArithmetic = 8.0 * kUlp;
  return kArithmetic + (single ? static_cast<double>(std::numeric_limits<float>::epsilon()) : kUlp);
}

/// Sums at points, and their weights.
class PointMeans {
 public:
  explicit PointMeans(std::size_t points)
      : sums_(points, Vec3{0.0}), weights_(points, 0.0), uncertain_(points, 0.0) {}

  /// @param uncertain how much of `value` may be rounding.
  void add(std::size_t point, const Vec3& value, double uncertain, double weight) {
    sums_[point] += weight * value;
    weights_[point] += weight;
    uncertain_[point] += weight * uncertain;
  }

  /// NaN where nothing was added; 0 where it may all be rounding.
  [[nodiscard]] PointVectors take() && {
    auto means = std::make_shared<std::vector<double>>();
    means->reserve(3 * sums_.size());
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const bool known = glm::length(sums_[i]) > uncertain_[i] || !(weights_[i] > 0.0);
      const Vec3 mean = known ? sums_[i] / weights_[i] : Vec3{0.0};
      means->insert(means->end(), {mean.x, mean.y, mean.z});
    }
    PointVectors values;
    values.values = std::span<const double>(*means);
    values.owner = std::move(means);
    return values;
  }

 private:
  std::vector<Vec3> sums_;
  std::vector<double> weights_;
  std::vector<double> uncertain_;  ///< sums
};

Vec3 vector_at(const PointVectors& values, std::size_t point) noexcept {
  return std::visit(
      [&](const auto& numbers) {
        const auto at = numbers.subspan(3 * point, 3);
        return values.scale *
               Vec3{static_cast<double>(at[0]), static_cast<double>(at[1]), static_cast<double>(at[2])};
      },
      values.values);
}

}  // namespace

double divergence(const Mat3& m) noexcept { return m[0][0] + m[1][1] + m[2][2]; }

Vec3 vorticity(const Mat3& m) noexcept { return {m[1][2] - m[2][1], m[2][0] - m[0][2], m[0][1] - m[1][0]}; }

double q_criterion(const Mat3& m) noexcept {
  // |W|^2 - |S|^2 = -tr J^2.
  return -0.5 * (m[0][0] * m[0][0] + m[1][1] * m[1][1] + m[2][2] * m[2][2]) - m[0][1] * m[1][0] -
         m[0][2] * m[2][0] - m[1][2] * m[2][1];
}

double lambda2(const Mat3& m) noexcept {
  const Mat3 square = m * m;
  return symmetric_eigenvalues(0.5 * (square + glm::transpose(square))).y;
}

ScalarSample sample_measure(const VectorField& field, Measure measure, const Vec3& x_data,
                            CellHint& hint) noexcept {
  if (measure == Measure::kSpeed) {
    const VectorSample sample = field.sample(x_data, hint);
    return {sample.status == SampleStatus::kOk ? glm::length(sample.value) : 0.0, sample.status};
  }
  Mat3 m;
  const SampleStatus status = field.jacobian(x_data, hint, m);
  if (status != SampleStatus::kOk) return {0.0, status};
  switch (measure) {
    case Measure::kDivergence:
      return {divergence(m), status};
    case Measure::kVorticityMagnitude:
      return {glm::length(vorticity(m)), status};
    case Measure::kQ:
      return {q_criterion(m), status};
    case Measure::kLambda2:
      return {lambda2(m), status};
    case Measure::kSpeed:
      break;
  }
  return {0.0, SampleStatus::kBadData};
}

VorticityField::VorticityField(std::shared_ptr<const VectorField> field) : field_(std::move(field)) {
  const Work work("measures of the velocity gradient", "at the points of the grid");
  if (field_->box_grid() != nullptr) recover_on_boxes();
  if (field_->tet_mesh() != nullptr) recover_on_tetrahedra();
}

void VorticityField::recover_on_boxes() {
  const BoxGrid& grid = *field_->box_grid();
  const Index3 n = grid.points();
  PointMeans means(count_of(n));
  const double rounding = rounding_of(field_->values());
  Index3 index;
  for (index.z = 0; index.z + 1 < n.z; ++index.z) {
    for (index.y = 0; index.y + 1 < n.y; ++index.y) {
      for (index.x = 0; index.x + 1 < n.x; ++index.x) {
        BoxCell cell;
        grid.load(index, field_->values(), cell);
        if (cell.bad_data) continue;
        const auto corner_at = [&](int corner) {
          return index + Index3{corner & 1, (corner >> 1) & 1, corner >> 2};
        };
        const auto point_at = [&](const Index3& at) {
          return (as_size(at.z) * as_size(n.y) + as_size(at.y)) * as_size(n.x) + as_size(at.x);
        };
        double speed = 0.0;
        for (int corner = 0; corner < 8; ++corner)
          speed = std::max(speed, glm::length(vector_at(field_->values(), point_at(corner_at(corner)))));
        // Each derivative is a difference of two values over a side of the cell.
        const Mat3 gradients = grid.gradients();
        Vec3 per_side = cell.inverse_size;
        for (int axis = 0; axis < 3; ++axis) per_side[axis] *= glm::length(gradients[axis]);
        const double uncertain = 2.0 * rounding * speed * (per_side.x + per_side.y + per_side.z);
        for (int corner = 0; corner < 8; ++corner) {
          const Index3 at = corner_at(corner);
          const Vec3 x{grid.coordinate(0, at.x), grid.coordinate(1, at.y), grid.coordinate(2, at.z)};
          const Mat3 jacobian = cell.jacobian(x);
          means.add(point_at(at), vorticity(grid.sheared() ? jacobian * glm::transpose(gradients) : jacobian),
                    uncertain, 1.0);
        }
      }
    }
  }
  values_ = std::move(means).take();
}

void VorticityField::recover_on_tetrahedra() {
  const TetMesh& mesh = *field_->tet_mesh();
  PointMeans means(mesh.points().size());
  const double rounding = rounding_of(field_->values());
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    if (mesh.zero_volume(cell)) continue;
    const TetMesh::Tet& vertices = mesh.cells()[c];
    const Mat3 gradients = mesh.barycentric_gradients(cell);
    const Vec3 v0 = vector_at(field_->values(), vertices[0]);
    // curl (b v) = grad b x v for a constant v.
    Vec3 curl{0.0};
    double uncertain = 0.0;
    for (int i = 0; i < 3; ++i) {
      const Vec3 v = vector_at(field_->values(), vertices[as_size(i) + 1]);
      curl += glm::cross(gradients[i], v - v0);
      uncertain += rounding * glm::length(gradients[i]) * (glm::length(v) + glm::length(v0));
    }
    if (!is_finite(curl)) continue;
    const double volume = 1.0 / glm::determinant(gradients);  // six times it; the weights' unit is free
    for (const std::uint32_t vertex : vertices) means.add(vertex, curl, uncertain, volume);
  }
  values_ = std::move(means).take();
}

VectorSample VorticityField::sample(const Vec3& x_data, CellHint& hint) const noexcept {
  VectorSample out;
  const LocalFrame& frame = field_->frame();
  const Vec3 x = frame.local_from_data(x_data);
  Vec3 local{0.0};
  if (const TetMesh* mesh = field_->tet_mesh()) {
    TetPoint at;
    const bool usable = hint.cell >= 0 && hint.cell < static_cast<std::int64_t>(mesh->cells().size());
    if (!mesh->locate(x, usable ? static_cast<CellIndex>(hint.cell) : kNoCell, at)) return out;
    hint.cell = at.cell;
    const TetMesh::Tet& vertices = mesh->cells()[as_size(at.cell)];
    for (int i = 0; i < 4; ++i) local += at.b[i] * vector_at(values_, vertices[as_size(i)]);
  } else if (const BoxGrid* grid = field_->box_grid()) {
    const Vec3 y = grid->along_axes(x);
    Index3 index;
    if (!grid->locate(y, index)) return out;
    BoxCell cell;
    grid->load(index, values_, cell);
    local = cell.bad_data ? Vec3{std::numeric_limits<double>::quiet_NaN()} : cell.velocity(y);
  } else {
    Mat3 m;
    out.status = field_->jacobian(x_data, hint, m);
    if (out.status != SampleStatus::kOk) return out;
    const double terms = glm::length(m[0]) + glm::length(m[1]) + glm::length(m[2]);
    constexpr double kRounding = 8.0 * kUlp;
    if (const Vec3 omega = vorticity(m); glm::length(omega) > kRounding * terms) out.value = omega;
    return out;
  }
  if (!is_finite(local)) {
    out.status = SampleStatus::kBadData;
    return out;
  }
  out.status = SampleStatus::kOk;
  out.value = (frame.rotated ? frame.rotation * local : local) *
              power_of_two(frame.speed_exponent - frame.length_exponent);
  return out;
}

}  // namespace palpate
