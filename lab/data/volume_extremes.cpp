#include "lab/data/volume_extremes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>

#include "common/field/data_set.h"
#include "common/render/gl/context.h"
#include "common/render/lens/lens.h"
#include "common/render/volume/volume_picture.h"

namespace palpate {
namespace {

constexpr int kPixels = 48;
constexpr double kStep = 1.0 / 255;  // of a screen
constexpr double kOpacity = 0.3;     // alpha
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kValueExponent = 60, kLengthExponent = 20;

/// A block of numbers; its longest side is 1 wide about the origin, unless `stretch` and `away` say otherwise.
struct Block {
  Index3 points{16};
  std::function<double(const Index3&)> value = [](const Index3&) { return 1.0; };
  Vec3 stretch{1.0};
  Vec3 away{0.0};
  double unit = 1.0;  ///< the value that is drawn
};

std::shared_ptr<const VolumeImage> image_of(const Block& block) {
  std::vector<double> numbers;
  Index3 at;
  for (at.z = 0; at.z < block.points.z; ++at.z) {
    for (at.y = 0; at.y < block.points.y; ++at.y) {
      for (at.x = 0; at.x < block.points.x; ++at.x) numbers.push_back(block.value(at));
    }
  }
  UniformTopology grid;
  grid.points = block.points;
  const double longest =
      std::max(1.0, static_cast<double>(std::max({block.points.x, block.points.y, block.points.z})) - 1.0);
  grid.axes = Mat3(Vec3(block.stretch.x / longest, 0, 0), Vec3(0, block.stretch.y / longest, 0),
                   Vec3(0, 0, block.stretch.z / longest));
  grid.origin = block.away;
  DataSet data;
  data.topology = grid;
  data.arrays.push_back(make_array("values", Association::kPoint, 1, std::span<const double>(numbers)));
  return make_volume_image(data, "values", "made data");
}

/// Matter from three quarters of the unit on, of one opacity along `length`.
VolumeView view_of(const Block& block, double length) {
  VolumeView view;
  view.image = image_of(block);
  const double unit = block.unit;
  view.transfer = ColorTransfer({{0.0, Vec3f(1.0F), 0.0},
                                 {0.75 * unit, Vec3f(1.0F), 0.0},
                                 {0.75 * unit, Vec3f(1.0F), kOpacity},
                                 {2.0 * unit, Vec3f(1.0F), kOpacity}});
  view.opacity_length = length;
  view.shading = false;
  return view;
}

/// Along the z axis, without perspective.
Camera along_z(const VolumeView& view) {
  return make_camera(view.image->bounds(), {.azimuth = 0.0, .elevation = 90.0}, 1.0,
                     Projection::kOrthographic);
}

double middle_opacity(const FloatImage& image) { return image.at(kPixels / 2, kPixels / 2)[3]; }

/// Largest of all numbers; infinite where one of them is none.
double brightest(const FloatImage& image) {
  double most = 0.0;
  for (const float number : image.rgba) {
    if (!std::isfinite(number)) return HUGE_VAL;
    most = std::max(most, std::abs(static_cast<double>(number)));
  }
  return most;
}

class Extremes {
 public:
  explicit Extremes(Progress* progress)
      : progress_(progress), picture_(kPixels, kPixels, VolumePicture::Context::kCurrent) {}

  /// A block seen along z: against (1 - alpha)^(d / l), d its depth.
  void depth(const std::string& name, const std::string& meaning, const Block& block) {
    const double depth = image_of(block)->bounds().size().z, length = 0.5 * depth;
    const VolumeView view = view_of(block, length);
    const double expected = 1.0 - std::pow(1.0 - kOpacity, depth / length);
    add(name, std::abs(middle_opacity(draw(view, along_z(view))) - expected), kStep, meaning);
  }

  /// A picture in which nothing is to be seen.
  void nothing(const std::string& name, const std::string& meaning, const VolumeView& view,
               const Camera& camera) {
    add(name, brightest(draw(view, camera)), 0.0, meaning);
  }

  /// Two pictures that are to be the same.
  void same(const std::string& name, const std::string& meaning, const VolumeView& view, const Camera& camera,
            const VolumeView& other, const Camera& other_camera) {
    const FloatImage picture = draw(view, camera);
    add(name, worst_difference(picture, draw(other, other_camera)), kStep, meaning);
  }

  /// A picture of numbers from 0 to 1.
  void sound(const std::string& name, const std::string& meaning, const VolumeView& view,
             const Camera& camera) {
    constexpr double kRounding = 1e-5;
    add(name, brightest(draw(view, camera)), 1.0 + kRounding, meaning);
  }

  [[nodiscard]] std::vector<StabilityCase> take() { return std::move(cases_); }

 private:
  FloatImage draw(const VolumeView& view, const Camera& camera) {
    if (progress_) progress_->check();
    return picture_.draw(view, camera);
  }
  void add(const std::string& name, double measured, double limit, const std::string& meaning) {
    cases_.push_back(make_case("volume, " + name, measured, limit, "of full scale", meaning));
  }

