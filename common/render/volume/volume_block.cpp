#include "common/render/volume/volume_block.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/volume/voxels/axis_tables.h"
#include "common/render/volume/voxels/region_table.h"

namespace palpate {
namespace {

// std140 starts an array of structs at the next 16 bytes.
static_assert(offsetof(VolumeBlock, transfers) == 48 && sizeof(TransferBlock) == 16 &&
              sizeof(FieldBlock) == 176);

// Opacity beyond which less than a 512th of the light gets through.
constexpr float kOpaque = 1.0F - 1.0F / 512.0F;

// Entries by which tables of regions reach beyond these on either side.
constexpr double kRoom = 2.0;

// The longest and the shortest step from voxel to voxel [data units].
struct Spacings {
  double longest = 0.0, shortest = HUGE_VAL;

  void include(const Mat3& axes) {
    for (int c = 0; c < 3; ++c) {
      // Powers of two keep squares of tiny spacings from vanishing.
      const double unit = power_of_two(
          binary_exponent(std::max({std::abs(axes[c].x), std::abs(axes[c].y), std::abs(axes[c].z)})));
      const double spacing = glm::length(axes[c] / unit) * unit;
      longest = std::max(longest, spacing);
      shortest = std::min(shortest, spacing);
    }
  }
};

// @param first_line where the tables of the field's axes begin; then, where the next ones do.
FieldBlock make_field_block(const VolumeView& view, std::size_t field, const SceneFrame& frame,
                            const Index3& bricks, std::int32_t& first_line) {
  const VolumeImage& image = *image_of(view, field);
  FieldBlock block;
  // g = axes^-1 (x_X - origin), x_X = center + 2^e x_N. The exponent first: spacings may be tiny.
  const double to_scene = power_of_two(-frame.exponent);
  const Mat3 grid_from_scene = glm::inverse(image.axes * to_scene);
  const Vec3 at_center = grid_from_scene * ((frame.center - image.origin) * to_scene);
  block.grid_from_scene = glm::mat4(Mat4(grid_from_scene));
  block.grid_from_scene[3] = {Vec3f(at_center), 1.0F};

  const NumberRange range = table_range(view, field);
  const double entries = view.table_entries;
  const double unit = largest_number(image.type);
  block.lower = Vec3f(image.lower());
  block.first_number = static_cast<float>(range.lower / unit);
  block.upper = Vec3f(image.upper());
  block.entries_a_number = static_cast<float>((entries - 1.0) / entries * unit / (range.upper - range.lower));
  block.points = Vec3f(image.points);
  block.first_entry = static_cast<float>(0.5 / entries);
  const AxisTables tables = axis_tables(image);
  for (int a = 0; a < 3; ++a) {
    const auto axis = as_size(a);
    block.lines[axis] = tables.buckets[axis] > 0 ? first_line + tables.first[axis] : -1;
    block.buckets[axis] = tables.buckets[axis];
  }
  first_line += tables.size;
  constexpr float kNoSampling = 1e30F;
  block.bricks = Vec3f(bricks);
  block.samples_to_leap = view.skip_empty ? 0.0F : kNoSampling;

  // m = scale (upper - lower) E / (E - 1) |grad_N p| / 2^e for the table coordinate p of values.
  const double rows = kGradientEntries;
  const double last_row = (rows - 1.0) / rows, last_column = (entries - 1.0) / entries;
  const double values = std::abs(image.scale) * (range.upper - range.lower) / last_column;
  block.rows_a_slope = static_cast<float>(last_row * (values / highest_row(view, field) * to_scene));
  block.first_row = static_cast<float>(0.5 / rows);
  block.reference_lengths = static_cast<float>(1.0 / (opacity_length_of(view) * to_scene));
  return block;
}

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
  Spacings spacings;
  for (std::size_t field = 0; field < field_count(view); ++field) {
    if (shows_field(view, field)) spacings.include(image_of(view, field)->axes);
  }
  const double longest = spacings.longest, shortest = spacings.shortest;
  double fewest = view.samples_per_voxel, most = view.samples_per_voxel;
  for (const Lens& lens : view.lenses) {
    fewest = std::min(fewest, lens.samples_per_voxel);
    most = std::max(most, lens.samples_per_voxel);
  }
  const double far = samples_less_far(view) ? view.far_sampling : 1.0;
  return {std::min(far * longest / fewest, kStepRatio * (shortest / most)), view.table_lengths};
}

NumberRange table_range(const VolumeView& view, std::size_t field) {
  const VolumeImage& image = *image_of(view, field);
  if (image.lowest > image.highest) return {};
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const FieldTransfer& transfer : transfers_of(view)) {
    if (transfer.field != field) continue;
    if (transfer.regions) {
      const PlaceRange places = transfer.regions->extent();
      if (places.empty()) continue;
      const double room = kRoom / view.table_entries * (places.upper.x - places.lower.x);
      least = std::min(least, places.lower.x - room);
      most = std::max(most, places.upper.x + room);
    } else if (!transfer.colors.points().empty()) {
      least = std::min(least, transfer.colors.points().front().value);
      most = std::max(most, transfer.colors.points().back().value);
    }
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

double highest_row(const VolumeView& view, std::size_t field) {
  double highest = 0.0;
  for (const FieldTransfer& transfer : transfers_of(view)) {
    if (transfer.field != field || !transfer.regions) continue;
    const PlaceRange places = transfer.regions->extent();
    if (!places.empty()) highest = std::max(highest, places.upper.y);
  }
  return highest > 0.0 ? highest * (1.0 + kRoom / static_cast<double>(kGradientEntries)) : 1.0;
}

PlaceRange table_places(const VolumeView& view, std::size_t field) {
  const VolumeImage& image = *image_of(view, field);
  const NumberRange numbers = table_range(view, field);
  return {{image.offset + image.scale * numbers.lower, 0.0},
          {image.offset + image.scale * numbers.upper, highest_row(view, field)}};
}

std::vector<TransferBlock> transfer_blocks(const VolumeView& view, const std::vector<Index3>& bricks) {
  std::vector<TransferBlock> blocks;
  int tables = 0, regions = 0, z = 0;
  for (const FieldTransfer& transfer : transfers_of(view)) {
    const bool by_regions = transfer.regions.has_value();
    blocks.push_back({.field = static_cast<std::int32_t>(transfer.field),
                      .by_regions = by_regions ? 1 : 0,
                      .first_layer = by_regions ? regions++ : view.table_lengths * tables++,
                      .first_brick = z});
    z += bricks[transfer.field].z;
  }
  return blocks;
}

VolumeBlock make_volume_block(const VolumeView& view, const SceneFrame& frame,
                              const std::vector<Index3>& bricks) {
  PALPATE_CHECK(view.image != nullptr && bricks.size() >= field_count(view) &&
                field_count(view) <= kMostFields);
  VolumeBlock block;
  std::int32_t first_line = 0;
  for (std::size_t field = 0; field < field_count(view); ++field) {
    if (shows_field(view, field))
      block.fields[field] = make_field_block(view, field, frame, bricks[field], first_line);
  }
  const StepLengths steps = step_lengths(view);
  const double to_scene = power_of_two(-frame.exponent);
  block.layer_length = static_cast<float>(steps.longest * to_scene / (steps.layers - 1));
  block.layer_count = static_cast<float>(steps.layers);
  block.opaque = view.stop_where_opaque ? kOpaque : 2.0F;
  block.asks_tiles = asks_tiles(view) ? 1.0F : 0.0F;
  block.context_fade = static_cast<float>(view.context_fade);
  block.lens_count = static_cast<int>(view.lenses.size());
  block.cut_count = static_cast<int>(
      std::count_if(view.cuts.begin(), view.cuts.end(), [](const CuttingPlane& cut) { return cut.on; }));
  const std::vector<TransferBlock> transfers = transfer_blocks(view, bricks);
  PALPATE_CHECK(transfers.size() <= kMostTransfers);
  std::copy(transfers.begin(), transfers.end(), block.transfers.begin());
  return block;
}

FarRange far_range(const VolumeView& view, const SceneFrame& frame, const FrameBlock& picture) {
  const Vec3 eye(Vec3f(picture.eye)), back(Vec3f(picture.back));
  const bool perspective = picture.eye.w > 0.5F;
  double nearest = HUGE_VAL, farthest = -HUGE_VAL;
  for (const Vec3& corner : corners_in_scene(*view.image, frame)) {
    const double t = perspective ? glm::distance(corner, eye) : -glm::dot(corner - eye, back);
    nearest = std::min(nearest, t);
    farthest = std::max(farthest, t);
  }
  return {.first = static_cast<float>(nearest),
          .rate = static_cast<float>(1.0 / (farthest - nearest)),
          .doublings = static_cast<float>(std::log2(view.far_sampling))};
}

}  // namespace palpate
