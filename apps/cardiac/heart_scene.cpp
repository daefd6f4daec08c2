#include "apps/cardiac/heart_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "apps/cardiac/cut_away.h"
#include "common/app/cli/line_view.h"
#include "common/base/error.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/field/field_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/tensor/eigenframe.h"
#include "common/math/symmetric3.h"
#include "common/scene/seeds.h"
#include "common/trace/isosurface_mesh.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegrees = 57.29577951308232;
constexpr std::size_t kMostTriangles = 4'000'000;
constexpr Rgb kMuscle{0.55F, 0.30F, 0.27F};

/// What is not the name of a scalar of the file.
bool is_own_word(const std::string& angle) {
  for (int i = 0; i < kWallAngleCount; ++i)
    if (name_of(static_cast<WallAngle>(i)) == angle) return true;
  return angle == "gap" || angle == "depth";
}

/// As stored, at the points of its mesh.
std::vector<double> point_values(const ScalarField& field) {
  std::vector<double> values(field.tet_mesh()->points().size());
  std::visit(
      [&](const auto& stored) {
        for (std::size_t p = 0; p < values.size(); ++p) values[p] = static_cast<double>(stored[p]);
      },
      field.values().values);
  return values;
}

double sampled(const ScalarField& field, const Vec3& x, CellHint& hint) {
  const ScalarSample sample = field.sample(x, hint);
  return sample.status == SampleStatus::kOk ? sample.value : kNaN;
}

}  // namespace

std::shared_ptr<const LayeredHeart> load_layered_heart(Input& input, const HeartOptions& options, int threads,
                                                       Progress* progress) {
  const std::string value = is_own_word(options.angle) ? std::string() : options.angle;
  return std::make_shared<const LayeredHeart>(input.load_heart(threads, progress, value));
}

std::optional<double> layer_of(const HeartOptions& options) {
  if (options.layer.empty()) return std::nullopt;
  return parse_numbers(options.layer, 1, "--layer takes a depth from 0 (inner) to 1 (outer)").front();
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
    throw usage_error("the wall is closed, so that it has no base: name the direction by --axis x,y,z");
  return *axis;
}

AngleProbe::AngleProbe(std::shared_ptr<const LayeredHeart> heart, const HeartOptions& options)
    : heart_(std::move(heart)), options_(options) {
  for (int i = 0; i < kWallAngleCount; ++i) {
    const auto angle = static_cast<WallAngle>(i);
    if (name_of(angle) == options.angle) angle_ = angle;
  }
  for (int i = 0; i < kAngleConventionCount; ++i) {
    const auto convention = static_cast<AngleConvention>(i);
    if (name_of(convention) == options.convention) convention_ = convention;
  }
  if (!angle_ && !is_own_word(options.angle) && !heart_->heart().value)
    throw usage_error("--angle " + options.angle + ": was not read with the heart");
  if (!angle_) return;
  if (!defines(convention_, *angle_))
    throw usage_error("--convention " + options.convention + " has no " + options.angle + " angle");
  if (*angle_ == WallAngle::kSheet && !heart_->heart().sheets)
    throw usage_error("--angle sheet: there are no sheet directions in this file");
  axis_ = axis_of(options, heart_->heart());
}

const char* AngleProbe::unit() const noexcept { return angle_ ? "degrees" : ""; }

double AngleProbe::at(const Vec3& x, CellHint& hint) const {
  const LocalFrame& frame = heart_->frame();
  if (options_.angle == "depth") return sampled(*heart_->heart().layer, x, hint);
  if (!is_own_word(options_.angle)) return sampled(*heart_->heart().value, x, hint);
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
  return found ? kDegrees * *found : kNaN;
}

std::vector<double> AngleProbe::map() const {
  if (angle_) return map_angle(heart_->heart(), heart_->normals(), axis_, *angle_, convention_);
  if (options_.angle == "gap") return map_gap(heart_->heart());
  return point_values(options_.angle == "depth" ? *heart_->heart().layer : *heart_->heart().value);
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

LayerScene make_layer_scene(const Input& input, const std::shared_ptr<const LayeredHeart>& heart,
                            const Options& options, double aspect, Progress* progress) {
  const ScalarField& layer = *heart->heart().layer;
  const double diagonal = layer.diagonal();
  LayerScene scene;
  scene.depth = layer_of(options.heart).value_or(kViewLayer);
  const auto plane = parse_cut(options.heart.cut);
  const std::string seeds = options.tracing.seeds.empty() ? kViewFibres : options.tracing.seeds;
  const double length = options.tracing.max_length;
  const auto places =
      make_seeds(parse_seeds(seeds), *layer.tet_mesh(), heart->frame(), layer.bounds(), options.common.seed);
  scene.fibres =
      trace_fibres(*heart, places,
                   {.layer = scene.depth,
                    .step = options.tracing.step > 0.0 ? options.tracing.step : kViewFibreStep * diagonal,
                    .max_length = length > 0.0 ? length : kViewFibreLength * diagonal,
                    .least_gap = options.heart.least_gap,
                    .threads = options.common.threads},
                   progress);
  if (plane) cut_lines(*plane, scene.fibres.lines);
  const auto lines = std::make_shared<const std::vector<Line>>(scene.fibres.lines);

  const AngleProbe probe(heart, options.heart);
  auto array = std::make_shared<LineArray>();
  array->name = probe.name();
  array->unit = probe.unit();
  for (const double value : angles_along(probe, *lines, options.common.threads))
    array->values.push_back(static_cast<float>(value));
  scene.view.style.color_by = ColorBy::kArray;
  scene.view.style.array = std::move(array);
  if (probe.is_angle()) {
    constexpr double kRightAngle = 90.0;
    scene.view.style.range = ValueRange{-kRightAngle, kRightAngle};
    scene.view.style.color_map = ColorMap::kDiverging;
  }
  constexpr double kThin = 1.6;
  scene.view.style.width = kThin;
  scene.view.style.halo = false;

  if (progress) progress->begin("drawing the layer", 0);
  IsosurfaceMesh mesh = make_isosurface_mesh(layer, scene.depth, kMostTriangles, progress);
  if (plane) cut_surface(*plane, mesh);
  scene.view.surfaces.push_back(
      {.mesh = std::make_shared<const IsosurfaceMesh>(std::move(mesh)), .color = kMuscle});
  scene.view.bounds = layer.bounds();
  scene.view.lines = lines;
  scene.view.title = input.title();
  scene.view.subtitle = "fibres at depth " + short_number(scene.depth) + ", " + probe.name() +
                        (probe.is_angle() ? " angle (" + options.heart.convention + ")" : "");
  if (!input.file()->units.empty() && input.file()->units.find("mm") != std::string::npos)
    scene.view.units.length = "mm";
  const Projection projection =
      options.volume.projection == "orthographic" ? Projection::kOrthographic : Projection::kPerspective;
  scene.view.camera = make_camera(scene.view.bounds, camera_angles(options.view.camera), aspect, projection);
  return scene;
}

}  // namespace palpate
