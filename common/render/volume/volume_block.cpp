#include "common/render/volume/volume_block.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/base/check.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

// Opacity beyond which less than a 512th of the light gets through.
constexpr float kOpaque = 1.0F - 1.0F / 512.0F;

enum class Content : std::uint8_t { kTransfer, kCut, kColored };

glm::vec4 part_of(int transfer, double samples, bool shaded, Content content) {
  return {transfer, samples, shaded ? 1.0F : 0.0F, static_cast<float>(content)};
}

glm::vec4 plane_in_scene(const ConvexShape::HalfSpace& h, const SceneFrame& frame) {
  const double offset = (h.offset - glm::dot(h.outward, frame.center)) * power_of_two(-frame.exponent);
  return {Vec3f(h.outward), std::clamp(offset, -1e30, 1e30)};
}

Content content_of(bool colored) { return colored ? Content::kColored : Content::kTransfer; }

}  // namespace

double largest_number(ScalarType type) noexcept {
  return type == ScalarType::kUint8 ? 255.0 : type == ScalarType::kUint16 ? 65535.0 : 1.0;
}

std::array<Vec3, 8> corners_in_scene(const VolumeImage& image, const SceneFrame& frame) {
  std::array<Vec3, 8> corners{};
  for (unsigned i = 0; i < corners.size(); ++i) {
    Vec3 g = image.lower();
    for (int a = 0; a < 3; ++a) {
      if ((i >> static_cast<unsigned>(a) & 1U) != 0) g[a] = image.upper()[a];
    }
    corners[i] = frame.scene_from_data(image.origin + image.axes * g);
  }
  return corners;
}

StepLengths step_lengths(const VolumeView& view) noexcept {
  const Mat3& axes = view.image->axes;
  double longest = 0.0, shortest = HUGE_VAL;
  for (int c = 0; c < 3; ++c) {
    // Powers of two keep squares of tiny spacings from vanishing.
    const double unit = power_of_two(
        binary_exponent(std::max({std::abs(axes[c].x), std::abs(axes[c].y), std::abs(axes[c].z)})));
    const double spacing = glm::length(axes[c] / unit) * unit;
    longest = std::max(longest, spacing);
    shortest = std::min(shortest, spacing);
  }
  double fewest = view.samples_per_voxel, most = view.samples_per_voxel;
  for (const Lens& lens : view.lenses) {
    fewest = std::min(fewest, lens.samples_per_voxel);
    most = std::max(most, lens.samples_per_voxel);
  }
  return {std::min(longest / fewest, kStepRatio * (shortest / most)), view.table_lengths};
}

NumberRange table_range(const VolumeView& view) noexcept {
  const VolumeImage& image = *view.image;
  if (image.lowest > image.highest) return {};
  double least = HUGE_VAL, most = -HUGE_VAL;
  const auto include = [&](const ColorTransfer& transfer) {
    if (transfer.points().empty()) return;
    least = std::min(least, transfer.points().front().value);
    most = std::max(most, transfer.points().back().value);
  };
  include(view.transfer);
  for (const Lens& lens : view.lenses) {
    if (lens.transfer) include(*lens.transfer);
  }
  double lower = std::max(image.lowest, least), upper = std::min(image.highest, most);
  if (!(lower < upper)) {
    lower = image.lowest;
    upper = image.highest;
  }
  const NumberRange range{(lower - image.offset) / image.scale, (upper - image.offset) / image.scale};
  if (range.lower < range.upper) return range;
  // One value alone: any range that begins there.
  return {range.lower, range.lower + std::max(1.0, std::abs(range.lower))};
}

VolumeBlock make_volume_block(const VolumeView& view, const SceneFrame& frame, const Index3& bricks) {
  PALPATE_CHECK(view.image != nullptr && view.lenses.size() <= kMostLenses && view.cuts.size() <= kMostCuts);
  const VolumeImage& image = *view.image;
  VolumeBlock block;

  // g = axes^-1 (x_X - origin), x_X = center + 2^e x_N. The exponent first: spacings may be tiny.
  const double to_scene = power_of_two(-frame.exponent);
  const Mat3 grid_from_scene = glm::inverse(image.axes * to_scene);
  const Vec3 at_center = grid_from_scene * ((frame.center - image.origin) * to_scene);
  block.grid_from_scene = glm::mat4(Mat4(grid_from_scene));
  block.grid_from_scene[3] = {Vec3f(at_center), 1.0F};

  const NumberRange range = table_range(view);
  const double entries = view.table_entries;
  const double unit = largest_number(image.type);
  block.lower = {Vec3f(image.lower()), range.lower / unit};
  block.upper = {Vec3f(image.upper()), (entries - 1.0) / entries * unit / (range.upper - range.lower)};
  block.points = {Vec3f(image.points), 0.5 / entries};
  block.bricks = {Vec3f(bricks), view.skip_empty ? 1.0F : 0.0F};
  const StepLengths steps = step_lengths(view);
  block.lengths = {steps.longest * to_scene / (steps.layers - 1), steps.layers,
                   view.stop_where_opaque ? kOpaque : 2.0F, asks_tiles(view) ? 1.0F : 0.0F};

  block.parts[0] = part_of(0, view.samples_per_voxel, view.shading, content_of(view.colored));
  int transfers = 1;
  for (std::size_t i = 0; i < view.lenses.size(); ++i) {
    const Lens& lens = view.lenses[i];
    const int transfer = lens.transfer ? transfers++ : 0;
    block.parts[i + 1] = part_of(transfer, lens.samples_per_voxel, lens.shading,
                                 lens.cut ? Content::kCut : content_of(lens.colored));
  }
  block.counts.x = static_cast<int>(view.lenses.size());
  for (const CuttingPlane& cut : view.cuts) {
    if (cut.on) block.cuts[static_cast<std::size_t>(block.counts.y++)] = plane_in_scene(cut.kept, frame);
  }
  return block;
}

LensBlock make_lens_block(const VolumeView& view, const SceneFrame& frame) {
  LensBlock block;
  const double to_data = power_of_two(frame.exponent);
  std::size_t next = 0;
  for (std::size_t i = 0; i < view.lenses.size(); ++i) {
    const ConvexShape& shape = view.lenses[i].shape;
    PALPATE_CHECK(shape.half_spaces.size() <= kMostHalfSpaces);
    block.unit_from_scene[i] = glm::mat4(0.0F);
    if (shape.quadric) {
      const Mat3 unit = shape.quadric->unit_from_data * to_data;
      block.unit_from_scene[i] = glm::mat4(Mat4(unit));
      block.unit_from_scene[i][3] = {Vec3f(unit * -frame.scene_from_data(shape.quadric->center)), 1.0F};
    }
    const double magnification = magnifies(view.lenses[i]) ? view.lenses[i].magnification : 1.0;
    block.centers[i] = {Vec3f(frame.scene_from_data(center_of(shape, frame.center))), magnification};
    block.faces[i] = {static_cast<int>(next), static_cast<int>(shape.half_spaces.size()), 0, 0};
    const Lens& lens = view.lenses[i];
    const ScreenCircle circle = lens.screen.value_or(ScreenCircle{.radius = 0.0});
    block.circles[i] = {circle.x, circle.y, circle.radius, has_transition(lens) ? lens.transition : 0.0};
    for (const ConvexShape::HalfSpace& h : shape.half_spaces) {
      block.planes[next++] = plane_in_scene(h, frame);
    }
  }
  return block;
}

}  // namespace palpate
