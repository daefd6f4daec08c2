#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/render/lens/lens.h"
#include "lab/extremes/extreme.h"
#include "lab/extremes/picture_stage.h"

// Made volumes are seen along an axis through a block of one value, whose opacity along a way d is 1 - (1 - alpha)^(d / l)
// (Ikits 2006, eq. 2.1; color_transfer.h).

namespace palpate {
namespace {

constexpr double kOpacity = 0.3;  // alpha
constexpr double kPictureStep = PictureStage::kStep;
const char* const kUnit = "of full scale";

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

double middle_opacity(const FloatImage& image) {
  return image.at(PictureStage::kPixels / 2, PictureStage::kPixels / 2)[3];
}

/// From the focal point to where the middle of a pixel is seen on the focal plane.
Vec3 place_of(const Camera& camera, int i, int j) {
  const auto part = [](int pixel) { return (pixel + 0.5) / PictureStage::kPixels - 0.5; };
  return camera.view_height * (part(i) * camera.axes[0] + part(j) * camera.axes[1]);
}

/// Of a way through the matter.
double opacity_of(double way, double length) { return 1.0 - std::pow(1.0 - kOpacity, way / length); }

using Stage = std::shared_ptr<PictureStage>;

/// A block seen along z, drawn as `drawn`, against the closed form.
double depth_error(PictureStage& stage, const Block& block, const Block& drawn) {
  const double depth = image_of(block)->bounds().size().z, length = 0.5 * depth;
  const VolumeView view = view_of(drawn, length);
  const Camera camera = along_z(view);
  return std::abs(middle_opacity(stage.draw(view, camera)) - opacity_of(depth, length));
}

void add_volumes(std::vector<Extreme>& rows, const Stage& stage) {
  const auto depth = [&](const std::string& name, const std::string& builder, const Block& block,
                         double limit = kPictureStep) {
    rows.push_back({ExtremeKind::kVolume, name, builder, "opacity against the closed form", limit, kUnit,
                    [stage, block] { return depth_error(*stage, block, block); }});
  };
  depth("one value", "16 x 16 x 16 points", {});
  depth("two points a side", "the fewest that make cells", {.points = Index3(2)});
  depth("one slice", "a single point along the view: a step thick", {.points = {16, 16, 1}});
  depth("one voxel", "a single point", {.points = Index3(1)});
  depth("voxels of 1 : 1000", "a thousandth as thick as wide", {.stretch = {1, 1, 1e-3}});
  depth("voxels of 100 : 1", "a hundred times as thick as wide", {.stretch = {1, 1, 100}});
  // Steps are many and thin, and the 16 bits of a table add up (docs/limits.md).
  const Block thick{.stretch = {1, 1, 1e3}};
  depth("voxels of 1000 : 1", "a thousand times as thick as wide", thick, 0.02);
  rows.back().guard = "the thickness of voxels (as thick as wide)";
  rows.back().unguarded = [stage, thick] { return depth_error(*stage, thick, Block{}); };
  depth("a million sides away", "coordinates about (1e6, 1e6, 1e6)", {.away = Vec3(1e6)});
  for (const double unit : {1e30, 1e-30}) {
    depth(unit > 1.0 ? "values of 1e30" : "values of 1e-30", "near the ends of single precision",
          {.value = [unit](const Index3&) { return unit; }, .unit = unit});
  }
  depth("values of 1e20 and -1e20 in two corners", "the range says nothing of the rest",
        {.value = [](const Index3& at) { return at == Index3(0)    ? 1e20
                                                : at == Index3(15) ? -1e20
                                                                   : 1.0; }});
  depth("a corner of NaN", "its cells show nothing, the others what they hold",
        {.value = [](const Index3& at) { return at == Index3(0) ? kNaN : 1.0; }});
  const auto nothing = [&](const std::string& name, const std::string& builder, const Block& block,
                           const std::function<void(VolumeView&)>& alter) {
    rows.push_back({ExtremeKind::kVolume, name, builder, "the brightest number: nothing is to be seen", 0.0,
                    kUnit, [stage, block, alter] {
                      VolumeView view = view_of(block, 0.5);
                      const Camera camera = along_z(view);
                      if (alter) alter(view);
                      return brightest(stage->draw(view, camera));
                    }});
  };
  nothing("all NaN", "no value at all, where any would be seen and nothing is passed over",
          {.value = [](const Index3&) { return kNaN; }}, [](VolumeView& view) {
            view.transfer = ColorTransfer({{0.0, Vec3f(1.0F), kOpacity}, {2.0, Vec3f(1.0F), kOpacity}});
            view.skip_empty = false;
          });
  // The matter begins at 7.75 / 15.
  nothing("beside a step", "a step of values between two voxels, cut away two voxels before it",
          {.value = [](const Index3& at) { return at.x < 8 ? 0.0 : 1.0; }}, [](VolumeView& view) {
            view.cuts.push_back({.kept = {Vec3(1, 0, 0), 0.4}});
          });
  nothing("cut before its first voxel", "a cutting plane that keeps what lies before the volume", {},
          [](VolumeView& view) {
            view.cuts.push_back({.kept = {Vec3(1, 0, 0), -1.0}});
          });
  nothing("cut twice to nothing", "two cutting planes that keep nothing in common", {}, [](VolumeView& view) {
    view.cuts.push_back({.kept = {Vec3(1, 0, 0), 0.4}});
    view.cuts.push_back({.kept = {Vec3(-1, 0, 0), -0.6}});
  });
}

/// z between which the line along z through (x, y) lies in a shape; none where the first is not the smaller one.
using Chord = std::function<std::pair<double, double>(double x, double y)>;

Chord in_ball(const Vec3& center, double radius) {
  return [=](double x, double y) {
    const double square = radius * radius - (x - center.x) * (x - center.x) - (y - center.y) * (y - center.y);
    const double half = square > 0.0 ? std::sqrt(square) : 0.0;
    return std::pair{center.z - half, center.z + half};
  };
}

Chord in_box(const Vec3& center, const Vec3& half) {
  return [=](double x, double y) {
    const bool beside = std::abs(x - center.x) > half.x || std::abs(y - center.y) > half.y;
    return beside ? std::pair{0.0, 0.0} : std::pair{center.z - half.z, center.z + half.z};
  };
}

/// A block of one value in the unit cube, of which a lens cuts away what it holds: each pixel against the closed form.
double cut_error(PictureStage& stage, const ConvexShape& shape, const Chord& chord) {
  constexpr double kLength = 0.5;
  VolumeView view = view_of({}, kLength);
  view.lenses.push_back({.shape = shape, .cut = true});
  const Camera camera = along_z(view);
  const FloatImage image = stage.draw(view, camera);
  double worst = 0.0;
  for (int j = 0; j < PictureStage::kPixels; ++j) {
    for (int i = 0; i < PictureStage::kPixels; ++i) {
      const Vec3 x = camera.focal_point + place_of(camera, i, j);
      if (std::min({x.x, x.y, 1.0 - x.x, 1.0 - x.y}) < 0.0) continue;  // beside the cube
      const auto [from, to] = chord(x.x, x.y);
      const double way = 1.0 - std::max(0.0, std::min(to, 1.0) - std::max(from, 0.0));
      worst = std::max(worst, std::abs(image.at(i, j)[3] - opacity_of(way, kLength)));
    }
  }
  return worst;
}

void add_lenses(std::vector<Extreme>& rows, const Stage& stage) {
  const auto lens = [&](const std::string& name, const ConvexShape& shape, const Chord& chord) {
    rows.push_back({ExtremeKind::kLens, name, "cuts away what it holds of 16^3 points of one value",
                    "opacity of each pixel against the closed form", kPictureStep, kUnit,
                    [stage, shape, chord] { return cut_error(*stage, shape, chord); }});
  };
  const auto ball = [&](const std::string& name, const Vec3& center, double radius) {
    lens(name, make_sphere(center, radius), in_ball(center, radius));
  };
  const auto box = [&](const std::string& name, const Vec3& half) {
    lens(name, make_box(Vec3(0.5), Mat3(Vec3(half.x, 0, 0), Vec3(0, half.y, 0), Vec3(0, 0, half.z))),
         in_box(Vec3(0.5), half));
  };
  ball("on a corner", Vec3(0.0), 0.6);
  ball("on an edge", {0.5, 0.0, 0.0}, 0.6);
  ball("on the face before", {0.5, 0.5, 1.0}, 0.5);
  ball("that touches the face", {0.5, 0.5, 1.5}, 0.5);
  ball("beside the volume", {5.0, 5.0, 5.0}, 1.0);
  ball("around all of it", Vec3(0.5), 100.0);
  ball("of no size", Vec3(0.5), 0.0);
  ball("a millionth wide", Vec3(0.5), 1e-6);
  box("a box on its faces", Vec3(0.5));
  box("a plate a millionth thick", {0.5, 0.5, 1e-6});
  box("a plate along the view", {1e-6, 0.5, 0.5});
}

/// How far the eye's ray through a pixel next to the middle runs in the unit cube, before the eye.
double way_in_cube(const Camera& camera) {
  const Vec3 from = eye(camera), aim = camera.focal_point +
                                       place_of(camera, PictureStage::kPixels / 2, PictureStage::kPixels / 2);
  const Vec3 way = glm::normalize(aim - from);
  double first = 0.0, last = HUGE_VAL;
  for (int a = 0; a < 3; ++a) {
    const double low = -from[a] / way[a], high = (1.0 - from[a]) / way[a];
    first = std::max(first, std::min(low, high));
    last = std::min(last, std::max(low, high));
  }
  return std::max(0.0, last - first);
}

void add_cameras(std::vector<Extreme>& rows, const Stage& stage) {
  const auto sound = [&](const std::string& name, const std::string& builder,
                         const std::function<void(Camera&)>& move) {
    rows.push_back({ExtremeKind::kCamera, name, builder,
                    "opacity next to the middle against the closed form; no number of the picture is none",
                    kPictureStep, kUnit, [stage, move] {
                      constexpr double kLength = 0.5;
                      const VolumeView view = view_of({}, kLength);
                      Camera camera = make_camera(view.image->bounds(), {}, 1.0);
                      move(camera);
                      const FloatImage image = stage->draw(view, camera);
                      if (!std::isfinite(brightest(image))) return HUGE_VAL;
                      return std::abs(middle_opacity(image) - opacity_of(way_in_cube(camera), kLength));
                    }});
  };
  sound("within", "the eye next to the middle of the volume", [](Camera& c) { c.view_height *= 1e-3; });
  sound("within, a millionth of it seen", "the eye in its middle", [](Camera& c) { c.view_height *= 1e-6; });
  sound("on a corner", "the eye next to the corner of the volume", [](Camera& c) {
    c.focal_point = Vec3(0.0);
    c.view_height *= 1e-3;
  });
  sound("along a face", "the eye in the plane of a face", [](Camera& c) {
    c = make_camera({Vec3(0.0), Vec3(1.0)}, {.azimuth = 0.0, .elevation = 0.0}, 1.0);
    c.focal_point = Vec3(0.5, 0.5, 1.0);
  });
  sound("a field of view of 179 degrees", "from the middle", [](Camera& c) { c.field_of_view = 3.124; });
  const auto empty = [&](const std::string& name, const std::string& builder,
                         const std::function<void(Camera&)>& move) {
    rows.push_back({ExtremeKind::kCamera, name, builder, "the brightest number: nothing is to be seen", 0.0,
                    kUnit, [stage, move] {
                      const VolumeView view = view_of({}, 0.5);
                      Camera camera = along_z(view);
                      move(camera);
                      return brightest(stage->draw(view, camera));
                    }});
  };
  empty("that looks away", "the volume behind the eye", [](Camera& c) {
    c.projection = Projection::kPerspective;
    c.focal_point.z += 100.0;
    c.axes = Mat3(Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, -1));
  });
  rows.push_back({ExtremeKind::kCamera, "a thousand times too near",
                  "without perspective, on 16^3 points of one value", "opacity against the closed form",
                  kPictureStep, kUnit, [stage] {
                    constexpr double kLength = 0.5;
                    const VolumeView view = view_of({}, kLength);
                    Camera camera = along_z(view);
                    camera.view_height *= 1e-3;
                    return std::abs(middle_opacity(stage->draw(view, camera)) - opacity_of(1.0, kLength));
                  }});
}

}  // namespace

void add_picture_rows(std::vector<Extreme>& rows) {
  const auto stage = std::make_shared<PictureStage>();
  add_volumes(rows, stage);
  add_lenses(rows, stage);
  add_cameras(rows, stage);
}

}  // namespace palpate
