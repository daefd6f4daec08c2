#include "apps/cardiac/heart_scene.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <span>
#include <string_view>
#include <utility>
#include <variant>

#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/default_appearance.h"
#include "apps/cardiac/wall_view.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/text/lens_text.h"
#include "common/field/field_grid.h"
#include "common/field/field_on_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_choice.h"
#include "common/field/tensor/eigenframe.h"
#include "common/load/stated_unit.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"
#include "common/scene/seeds.h"
#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostTriangles = 4'000'000;

/// Of a ball.
double reach_along_x(const ConvexShape::Quadric& ball) { return 1.0 / glm::length(ball.unit_from_data[0]); }

double sampled(const ScalarField& field, const Vec3& x, CellHint& hint) {
  const ScalarSample sample = field.sample(x, hint);
  return sample.status == SampleStatus::kOk ? sample.value : kNaN;
}

}  // namespace

std::shared_ptr<const LayeredHeart> load_layered_heart(Input& input, const HeartOptions& options, int threads,
                                                       Progress* progress) {
  const std::string value = is_wall_word(angle_of(options)) ? std::string() : options.angle;
  return std::make_shared<const LayeredHeart>(input.load_heart(threads, progress, value));
}

OpenHeart open_heart(Input& input, int threads, Progress* progress) {
  OpenHeart open;
  if (!input.has_field()) {
    if (!input.spec().field.empty()) (void)input.field_label();  // an unknown one is refused
    open.bare = load_bare_heart(input, {}, nullptr, threads, progress);
  } else {
    Heart heart = input.load_heart(threads, progress, {}, LayersNeeded::kIfPossible);
    open.notes = heart.notes;
    if (heart.layer) {
      open.layered = std::make_shared<const LayeredHeart>(std::move(heart));
    } else {
      open.bare = load_bare_heart(input, heart.no_layers, heart.fibres, threads, progress);
    }
  }
  if (open.bare) open.notes.insert(open.notes.end(), open.bare->notes.begin(), open.bare->notes.end());
  return open;
}

Vec3 axis_of(const HeartOptions& options, const Heart& heart) {
  if (!options.axis.empty()) {
    const auto v = parse_numbers(options.axis, 3, "--axis takes the direction from apex to base: x,y,z");
    const Vec3 axis{v[0], v[1], v[2]};
    if (!(glm::length(axis) > 0.0)) throw usage_error("--axis " + options.axis + ": is no direction");
    return glm::normalize(axis);
  }
  if (heart.axis) return glm::normalize(*heart.axis);
  const auto axis = long_axis(*heart.layer);
  if (!axis)
    throw usage_error(
        "the wall does not open to one side, so that it has no base: name the direction from apex to base by "
        "--axis x,y,z");
  return *axis;
}

AngleProbe::AngleProbe(std::shared_ptr<const LayeredHeart> heart, const HeartOptions& options,
                       const std::shared_ptr<const ScalarField>& value)
    : heart_(std::move(heart)), options_(options), value_(value ? value : heart_->heart().value) {
  options_.angle = angle_of(options);
  for (int i = 0; i < kWallAngleCount; ++i) {
    const auto angle = static_cast<WallAngle>(i);
    if (name_of(angle) == options_.angle) angle_ = angle;
  }
  for (int i = 0; i < kAngleConventionCount; ++i) {
    const auto convention = static_cast<AngleConvention>(i);
    if (name_of(convention) == options.convention) convention_ = convention;
  }
  if (!angle_ && !is_wall_word(options_.angle) && !value_)
    throw usage_error("--angle " + options.angle + ": was not read with the heart");
  if (!angle_) return;
  if (!defines(convention_, *angle_))
    throw usage_error("--convention " + options.convention + " has no " + options.angle + " angle");
  if (*angle_ == WallAngle::kSheet && !heart_->heart().sheets)
    throw usage_error("--angle sheet: there are no sheet directions in this file");
  axis_ = axis_of(options, heart_->heart());
}

double AngleProbe::at(const Vec3& x, CellHint& hint) const {
  const LocalFrame& frame = heart_->frame();
  if (options_.angle == "depth") return sampled(*heart_->heart().layer, x, hint);
  if (!is_wall_word(options_.angle)) return sampled(*value_, x, hint);
  const FibreSample fibre = heart_->sample(frame.local_from_data(x), hint);
  if (fibre.status != SampleStatus::kOk) return kNaN;
  if (!angle_) return fibre.gap;
  if (!(fibre.gap >= kLeastGap)) return kNaN;
  const auto turned = [&frame](const Vec3& d) { return frame.rotated ? frame.rotation * d : d; };
  WallDirections at{.axis = axis_, .transmural = turned(fibre.normal), .fibre = fibre.fibre};
  if (*angle_ == WallAngle::kSheet) {
    const TensorSample sheet = heart_->heart().sheets->sample(x, hint);
    if (sheet.status != SampleStatus::kOk) return kNaN;
    const SymmetricEigen eigen = symmetric_eigen(sheet.value);
    if (!(eigen_gaps(eigen.values).major >= kLeastGap)) return kNaN;
    at.sheet = eigen.vectors[0];
  }
  const auto found = wall_angle(*angle_, convention_, at);
  return found ? kDegreesARadian * *found : kNaN;
}

