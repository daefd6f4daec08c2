#include "common/field/heart/wall_frame.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/base/index.h"
#include "common/field/grid/scalar_cell.h"
#include "common/field/grid/tet_mesh.h"

namespace palpate {
namespace {

/// Part of the rim that must not cancel: a tube is open at both ends.
constexpr double kOpen = 0.05;
/// Cosine of the angle between a face's normal and the way through the wall below which it is rim.
constexpr double kRim = 0.5;
/// Sine of the angle between axis and wall normal below which there is no way round.
constexpr double kPole = 1e-6;

double six_volumes(const TetMesh& mesh, CellIndex cell) {
  const TetMesh::Tet& tet = mesh.cells()[as_size(cell)];
  const Vec3 x0 = mesh.points()[tet[0]];
  return glm::determinant(
      Mat3{mesh.points()[tet[1]] - x0, mesh.points()[tet[2]] - x0, mesh.points()[tet[3]] - x0});
}

/// Six volumes times the gradient of a cell, frame L and local values; nothing where it has neither.
std::optional<Vec3> weighted_gradient(const TetMesh& mesh, const PointScalars& values, CellIndex cell) {
  if (mesh.zero_volume(cell)) return std::nullopt;
  const TetMesh::Tet& tet = mesh.cells()[as_size(cell)];
  const ScalarTet s = load_scalar_tet(values, tet);
  if (s.bad_data) return std::nullopt;
  return six_volumes(mesh, cell) *
         (mesh.barycentric_gradients(cell) * Vec3{s.s[1] - s.s[0], s.s[2] - s.s[0], s.s[3] - s.s[0]});
}

}  // namespace

SmoothNormals::SmoothNormals(std::shared_ptr<const ScalarField> layer) : layer_(std::move(layer)) {
  const TetMesh& mesh = *layer_->tet_mesh();
  std::vector<Vec3> sum(mesh.points().size(), Vec3{0.0});
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto gradient = weighted_gradient(mesh, layer_->values(), static_cast<CellIndex>(c));
    if (!gradient) continue;
    for (const std::uint32_t p : mesh.cells()[c]) sum[p] += *gradient;
  }
  normals_.reserve(sum.size());
  for (const Vec3& v : sum) normals_.emplace_back(unit_or_zero(v));
}

Vec3 SmoothNormals::at(const TetPoint& place) const noexcept {
  const TetMesh::Tet& tet = layer_->tet_mesh()->cells()[as_size(place.cell)];
  Vec3 mean{0.0};
  for (int i = 0; i < 4; ++i) mean += place.b[i] * Vec3(normals_[tet[as_size(i)]]);
  return mean;
}

std::optional<Vec3> long_axis(const ScalarField& layer) {
  const TetMesh& mesh = *layer.tet_mesh();
  Vec3 sum{0.0};
  double all = 0.0;
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    const auto cell = static_cast<CellIndex>(c);
    const TetMesh::Neighbors& behind = mesh.neighbors()[c];
    if (std::find(behind.begin(), behind.end(), kNoCell) == behind.end()) continue;
    const auto gradient = weighted_gradient(mesh, layer.values(), cell);
    if (!gradient || !(glm::length(*gradient) > 0.0)) continue;
    const Vec3 through = glm::normalize(*gradient);
    const Mat3 g = mesh.barycentric_gradients(cell);
    const std::array<Vec3, 4> inward{-g[0] - g[1] - g[2], g[0], g[1], g[2]};
    const double volume = six_volumes(mesh, cell);
    for (std::size_t face = 0; face < 4; ++face) {
      if (behind[face] != kNoCell) continue;
      const Vec3 area = -0.5 * volume * inward[face];
      const double size = glm::length(area);
      if (std::abs(glm::dot(area, through)) > kRim * size) continue;
      sum += area;
      all += size;
    }
  }
  if (!(glm::length(sum) > kOpen * all)) return std::nullopt;
  const LocalFrame& frame = layer.frame();
  return glm::normalize(frame.rotated ? frame.rotation * sum : sum);
}

std::optional<Mat3> wall_axes(const Vec3& axis, const Vec3& transmural) noexcept {
  const Vec3 around = glm::cross(axis, transmural);
  const double out = glm::length(transmural), turn = glm::length(around);
  if (!(turn > kPole * out * glm::length(axis))) return std::nullopt;
  const Vec3 e_t = transmural / out, e_c = around / turn;
  return Mat3{e_c, glm::cross(e_t, e_c), e_t};
}

}  // namespace palpate
