#include "common/cli/wall_surfaces_report.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/laplace.h"
#include "common/field/layer/wall_layer.h"
#include "common/field/layer/wall_measures.h"
#include "common/load/write/write_mesh.h"
#include "common/load/write/write_surface.h"
#include "common/scene/wall/open_wall.h"

namespace palpate {
namespace {

/// The wall as a mesh whose points have the array kSurfaceArray, beside what the file's points and cells have.
void write_tagged_mesh(const OpenWall& wall, const Document& options, const std::optional<Vec3>& long_axis) {
  const FieldGrid& grid = *wall.grid;
  const TetMesh& tets = *grid.tets;
  std::vector<Vec3> points;
  points.reserve(tets.points().size());
  for (const Vec3& x : tets.points()) points.push_back(grid.frame.data_from_local(x));
  std::vector<std::size_t> input_of(points.size());
  for (std::size_t i = wall.mesh.point_count(); i-- > 0;) {
    const std::size_t p = grid.point_of_input.empty() ? i : grid.point_of_input[i];
    if (p < input_of.size()) input_of[p] = i;
  }
  // Where two meet the first of these counts, as it does for the depth.
  MeshColumn tags{.name = kSurfaceArray, .values = std::vector<double>(points.size(), 0.0)};
  for (const BorderRole role :
       {BorderRole::kBase, BorderRole::kOuter, BorderRole::kSeptum, BorderRole::kRight, BorderRole::kInner})
    give_on(wall.surfaces, role, tag_of(role), tags.values);
  std::vector<MeshColumn> columns{std::move(tags)};
  for (const DataArray& array : wall.mesh.arrays) {
    if (array.name == kSurfaceArray || array.name == kLayerArray) continue;
    const bool of_cells = array.association == Association::kCell;
    MeshColumn column{
        .name = array.name, .values = {}, .components = as_size(array.components), .of_cells = of_cells};
    for (std::size_t i = 0; i < (of_cells ? tets.cells().size() : points.size()); ++i)
      for (int c = 0; c < array.components; ++c)
        column.values.push_back(array.at(of_cells ? grid.source_cell[i] : input_of[i], c));
    columns.push_back(std::move(column));
  }
  write_mesh(options.heart.surfaces, points, tets.cells(), columns, options.common.force, long_axis);
}

std::string percent(double share) { return short_number(std::round(1000.0 * share) / 10.0) + " %"; }

}  // namespace

WallSurfacesSummary report_wall_surfaces(Input& input, const Document& options, Progress& progress) {
  const bool mesh = is_tagged_mesh(options.heart.surfaces);
  std::vector<std::string> arrays;
  for (const ArrayInfo& array : input.arrays())
    if (mesh) arrays.push_back(array.name);
  const OpenWall wall = open_wall(input, std::move(arrays), options.common.threads, &progress);
  const FieldGrid& grid = *wall.grid;
  progress.begin("measuring the wall", 0);
  const WallPotential depth =
      solve_laplace(*grid.tets, depths_on(wall.surfaces), input.title(), options.common.threads);
  const WallMeasures measures = measure_wall(grid, wall.surfaces, depth.values);

  WallSurfacesSummary summary{.output = options.heart.surfaces.string(),
                              .parts = {},
                              .confidence = wall.surfaces.confidence,
                              .monotone = measures.monotone,
                              .thinnest = measures.thinnest,
                              .median = measures.median,
                              .thickest = measures.thickest,
                              .notes = wall.notes};
  if (std::string doubt = monotone_doubt(measures.monotone); !doubt.empty())
    summary.notes.push_back(std::move(doubt));
  SurfaceLabels labels{.name = kSurfaceArray, .of = {}, .words = {}};
  const bool two = wall.surfaces.has(BorderRole::kRight) || wall.surfaces.has(BorderRole::kSeptum);
  for (int tag = 0; tag < kBorderRoleCount; ++tag) {
    const BorderRole role = role_of_tag(tag);
    const std::string name = role == BorderRole::kInner && !two ? "endocardium" : name_of(role);
    labels.words.push_back(name);
    if (wall.surfaces.areas[as_size(role)] > 0.0)
      summary.parts.push_back(
          {name, wall.surfaces.areas[as_size(role)], wall.surfaces.pieces[as_size(role)]});
  }
  if (mesh) {
    write_tagged_mesh(wall, options, input.file()->long_axis);
    return summary;
  }
  constexpr std::uint32_t kUnused = std::numeric_limits<std::uint32_t>::max();
  std::vector<std::uint32_t> place(grid.tets->points().size(), kUnused);
  std::vector<Vec3> points;
  SurfaceColumn thickness{.name = "thickness", .values = {}}, depths{.name = "depth", .values = {}};
  std::vector<std::array<std::uint32_t, 3>> triangles = wall.surfaces.triangles;
  for (auto& triangle : triangles) {
    for (std::uint32_t& corner : triangle) {
      const std::uint32_t p = corner;
      if (place[p] == kUnused) {
        place[p] = static_cast<std::uint32_t>(points.size());
        points.push_back(grid.frame.data_from_local(grid.tets->points()[p]));
        thickness.values.push_back(measures.thickness[p]);
        depths.values.push_back(depth.values[p]);
      }
      corner = place[p];
    }
  }
  for (const BorderRole role : wall.surfaces.roles) labels.of.push_back(tag_of(role));
  const std::array<SurfaceColumn, 2> columns{std::move(thickness), std::move(depths)};
  write_surface(options.heart.surfaces, points, triangles, labels, columns, options.common.force);
  return summary;
}

bool is_tagged_mesh(const std::filesystem::path& file) { return file.extension() == ".vtu"; }

std::string surfaces_text(const WallSurfacesSummary& summary) {
  std::string text = "  surfaces   written to " + summary.output + "\n";
  for (const WallSurfacesSummary::Part& part : summary.parts)
    text += "             " + part.name + ": area " + short_number(part.area) + ", " +
            counted(part.pieces, "piece") + "\n";
  text += "             of the border's area " + percent(summary.confidence) +
          " has a role; the depth rises through the "
          "wall from " +
          percent(summary.monotone) + " of the points\n";
  text += "             wall " + short_number(summary.thinnest) + " to " + short_number(summary.thickest) +
          " thick, median " + short_number(summary.median) +
          ", from the endocardium along the gradient of the depth\n";
  return text;
}

}  // namespace palpate