std::vector<double> AngleProbe::map() const {
  if (angle_) return map_angle(heart_->heart(), heart_->normals(), axis_, *angle_, convention_);
  if (options_.angle == "gap") return map_gap(heart_->heart());
  return point_values(options_.angle == "depth" ? *heart_->heart().layer : *value_);
}

std::vector<double> values_at(const AngleProbe& probe, const std::vector<Vec3>& places, int threads) {
  std::vector<double> values(places.size());
  parallel_for(places.size(), threads, [&](std::size_t begin, std::size_t end) {
    CellHint hint;
    for (std::size_t p = begin; p < end; ++p) values[p] = probe.at(places[p], hint);
  });
  return values;
}

SurfaceView surface_of(const LayerGeometry& layer, const LayerColors& colors, double contours) {
  return {.mesh = layer.mesh, .color = kMuscle, .values = colors.values, .contours = contours};
}

std::uint64_t fingerprint(Input& input, Progress* progress) {
  std::uint64_t print = 1;
  const auto add = [&](const auto& numbers) {
    const auto bytes = std::as_bytes(std::span(numbers));
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    constexpr std::uint64_t kOdd = 0x9e3779b97f4a7c15U;  // turns the bits over, so that order counts
    print = (print ^ std::hash<std::string_view>()(text)) * kOdd;
  };
  const std::vector<std::string> arrays =
      input.fields().empty() ? std::vector<std::string>() : input.field_arrays();
  for (const DataSet& block : input.read(arrays, progress)) {
    for (const DataArray& array : block.arrays) add(array.bytes);
    if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology)) {
      add(cells->positions.bytes);
      add(cells->types);
      add(cells->connectivity);
    } else if (const auto* points = std::get_if<StructuredTopology>(&block.topology)) {
      add(points->positions.bytes);
    }
  }
  return std::max<std::uint64_t>(print, 1);
}

UnitNames units_of(const Input& input) {
  UnitNames units;
  if (stated_unit(input.file()->units, "coordinates") == "mm") units.length = "mm";
  units.time = stated_unit(input.file()->units, "times");
  return units;
}

std::vector<double> angles_along(const AngleProbe& probe, const std::vector<Line>& lines, int threads) {
  std::vector<std::size_t> first{0};
  for (const Line& line : lines) first.push_back(first.back() + line.points.size());
  std::vector<double> values(first.back());
  parallel_for(lines.size(), threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t l = begin; l < end; ++l) {
      CellHint hint;
      for (std::size_t p = 0; p < lines[l].points.size(); ++p)
        values[first[l] + p] = probe.at(lines[l].points[p].position, hint);
    }
  });
  return values;
}

IsosurfaceMesh layer_mesh(const LayeredHeart& heart, double depth, Progress* progress) {
  const ScalarField& depths = *heart.heart().layer;
  if (!(depth >= depths.lowest() && depth <= depths.highest()))
    throw usage_error("--layer " + short_number(depth) + ": the layers go from " +
                      short_number(depths.lowest()) + " to " + short_number(depths.highest()));
  if (progress) progress->begin("drawing the layer", 0);
  return make_isosurface_mesh(depths, depth, kMostTriangles, progress);
}

LayerGeometry make_layer_geometry(const LayeredHeart& heart, const Document& options, Progress* progress) {
  const ScalarField& depths = *heart.heart().layer;
  const double diagonal = depths.diagonal();
  LayerGeometry layer;
  layer.depth = layer_of(options.heart).value_or(kViewLayer);
  const auto plane = parse_cut(options.heart.cut);
  const std::string seeds = options.tracing.seeds.empty() ? kViewFibres : options.tracing.seeds;
  const double length = options.tracing.max_length;
  const auto places =
      make_seeds(parse_seeds(seeds), *depths.tet_mesh(), heart.frame(), depths.bounds(), options.common.seed);
  layer.seeds = places.size();
  layer.fibres =
      trace_fibres(heart, places,
                   {.layer = layer.depth,
                    .step = options.tracing.step > 0.0 ? options.tracing.step : kViewFibreStep * diagonal,
                    .max_length = length > 0.0 ? length : kViewFibreLength * diagonal,
                    .least_gap = options.heart.least_gap,
                    .threads = options.common.threads},
                   progress);
  if (plane) cut_lines(*plane, layer.fibres.lines);
  layer.lines = std::make_shared<const std::vector<Line>>(std::exchange(layer.fibres.lines, {}));
  IsosurfaceMesh mesh = layer_mesh(heart, layer.depth, progress);
  if (plane) cut_surface(*plane, mesh);
  layer.mesh = std::make_shared<const IsosurfaceMesh>(std::move(mesh));
  return layer;
}

