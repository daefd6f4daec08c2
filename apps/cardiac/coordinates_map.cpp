#include "apps/cardiac/coordinates_map.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/layer/wall_coordinates.h"
#include "common/load/write/write_mesh.h"
#include "common/scene/wall/open_wall.h"

namespace palpate {
namespace {

CoordinatesSummary::Column column_summary(const MeshColumn& column) {
  CoordinatesSummary::Column summary{.name = column.name,
                                     .lower = std::numeric_limits<double>::infinity(),
                                     .upper = -std::numeric_limits<double>::infinity()};
  for (const double value : column.values) {
    if (!std::isfinite(value)) {
      ++summary.undefined;
      continue;
    }
    summary.lower = std::min(summary.lower, value);
    summary.upper = std::max(summary.upper, value);
  }
  return summary;
}

std::string coordinates_text(const CoordinatesSummary& summary) {
  std::string text = summary.input + ": coordinates of the wall at " + counted(summary.points, "point");
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  for (const CoordinatesSummary::Column& column : summary.columns)
    text += "  " + column.name +
            std::string(std::max<std::size_t>(13, column.name.size() + 1) - column.name.size(), ' ') +
            short_number(column.lower) + " to " + short_number(column.upper) +
            (column.undefined > 0 ? ", not defined at " + counted(column.undefined, "point") : "") + "\n";
  for (const std::string& note : summary.notes) text += "  note         " + note + "\n";
  return text;
}

}  // namespace

ExitCode map_coordinates(const Document& options, const VerbContext& context) {
  if (!options.heart.angle.empty() || !options.heart.contour_values.empty() || options.heart.contours > 0.0 ||
      !options.heart.layer.empty())
    throw usage_error(
        "--coordinates are of the whole wall and stand alone: without --angle, --layer and --contours");
  if (options.output.file.empty() && !options.common.json)
    throw usage_error("map needs an output: try --out coordinates.vtu (or --json to get the ranges alone)");
  if (!options.output.file.empty()) check_mesh_output(options.output.file, options.common.force);
  Input input = open_input(options, context);
  const Stopwatch watch;
  const OpenWall wall = open_wall(input, {}, options.common.threads, &context.progress);
  context.progress.begin("finding the coordinates of the wall", 0);
  WallCoordinates made =
      make_wall_coordinates(*wall.grid, wall.surfaces, input.title(), options.common.threads);

  const auto place = [&](std::uint32_t p) {
    return wall.grid->frame.data_from_local(wall.grid->tets->points()[p]);
  };
  CoordinatesSummary summary{.input = input.title(),
                             .output = options.output.file.string(),
                             .axis = made.axis.direction,
                             .middle = made.axis.middle,
                             .apex_inner = place(made.axis.apex.front()),
                             .apex_outer = place(made.axis.apex.back()),
                             .points = wall.grid->tets->points().size(),
                             .columns = {},
                             .notes = wall.notes};
  summary.notes.insert(summary.notes.end(), made.notes.begin(), made.notes.end());
  if (wall.surfaces.pieces[as_size(BorderRole::kInner)] > 1)
    summary.notes.push_back(
        "the inner surface is of " + counted(wall.surfaces.pieces[as_size(BorderRole::kInner)], "piece") +
        " that nothing tells apart: the axis is that of all together, and which ventricle is "
        "not said");
  std::vector<MeshColumn> columns;
  columns.push_back({.name = "transmural", .values = std::move(made.transmural)});
  columns.push_back({.name = "apicobasal", .values = std::move(made.apicobasal)});
  columns.push_back({.name = "rotational", .values = std::move(made.rotational)});
  if (!made.ventricle.empty()) columns.push_back({.name = "ventricle", .values = std::move(made.ventricle)});
  for (const MeshColumn& column : columns) summary.columns.push_back(column_summary(column));
  if (!options.output.file.empty()) {
    std::vector<Vec3> points;
    for (std::uint32_t p = 0; p < summary.points; ++p) points.push_back(place(p));
    write_mesh(options.output.file, points, wall.grid->tets->cells(), columns, options.common.force,
               input.file()->long_axis);
    context.interrupt.keep(options.output.file);
  }
  summary.seconds = watch.seconds();
  context.console.print(coordinates_text(summary));
  context.console.print_json(coordinates_json(summary));
  return ExitCode::kDone;
}

}  // namespace palpate
