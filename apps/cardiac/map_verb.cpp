#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/contour_output.h"
#include "apps/cardiac/heart_scene.h"
#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/grid/tet_mesh.h"
#include "common/load/write/write_mesh.h"

namespace palpate {
namespace {

constexpr int kBands = 11;  // of the depth: the surfaces have half a band each
constexpr double kRadians = std::numbers::pi / 180.0;

/// The values of a band.
class BandMean {
 public:
  /// @param angle values are degrees of directions without sign: 90 and -90 are the same.
  explicit BandMean(bool angle) : angle_(angle) {}

  void add(double value) {
    values_.push_back(value);
    if (angle_) {
      cosine_ += std::cos(2.0 * kRadians * value);
      sine_ += std::sin(2.0 * kRadians * value);
    } else {
      cosine_ += value;
    }
  }

  [[nodiscard]] MapSummary::Band result(double depth) const {
    MapSummary::Band band{.depth = depth, .points = values_.size()};
    if (values_.empty()) return band;
    const auto count = static_cast<double>(values_.size());
    band.mean = angle_ ? 0.5 * std::atan2(sine_, cosine_) / kRadians : cosine_ / count;
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

ExitCode run_map(const Document& options, const VerbContext& context) {
  Console& console = context.console;
  if (list_examples(options, context)) return ExitCode::kDone;
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
  summary.input = input.title();
  summary.field = input.field_label();
  summary.output = options.output.file.string();
  summary.angle = probe.name();
  if (probe.is_angle()) summary.convention = options.heart.convention;
  summary.axis = probe.axis();
  summary.points = values.size();
  for (const double value : values) summary.undefined += std::isfinite(value) ? 0 : 1;
  summary.bands = bands_of(values, depths, layer, probe.is_angle());
  summary.seconds_load = input.seconds_open() + input.seconds_read() + input.seconds_field();
  summary.seconds_map = watch.seconds();
  if (as_lines) {
    const LayerContours contours = make_layer_contours(*heart, probe, options, &context.progress);
    summary.lines = contours.lines.size();
    summary.layer = contours.depth;
    write_lines(options.output.file, contours.lines, options.common.force, std::span(&contours.values, 1));
    context.interrupt.keep(options.output.file);
  } else if (!options.output.file.empty()) {
    const TetMesh& mesh = *layer.tet_mesh();
    std::vector<Vec3> points;
    points.reserve(values.size());
    for (const Vec3& x : mesh.points()) points.push_back(layer.frame().data_from_local(x));
    std::vector<MeshColumn> columns{{probe.name(), values}};
    if (probe.name() != "depth") columns.push_back({"depth", depths});
    write_mesh(options.output.file, points, mesh.cells(), columns, options.common.force, heart->heart().axis);
    context.interrupt.keep(options.output.file);
  }
  console.print(summary_text(summary));
  console.print_json(map_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb map_angles_verb(std::vector<UsageExample> examples) {
  return {.name = "map",
          .summary =
              "write angles of fibres and sheets as a mesh, or lines of equal value on a layer, and say how "
              "they turn "
              "through the wall",
          .groups = {Group::kInput, Group::kLayer, Group::kAngle, Group::kContours, Group::kOut},
          .examples = std::move(examples),
          .run = run_map};
}

}  // namespace palpate
