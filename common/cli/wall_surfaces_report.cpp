#include "common/cli/wall_surfaces_report.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/laplace.h"
#include "common/field/layer/wall_measures.h"
#include "common/load/write/write_surface.h"
#include "common/scene/wall/open_wall.h"

namespace palpate {
namespace {

/// In the order of their numbers in the file; 1 and 2 are those of the array kSurfaceArray of points.
constexpr std::array<BorderRole, kBorderRoleCount> kNumbered{BorderRole::kLeft,   BorderRole::kInner,
                                                             BorderRole::kOuter,  BorderRole::kRight,
                                                             BorderRole::kSeptum, BorderRole::kBase};

std::int32_t number_of(BorderRole role) {
  for (std::size_t n = 0; n < kNumbered.size(); ++n)
    if (kNumbered[n] == role) return static_cast<std::int32_t>(n);
  return 0;
}

std::string percent(double share) { return short_number(std::round(1000.0 * share) / 10.0) + " %"; }

}  // namespace

WallSurfacesSummary report_wall_surfaces(Input& input, const Document& options, Progress& progress) {
  const OpenWall wall = open_wall(input, {}, options.common.threads, &progress);
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
  for (const BorderRole role : kNumbered) {
    const std::string name = role == BorderRole::kInner && !two ? "endocardium" : name_of(role);
    labels.words.push_back(name);
    if (wall.surfaces.areas[as_size(role)] > 0.0)
      summary.parts.push_back(
          {name, wall.surfaces.areas[as_size(role)], wall.surfaces.pieces[as_size(role)]});
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
  for (const BorderRole role : wall.surfaces.roles) labels.of.push_back(number_of(role));
  const std::array<SurfaceColumn, 2> columns{std::move(thickness), std::move(depths)};
  write_surface(options.heart.surfaces, points, triangles, labels, columns, options.common.force);
  return summary;
}

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