  Progress* progress_;
  VolumePicture picture_;
  std::vector<StabilityCase> cases_;
};

void made_blocks(Extremes& extremes) {
  extremes.depth("one value", "16 x 16 x 16 points, against the closed form", {});
  extremes.depth("two points a side", "the fewest that make cells", {.points = Index3(2)});
  extremes.depth("one slice", "a single point along the view: a step thick", {.points = {16, 16, 1}});
  extremes.depth("one voxel", "a single point", {.points = Index3(1)});
  extremes.depth("voxels of 1 : 1000", "a thousandth as thick as wide", {.stretch = {1, 1, 1e-3}});
  extremes.depth("voxels of 100 : 1", "a hundred times as thick as wide", {.stretch = {1, 1, 100}});
  extremes.depth("voxels of 1000 : 1", "a thousand times as thick as wide", {.stretch = {1, 1, 1e3}});
  extremes.depth("a million sides away", "coordinates about (1e6, 1e6, 1e6)", {.away = Vec3(1e6)});
  for (const double unit : {1e30, 1e-30}) {
    extremes.depth(unit > 1.0 ? "values of 1e30" : "values of 1e-30", "near the ends of single precision",
                   {.value = [unit](const Index3&) { return unit; }, .unit = unit});
  }
  extremes.depth("one value of 1e20 in a corner", "the range says nothing of the rest",
                 {.value = [](const Index3& at) { return at == Index3(0) ? 1e20 : 1.0; }});
  extremes.depth("a corner of NaN", "its cells show nothing, the others what they hold",
                 {.value = [](const Index3& at) { return at == Index3(0) ? kNaN : 1.0; }});
  const VolumeView empty = view_of({.value = [](const Index3&) { return kNaN; }}, 0.5);
  extremes.nothing("all NaN", "nothing is to be seen", empty, along_z(empty));
  // Half of the block is matter: a step between two voxels, seen along it on either side.
  const Block half{.value = [](const Index3& at) { return at.x < 8 ? 0.0 : 1.0; }};
  VolumeView right = view_of(half, 0.5);
  right.cuts.push_back({.kept = {Vec3(1, 0, 0), 0.4}});  // the matter begins at 7.75 / 15
  extremes.nothing("beside a step", "nothing of the matter behind a step of values, two voxels away", right,
                   along_z(right));
}

/// Symmetries of the data at hand.
void own_data(Extremes& extremes, VolumeView view) {
  view.lenses.clear();
  view.cuts.clear();
  view.planes = {};
  view.panes = {};
  const Camera camera = make_camera(view.image->bounds(), {}, 1.0);
  const auto altered = [&](const std::function<void(VolumeImage&)>& alter) {
    VolumeView other = view;
    auto image = std::make_shared<VolumeImage>(*view.image);
    alter(*image);
    other.image = std::move(image);
    return other;
  };
  if (!view.regions && !view.colored) {
    const double factor = std::ldexp(1.0, kValueExponent);
    VolumeView values = altered([&](VolumeImage& image) {
      for (double* number : {&image.scale, &image.offset, &image.lowest, &image.highest}) *number *= factor;
    });
    std::vector<ColorPoint> points = view.transfer.points();
    for (ColorPoint& point : points) point.value *= factor;
    values.transfer = ColorTransfer(std::move(points));
    extremes.same("this data, values by 2^60", "with its transfer function: the same picture", view, camera,
                  values, camera);
  }
  const double length = std::ldexp(1.0, kLengthExponent);
  VolumeView larger = altered([&](VolumeImage& image) {
    image.origin *= length;
    image.axes *= length;
  });
  larger.opacity_length = length * opacity_length_of(view);
  extremes.same("this data, lengths by 2^20", "the same picture", view, camera, larger,
                make_camera(larger.image->bounds(), {}, 1.0));

  const Box bounds = view.image->bounds();
  VolumeView lens = view;
  lens.lenses.push_back({.shape = make_sphere(bounds.lower, 0.5 * bounds.diagonal())});
  lens.lenses.back().samples_per_voxel = view.samples_per_voxel;
  lens.lenses.back().shading = view.shading;
  lens.lenses.back().colored = view.colored;
  extremes.same("this data, a lens on its corner", "that shows what is shown without it", view, camera, lens,
                camera);
  const Vec3 normal{1.0, 0.0, 0.0};
  VolumeView cut = view;
  cut.cuts.push_back({.kept = {normal, bounds.upper.x + bounds.diagonal()}});
  extremes.same("this data, a cut beyond it", "cuts nothing", view, camera, cut, camera);
  cut.cuts.back().kept = {normal, bounds.lower.x - bounds.diagonal()};
  extremes.nothing("this data, a cut before it", "leaves nothing", cut, camera);
  Camera inside = camera;
  inside.view_height *= 1e-3;
  extremes.sound("this data, seen from within", "a camera next to the middle of the volume", view, inside);
}

}  // namespace

std::vector<StabilityCase> run_volume_extremes(const VolumeView& view, Progress* progress) {
  const OffscreenContext context;
  Extremes extremes(progress);
  made_blocks(extremes);
  own_data(extremes, view);
  return extremes.take();
}

}  // namespace palpate
