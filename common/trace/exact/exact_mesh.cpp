#include "common/trace/exact/exact_mesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>
#include <variant>

#include "common/base/parallel.h"
#include "common/field/cells/curved_split.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/rest_speed.h"

namespace palpate {
namespace {

// Speeds in frame L are near 1. What is slower by so much is no flow, and its square would be no number.
constexpr double kSlowest = 0x1p-300;

}  // namespace

const ExactMesh& ExactMesh::of(const VectorField& field, int threads) {
  return field.prepared().get<ExactMesh>([&] { return std::make_shared<const ExactMesh>(field, threads); });
}

ExactMesh::ExactMesh(const VectorField& field, int threads) : mesh_(field.tet_mesh()) {
  const std::span<const Vec3> points = mesh_->points();
  vertices_ = std::make_unique_for_overwrite<PackedVertex[]>(points.size());
  const PointVectors& values = field.values();
  rest_speed_ = std::visit(
      [&](const auto& stored) {
        return palpate::rest_speed(points.size(), [&](std::size_t i) {
          return glm::length(values.scale * Vec3{stored[3 * i], stored[3 * i + 1], stored[3 * i + 2]});
        });
      },
      values.values);
  std::visit(
      [&](const auto& stored) {
        using Stored = std::remove_cvref_t<decltype(stored[0])>;
        constexpr double kResolution = std::numeric_limits<Stored>::epsilon();
        parallel_for(points.size(), threads, [&](std::size_t first, std::size_t last) {
          for (std::size_t i = first; i < last; ++i) {
            const Vec3 v = values.scale * Vec3{stored[3 * i], stored[3 * i + 1], stored[3 * i + 2]};
            const double resolution = std::max(kResolution * glm::length(v), kSlowest);
            vertices_[i] = {.x = {points[i].x, points[i].y, points[i].z, 0.0},
                            .v = {v.x, v.y, v.z, resolution}};
          }
        });
      },
      values.values);
  mark_resting();
  value_rounding_ = field.value_rounding();
  if (field.grid()) point_rounding_ = field.grid()->point_rounding / field.frame().length_scale();
  if (field.grid() && field.grid()->made)
    value_error_ = field.grid()->made->error * field.max_speed() * values.scale;
  static_assert(sizeof(TetMesh::Tet) == sizeof(std::uint32_t[4]));
  view_ = {.vertices = vertices_.get(),
           .cells = reinterpret_cast<const std::uint32_t(*)[4]>(mesh_->cells().data()),
           .neighbors = reinterpret_cast<const std::int32_t(*)[4]>(mesh_->neighbors().data())};
}

// About a point at rest the flow is at rest where it is as slow: there is no more to be told.
void ExactMesh::mark_resting() {
  if (!(rest_speed_ > 0.0)) return;
  const auto slow = [&](std::uint32_t i) {
    const double* v = vertices_[i].v;
    return std::hypot(v[0], v[1], v[2]) <= rest_speed_;
  };
  for (const TetMesh::Tet& tet : mesh_->cells()) {
    if (!std::ranges::all_of(tet, slow)) continue;
    for (const std::uint32_t i : tet) vertices_[i].v[3] = std::max(rest_speed_, kSlowest);
  }
}

bool ExactMesh::rests(std::size_t vertex) const noexcept {
  const double* v = vertices_[vertex].v;
  return v[3] >= rest_speed_ && std::hypot(v[0], v[1], v[2]) <= rest_speed_;
}

}  // namespace palpate
