#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/coordinates_map.h"
#include "apps/cardiac/default_appearance.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/compose/text/plane_image_text.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/layer/wall_layer.h"
#include "common/load/write/write_lines.h"
#include "common/load/write/write_mesh.h"
#include "common/math/units.h"
#include "common/scene/wall/open_wall.h"
#include "common/trace/isosurface/surface_contours.h"

namespace palpate {
namespace {

/// Lines with the value that each has: one column of all points. `seed` of a line is the index of its value,
/// `error` of a point how far it is off at most along its edge, as the value found there tells [data units].
struct LayerContours {
  double depth = 0.0;  ///< of the layer
  std::vector<Line> lines;
  PointColumn values{.name = "value", .values = {}};
  double lowest = 0.0, highest = 0.0;  ///< of what the layer has
};

constexpr std::size_t kMostValues = 1000;
/// Of the largest coordinate: a place is never more exact.
constexpr double kRounding = 0x1p-44;
/// Directions have no sign: an angle of 90 degrees is one of -90.
constexpr double kPeriodOfAngles = 180.0;

std::vector<double> values_of(const HeartOptions& options, double lowest, double highest) {
  if (!options.contour_values.empty()) return parse_contours(options.contour_values);
  const double first = std::ceil(lowest / options.contours), last = std::floor(highest / options.contours);
  if (last - first >= static_cast<double>(kMostValues))
    throw usage_error("--contour-spacing " + short_number(options.contours) + ": more than " +
                      std::to_string(kMostValues) + " values from " + short_number(lowest) + " to " +
                      short_number(highest));
  std::vector<double> values;
  for (int n = 0; first + n <= last; ++n) values.push_back((first + n) * options.contours);
  return values;
}

/// From a value of an angle or another one.
double apart(double value, double from, bool angle) {
  return angle ? std::remainder(value - from, kPeriodOfAngles) : value - from;
}

/// Whether `--contours` or `--contour-spacing` asks for them. @throws Error (usage) where both do, or a word
/// is no number.
bool wants_contours(const HeartOptions& options) {
  const bool listed = !options.contour_values.empty();
  if (listed && options.contours > 0.0)
    throw usage_error(
        "--contours lists the values, --contour-spacing says how far apart they are: one of them");
  if (listed) (void)parse_contours(options.contour_values);
  return listed || options.contours > 0.0;
}

/// Of the layer that `--layer` names, half way through the wall without it.
/// @throws Error (usage) for a layer that is not there and for more than a thousand values; (work failed)
/// where no line has any of the values, naming those that there are; Cancelled.
LayerContours make_layer_contours(const LayeredHeart& heart, const AngleProbe& probe, const Document& options,
                                  Progress* progress) {
  LayerContours out;
  out.depth = layer_of(options.heart).value_or(kViewLayer);
  const IsosurfaceMesh mesh = layer_mesh(heart, out.depth, progress);
  const std::vector<double> found = values_at(probe, mesh.points, options.common.threads);
  out.lowest = std::numeric_limits<double>::infinity();
  out.highest = -out.lowest;
  for (const double value : found) {
    if (!std::isfinite(value)) continue;
    out.lowest = std::min(out.lowest, value);
    out.highest = std::max(out.highest, value);
  }
  const Box& bounds = heart.heart().layer->bounds();
  const Vec3 farthest = glm::max(glm::abs(bounds.lower), glm::abs(bounds.upper));
  const double rounding = kRounding * std::max({farthest.x, farthest.y, farthest.z});
  const bool angle = probe.is_angle();
  const double most = angle ? 0.5 * kPeriodOfAngles : std::numeric_limits<double>::infinity();
  std::vector<double> above(found.size());
  CellHint hint;
  if (out.lowest <= out.highest) {
    const std::vector<double> values = values_of(options.heart, out.lowest, out.highest);
    for (std::size_t v = 0; v < values.size(); ++v) {
      if (progress) progress->check();
      for (std::size_t p = 0; p < found.size(); ++p) above[p] = apart(found[p], values[v], angle);
      for (const SurfaceContour& contour : surface_contours(mesh, above, most)) {
        const bool closed = contour.front().position == contour.back().position;
        Line line{.end = closed ? End::kLoop : End::kLeftDomain, .seed = static_cast<std::uint32_t>(v)};
        double arc = 0.0;
        for (const EdgePoint& at : contour) {
          if (!line.points.empty()) arc += glm::distance(line.points.back().position, at.position);
          const double steep = (above[at.above] - above[at.below]) /
                               glm::distance(mesh.points[at.above], mesh.points[at.below]);
          const double off = std::abs(apart(probe.at(at.position, hint), values[v], angle)) / steep;
          line.points.push_back(
              {.position = at.position, .arc = arc, .error = rounding + (std::isfinite(off) ? off : 0.0)});
        }
        out.values.values.insert(out.values.values.end(), line.points.size(), values[v]);
        out.lines.push_back(std::move(line));
      }
    }
  }
  if (!out.lines.empty()) return out;
  throw work_error("no line at depth " + short_number(out.depth) + ": " + probe.name() +
                   (out.lowest <= out.highest ? " reaches from " + short_number(out.lowest) + " to " +
                                                    short_number(out.highest) + " there"
                                              : " is not defined there"));
}

constexpr int kBands = 11;  // of the depth: the surfaces have half a band each

/// The values of a band.
class BandMean {
 public:
  /// @param angle values are degrees of directions without sign: 90 and -90 are the same.
  explicit BandMean(bool angle) : angle_(angle) {}

