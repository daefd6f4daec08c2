#include "common/render/volume/volume_block.h"

#include <algorithm>
#include <cmath>

#include "common/base/check.h"
#include "common/math/power_of_two.h"

namespace palpate {
namespace {

// Opacity beyond which less than a 512th of the light gets through.
constexpr float kOpaque = 1.0F - 1.0F / 512.0F;

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
  PALPATE_CHECK(view.image != nullptr);
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

  block.counts.x = static_cast<int>(view.lenses.size());
  block.counts.y = static_cast<int>(
      std::count_if(view.cuts.begin(), view.cuts.end(), [](const CuttingPlane& cut) { return cut.on; }));
  return block;
}

}  // namespace palpate