LayerColors color_layer(Input& input, const std::shared_ptr<const LayeredHeart>& heart,
                        const LayerGeometry& layer, const HeartOptions& options, int threads,
                        const LineArray* before) {
  auto array = std::make_shared<LineArray>();
  std::shared_ptr<const ScalarField> value;
  if (!is_wall_word(angle_of(options))) {
    const ScalarChoice choice = choose_scalar(input.arrays(), options.angle, input.title());
    const std::vector<DataSet> blocks = input.read({choice.array});
    const auto& grid = heart->heart().fibres->grid();
    value = make_scalar_field(grid, blocks.front(), choice, input.title(), threads);
    const bool same = before != nullptr && before->name == options.angle;
    array->range = series_range(input, choice, *value, grid, same ? before->range : std::nullopt, threads);
  }
  LayerColors colors;
  colors.probe = std::make_shared<const AngleProbe>(heart, options, value);
  const AngleProbe& probe = *colors.probe;
  array->name = probe.name();
  array->unit = probe.is_angle() ? "degrees" : stated_unit(input.file()->units, probe.name());
  const std::vector<double> along = angles_along(probe, *layer.lines, threads);
  array->values.assign(along.begin(), along.end());
  if (probe.is_angle()) {
    constexpr double kRightAngle = 90.0;
    array->range = ValueRange{-kRightAngle, kRightAngle};
    array->color_map = ColorMap::kDiverging;
  }
  colors.style.color_by = ColorBy::kArray;
  colors.style.array = std::move(array);
  const std::vector<double> on_mesh = values_at(probe, layer.mesh->points, threads);
  colors.values = std::make_shared<const std::vector<float>>(on_mesh.begin(), on_mesh.end());
  return colors;
}

std::optional<ColorLens> lens_of(const HeartOptions& options) {
  if (options.lens.empty()) return std::nullopt;
  const Lens lens = parse_lens(options.lens).lens;
  const auto& ball = lens.shape.quadric;
  const double radius = lens.shape.half_spaces.empty() && ball ? reach_along_x(*ball) : 0.0;
  if (!(radius > 0.0)) throw usage_error("--lens " + options.lens + ": a ball is expected: sphere:x,y,z,r");
  return ColorLens{.center = ball->center, .radius = radius, .style = {}};
}

LayerScene make_layer_scene(Input& input, const std::shared_ptr<const LayeredHeart>& heart,
                            const Document& options, double aspect, Progress* progress) {
  const ScalarField& depths = *heart->heart().layer;
  LayerScene scene{.view = {}, .layer = make_layer_geometry(*heart, options, progress)};
  SceneView& view = scene.view;
  const int threads = options.common.threads;
  LayerColors colors = color_layer(input, heart, scene.layer, options.heart, threads);
  const bool is_angle = colors.probe->is_angle();
  view.surfaces = {surface_of(scene.layer, colors, options.heart.contours)};
  Document asked = options;
  if (asked.heart.walls == "auto")
    asked.heart.walls = "none";  // a window shows first what was found, a picture does not
  WallPictures walls;
  add_wall(input, *heart, asked, colors, walls, view.surfaces, progress);
  view.color_lens = lens_of(options.heart);
  if (view.color_lens) {
    HeartOptions inside = options.heart;
    inside.angle = options.heart.lens_angle;
    const LayerColors other = color_layer(input, heart, scene.layer, inside, threads);
    view.color_lens->style = other.style;
    view.surfaces.front().lens_values = other.values;
  }
  view.style = std::move(colors.style);
  apply_appearance(options, view);
  view.bounds = depths.bounds();
  view.lines = scene.layer.lines;
  view.title = input.title();
  const std::string angle = angle_of(options.heart);
  view.subtitle = "fibres at depth " + short_number(scene.layer.depth) + ", " + angle +
                  (is_angle ? " angle (" + options.heart.convention + ")" : "");
  view.units = units_of(input);
  if (input.times().size() > 1)
    view.subtitle += ", time " + short_number(input.times()[input.time().step]) +
                     (view.units.time.empty() ? "" : " " + view.units.time);
  if (options.heart.contours > 0.0) view.subtitle += ", lines every " + short_number(options.heart.contours);
  view.camera = camera_of(options.view, view.bounds, aspect, view.camera.projection);
  return scene;
}

}  // namespace palpate