  void add(double value) {
    values_.push_back(value);
    if (angle_) {
      cosine_ += std::cos(2.0 * kRadiansADegree * value);
      sine_ += std::sin(2.0 * kRadiansADegree * value);
    } else {
      cosine_ += value;
    }
  }

  [[nodiscard]] MapSummary::Band result(double depth) const {
    MapSummary::Band band{.depth = depth, .points = values_.size()};
    if (values_.empty()) return band;
    const auto count = static_cast<double>(values_.size());
    band.mean = angle_ ? 0.5 * std::atan2(sine_, cosine_) / kRadiansADegree : cosine_ / count;
    double squares = 0.0;
    constexpr double kHalfTurn = 180.0;
    for (const double value : values_) {
      const double off = angle_ ? std::remainder(value - band.mean, kHalfTurn) : value - band.mean;
      squares += off * off;
    }
    band.deviation = std::sqrt(squares / count);
    return band;
  }

 private:
  bool angle_;
  std::vector<double> values_;
  double cosine_ = 0.0, sine_ = 0.0;
};

std::vector<MapSummary::Band> bands_of(const std::vector<double>& values, const std::vector<double>& depths,
                                       const ScalarField& layer, bool angle) {
  std::vector<BandMean> means(kBands, BandMean(angle));
  const double range = layer.highest() - layer.lowest();
  for (std::size_t p = 0; p < values.size(); ++p) {
    const double part = (depths[p] - layer.lowest()) / range;
    if (!std::isfinite(values[p]) || !(part >= 0.0 && part <= 1.0)) continue;
    means[static_cast<std::size_t>(std::lround(part * (kBands - 1)))].add(values[p]);
  }
  std::vector<MapSummary::Band> bands;
  for (int b = 0; b < kBands; ++b) {
    const double part = static_cast<double>(b) / (kBands - 1);
    bands.push_back(means[static_cast<std::size_t>(b)].result(layer.lowest() + part * range));
  }
  return bands;
}

std::string summary_text(const MapSummary& summary) {
  std::string text = summary.input + ": " + summary.angle +
                     (summary.convention.empty() ? "" : " angle (" + summary.convention + ")") + " at " +
                     counted(summary.points, "point");
  text += summary.output.empty() ? "\n" : " -> " + summary.output + "\n";
  if (summary.layer)
    text += "  contours   " + counted(summary.lines, "line") + " of equal value at depth " +
            short_number(*summary.layer) + "\n";
  if (!summary.convention.empty())
    text += "  axis       " + short_number(summary.axis.x) + ", " + short_number(summary.axis.y) + ", " +
            short_number(summary.axis.z) + ", from apex to base\n";
  if (summary.undefined > 0) text += "  undefined  at " + counted(summary.undefined, "point") + "\n";
  for (const MapSummary::Band& band : summary.bands) {
    if (band.points == 0) continue;
    text += "  depth " + short_number(band.depth) + "  mean " + short_number(band.mean) + ", deviation " +
            short_number(band.deviation) + " (" + counted(band.points, "point") + ")\n";
  }
  return text;
}

void write_columns(const ScalarField& layer, const std::vector<MeshColumn>& columns,
                   const std::optional<Vec3>& axis, const Document& options, const VerbContext& context) {
  const TetMesh& mesh = *layer.tet_mesh();
  std::vector<Vec3> points;
  points.reserve(mesh.points().size());
  for (const Vec3& x : mesh.points()) points.push_back(layer.frame().data_from_local(x));
  write_mesh(options.output.file, points, mesh.cells(), columns, options.common.force, axis);
  context.interrupt.keep(options.output.file);
}

ExitCode report(MapSummary summary, const Input& input, const std::vector<double>& values,
                const Document& options, const VerbContext& context) {
  summary.input = input.title();
  summary.output = options.output.file.string();
  summary.points = values.size();
  for (const double value : values) summary.undefined += std::isfinite(value) ? 0 : 1;
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  context.console.print(summary_text(summary));
  context.console.print_json(map_json(summary));
  return ExitCode::kDone;
}

/// The depth asks for no fibres.
ExitCode map_depth(Input& input, const Document& options, const VerbContext& context) {
  const Stopwatch watch;
  const int threads = options.common.threads;
  const OpenWall wall = open_wall(input, {}, threads, &context.progress);
  WallLayer made = make_wall_layer(*wall.grid, wall.mesh, input.title(), threads);
  for (const std::string& note : made.notes) context.console.note(input.title() + ": " + note);
  DataSet mesh = wall.mesh;
  mesh.arrays = {std::move(made.array)};
  const auto layer = make_scalar_field(wall.grid, mesh, {.array = kLayerArray}, input.title(), threads);
  const std::vector<double> depths = point_values(*layer);
  MapSummary summary;
  summary.angle = "depth";
  summary.bands = bands_of(depths, depths, *layer, false);
  if (!options.output.file.empty())
    write_columns(*layer, {{"depth", depths}}, input.file()->long_axis, options, context);
  summary.seconds_map = watch.seconds();
  return report(std::move(summary), input, depths, options, context);
}

ExitCode run_map(const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
  if (options.heart.coordinates) return map_coordinates(options, context);
  if (options.output.file.empty() && !options.common.json)
    throw usage_error("map needs an output: try --out helix.vtu (or --json to get the means alone)");
  const bool as_lines = wants_contours(options.heart);
  if (as_lines && options.output.file.empty())
    throw usage_error("--contours are written: try --out contours.vtp");
  if (!as_lines && !options.heart.layer.empty())
    throw usage_error("--layer: the map is of the whole wall; --contours V,V,... writes lines of one layer");
  if (as_lines) {
    check_line_output(options.output.file, options.common.force);
  } else if (!options.output.file.empty()) {
    check_mesh_output(options.output.file, options.common.force);
  }
  Input input = open_input(options, context);
  console.note(input.choice_sentence());
  if (!input.has_field() && options.heart.angle == "depth" && !as_lines)
    return map_depth(input, options, context);
  const auto heart = load_layered_heart(input, options.heart, options.common.threads, &context.progress);
  for (const std::string& note : heart->heart().notes) console.note(input.title() + ": " + note);
  const AngleProbe probe(heart, options.heart);

  const Stopwatch watch;
  const ScalarField& layer = *heart->heart().layer;
  const std::vector<double> values = probe.map();
  HeartOptions depth_options = options.heart;
  depth_options.angle = "depth";
  const std::vector<double> depths = AngleProbe(heart, depth_options).map();
  MapSummary summary;
  summary.field = input.field_label();
  summary.angle = probe.name();
  if (probe.is_angle()) summary.convention = options.heart.convention;
  summary.axis = probe.axis();
  summary.bands = bands_of(values, depths, layer, probe.is_angle());
  summary.seconds_map = watch.seconds();
  if (as_lines) {
    const LayerContours contours = make_layer_contours(*heart, probe, options, &context.progress);
    summary.lines = contours.lines.size();
    summary.layer = contours.depth;
    write_lines(options.output.file, contours.lines, options.common.force, std::span(&contours.values, 1));
    context.interrupt.keep(options.output.file);
  } else if (!options.output.file.empty()) {
    std::vector<MeshColumn> columns{{probe.name(), values}};
    if (probe.name() != "depth") columns.push_back({"depth", depths});
    write_columns(layer, columns, heart->heart().axis, options, context);
  }
  return report(std::move(summary), input, values, options, context);
}

}  // namespace

Verb map_angles_verb(std::vector<UsageExample> examples) {
  return {.name = "map",
          .summary =
              "write angles of fibres and sheets as a mesh, or lines of equal value on a layer, and say how "
              "they turn through the wall; or the coordinates of the wall",
          .groups = {Group::kInput, Group::kLayer, Group::kAngle, Group::kContours, Group::kCoordinates,
                     Group::kOut},
          .examples = std::move(examples),
          .run = run_map};
}

}  // namespace palpate
