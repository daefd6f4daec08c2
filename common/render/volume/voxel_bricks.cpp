#include "common/render/volume/voxel_bricks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/volume/preintegration.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/voxel_texture.h"

namespace palpate {
namespace {

using Range = BrickRanges::Range;

std::size_t product(const Index3& n) {
  return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z);
}

std::size_t index_of(const Index3& at, const Index3& n) {
  return static_cast<std::size_t>(at.x) +
         static_cast<std::size_t>(n.x) * (static_cast<std::size_t>(at.y) +
                                          static_cast<std::size_t>(n.y) * static_cast<std::size_t>(at.z));
}

Index3 at_index(std::size_t index, const Index3& n) {
  const auto x = static_cast<std::size_t>(n.x), y = static_cast<std::size_t>(n.y);
  return {static_cast<int>(index % x), static_cast<int>(index / x % y), static_cast<int>(index / x / y)};
}

std::uint64_t pool_bytes(const Index3& bricks, const BrickLayout& layout, ScalarType type) {
  return product(bricks) * product(layout.points) * byte_size(type);
}

std::uint64_t index_bytes(const BrickLayout& layout) { return product(layout.bricks) * sizeof(glm::vec4); }

// Calls f(small, large) for each brick of `ranges` and the one of `layout` that it lies in.
template <typename F>
void for_each_part(const BrickRanges& ranges, const BrickLayout& layout, F f) {
  const int parts = layout.cells / kBrickCells;
  for (std::size_t i = 0; i < ranges.ranges.size(); ++i)
    f(i, index_of(at_index(i, ranges.bricks) / parts, layout.bricks));
}

// The range of each brick of `layout`.
std::vector<Range> joined_ranges(const BrickRanges& ranges, const BrickLayout& layout) {
  std::vector<Range> joined(product(layout.bricks));
  for_each_part(ranges, layout, [&](std::size_t part, std::size_t brick) {
    const Range& range = ranges.ranges[part];
    Range& all = joined[brick];
    if (range.highest < range.lowest) return;
    const bool first = all.highest < all.lowest;
    all.lowest = first ? range.lowest : std::min(all.lowest, range.lowest);
    all.highest = first ? range.highest : std::max(all.highest, range.highest);
  });
  return joined;
}

Index3 first_point(std::size_t brick, const BrickLayout& layout) {
  return layout.cells * at_index(brick, layout.bricks);
}

// Whether all points of a brick have the number, NaN being none.
bool is_even(const VolumeImage& image, std::size_t brick, const BrickLayout& layout, double number) {
  if (image.type != ScalarType::kFloat32) return true;  // its range says so
  const Index3 first = first_point(brick, layout), end = glm::min(first + layout.points, image.points);
  for (int z = first.z; z < end.z; ++z) {
    for (int y = first.y; y < end.y; ++y) {
      for (int x = first.x; x < end.x; ++x) {
        if (image.number(index_of({x, y, z}, image.points)) != number) return false;
      }
    }
  }
  return true;
}

// For each brick of `ranges` its distance to the nearest one in which some transfer function of the view
// shows something.
std::vector<std::uint8_t> distances_to_seen(const VolumeView& view, const BrickRanges& ranges) {
  const VolumeImage& image = *view.image;
  const NumberRange numbers = table_range(view);
  std::vector<std::uint8_t> nearest(ranges.ranges.size(), std::numeric_limits<std::uint8_t>::max());
  for (const ColorTransfer* transfer : transfers_of(view)) {
    const std::vector<OpticalEntry> entries = optical_entries(
        *transfer, image.offset + image.scale * numbers.lower, image.offset + image.scale * numbers.upper,
        static_cast<std::size_t>(view.table_entries), step_lengths(view).longest / opacity_length_of(view));
    const std::vector<std::uint8_t> distances =
        empty_distances(ranges, entries, numbers.lower, numbers.upper);
    for (std::size_t i = 0; i < nearest.size(); ++i) nearest[i] = std::min(nearest[i], distances[i]);
  }
  return nearest;
}

// How many bricks of BrickRanges beyond those in which something is seen values are read that count: as far
// as a sample and the differences about it reach.
int bricks_reached(const VolumeView& view) {
  double shortest = HUGE_VAL;
  for (int a = 0; a < 3; ++a) shortest = std::min(shortest, glm::length(view.image->axes[a]));
  const double step = shortest > 0.0 ? step_lengths(view).longest / shortest : kStepRatio;
  return static_cast<int>(std::ceil((std::min(step, kStepRatio) + 1.0) / kBrickCells));
}

// Whether some plane whose values are drawn meets the brick.
bool meets_planes(const VolumeView& view, std::size_t brick, const BrickLayout& layout) {
  // What is enlarged is seen elsewhere.
  if (has_magnified_parts(view)) return true;
  const VolumeImage& image = *view.image;
  const Vec3 half = 0.5 * Vec3(layout.points) + 1.0;
  const Vec3 middle = image.origin + image.axes * (Vec3(first_point(brick, layout)) + half);
  return std::any_of(view.cuts.begin(), view.cuts.end(), [&](const CuttingPlane& cut) {
    const Vec3 along = glm::transpose(image.axes) * cut.kept.outward;
    return std::abs(glm::dot(cut.kept.outward, middle) - cut.kept.offset) <= glm::dot(glm::abs(along), half);
  });
}

}  // namespace

BrickLayout brick_layout(const VolumeImage& image, int cells) {
  PALPATE_CHECK(cells > 0 && cells % kBrickCells == 0);
  const Index3 all = glm::max(image.points - 1, Index3(1));
  return {.cells = cells, .bricks = (all + cells - 1) / cells, .points = glm::min(all, Index3(cells)) + 1};
}

std::vector<bool> needed_bricks(const VolumeView& view, const BrickRanges& ranges,
                                const BrickLayout& layout) {
  std::vector<bool> needed(product(layout.bricks), false);
  const std::vector<std::uint8_t> distances = distances_to_seen(view, ranges);
  const int reach = bricks_reached(view);
  for_each_part(ranges, layout, [&](std::size_t part, std::size_t brick) {
    if (distances[part] <= reach) needed[brick] = true;
  });
  // Blended with coarser values, those that show nothing may show something.
  if (blends_values(view)) needed.assign(needed.size(), true);
  const bool planes = shows_planes(view);
  const std::vector<Range> joined = joined_ranges(ranges, layout);
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (planes && !needed[i]) needed[i] = meets_planes(view, i, layout);
    const double number = joined[i].lowest;
    if (needed[i] && joined[i].lowest == joined[i].highest && is_even(*view.image, i, layout, number))
      needed[i] = false;
  }
  return needed;
}

Index3 pool_size(std::size_t count, const BrickLayout& layout, int largest) {
  PALPATE_CHECK(count > 0);
  const Index3 most = Index3(largest) / layout.points;
  if (product(glm::max(most, Index3(0))) < count) return Index3(0);
  const auto n = static_cast<double>(count);
  // A row that is as long as a cube of them, or what the sides of textures ask for.
  const double x = std::clamp(std::ceil(std::cbrt(n)), std::ceil(n / (static_cast<double>(most.y) * most.z)),
                              double(most.x));
  const double y = std::clamp(std::ceil(std::sqrt(n / x)), std::ceil(n / (x * most.z)), double(most.y));
  return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(std::ceil(n / (x * y)))};
}

std::uint64_t bricked_bytes(std::size_t count, const BrickLayout& layout, ScalarType type, int largest) {
  const Index3 pool = pool_size(std::max<std::size_t>(count, 1), layout, largest);
  if (pool.x == 0) return std::numeric_limits<std::uint64_t>::max();
  return index_bytes(layout) + pool_bytes(pool, layout, type);
}

VoxelBricks::VoxelBricks(std::shared_ptr<const VolumeImage> image, const BrickLayout& layout,
                         const BrickRanges& ranges)
    : image_(std::move(image)), layout_(layout) {
  const double unit = largest_number(image_->type);
  for (const Range& range : joined_ranges(ranges, layout)) {
    // Infinite numbers show nothing, as NaN does; in the index they would mean the pool.
    const bool none = range.highest < range.lowest || !std::isfinite(range.lowest);
    stand_ins_.push_back(none ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(static_cast<double>(range.lowest) / unit));
  }
  slots_.assign(stand_ins_.size(), -1);
  index_ = make_texture(GL_TEXTURE_3D, "index of bricks");
  const Index3 n = layout.bricks;
  glTextureStorage3D(index_.name(), 1, GL_RGBA32F, n.x, n.y, n.z);
  set_sampling(index_, GL_NEAREST, GL_CLAMP_TO_EDGE);
}

void VoxelBricks::make_pool(std::size_t count, std::uint64_t memory) {
  const int largest = largest_volume_texture();
  const auto size_for = [&](std::size_t bricks) {
    return bricked_bytes(bricks, layout_, image_->type, largest);
  };
  // Some room, for functions that are dragged.
  const std::size_t roomy = std::min(count + count / 4, slots_.size());
  const std::uint64_t wanted = size_for(roomy);
  const bool fits = wanted < std::numeric_limits<std::uint64_t>::max() && (memory == 0 || wanted <= memory);
  pool_bricks_ = pool_size(fits ? roomy : count, layout_, largest);
  PALPATE_CHECK(pool_bricks_.x > 0);
  bytes_ = index_bytes(layout_) + pool_bytes(pool_bricks_, layout_, image_->type);
  PALPATE_CHECK(memory == 0 || bytes_ <= memory);
  pool_.reset();
  pool_ = make_voxel_texture(pool_bricks_ * layout_.points, image_->type, "voxels in bricks");
  std::fill(slots_.begin(), slots_.end(), -1);
  free_.resize(product(pool_bricks_));
  for (std::size_t i = 0; i < free_.size(); ++i) free_[i] = static_cast<int>(free_.size() - 1 - i);
  held_ = 0;
}

Index3 VoxelBricks::place_of(std::size_t slot) const { return layout_.points * at_index(slot, pool_bricks_); }

void VoxelBricks::upload(std::size_t brick, std::size_t slot) {
  const Index3 first = first_point(brick, layout_), last = image_->points - 1, size = layout_.points;
  const std::size_t bytes = byte_size(image_->type);
  scratch_.resize(product(size) * bytes);
  std::byte* to = scratch_.data();
  // Beyond the volume its last points, again.
  const Index3 there = glm::min(size, last + 1 - first);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      const Index3 start(first.x, std::min(first.y + y, last.y), std::min(first.z + z, last.z));
      const std::byte* from = image_->bytes.data() + index_of(start, image_->points) * bytes;
      const auto row = static_cast<std::size_t>(there.x);
      std::memcpy(to, from, row * bytes);
      for (auto x = row; x < static_cast<std::size_t>(size.x); ++x)
        std::memcpy(to + x * bytes, from + (row - 1) * bytes, bytes);
      to += static_cast<std::size_t>(size.x) * bytes;
    }
  }
  upload_voxels(pool_, place_of(slot), size, image_->type, scratch_.data());
  ++uploads_;
}

void VoxelBricks::hold(const std::vector<bool>& needed, std::uint64_t memory) {
  PALPATE_CHECK(needed.size() == slots_.size());
  const auto count = static_cast<std::size_t>(std::count(needed.begin(), needed.end(), true));
  const auto places = pool_ ? product(pool_bricks_) : 0;
  if (!pool_ || count > places || (memory > 0 && bytes_ > memory))
    make_pool(std::max<std::size_t>(count, 1), memory);
  std::size_t leaving = 0;
  for (std::size_t i = 0; i < needed.size(); ++i) {
    if (needed[i] && slots_[i] < 0) {
      // Those that are not needed stay until their place is.
      while (free_.empty()) {
        if (slots_[leaving] >= 0 && !needed[leaving]) {
          free_.push_back(std::exchange(slots_[leaving], -1));
          --held_;
        }
        ++leaving;
      }
      slots_[i] = free_.back();
      free_.pop_back();
      ++held_;
      upload(i, static_cast<std::size_t>(slots_[i]));
    }
  }
  write_index();
}

void VoxelBricks::write_index() {
  std::vector<glm::vec4> index(slots_.size());
  for (std::size_t i = 0; i < index.size(); ++i) {
    index[i] = slots_[i] < 0 ? glm::vec4(0.0F, 0.0F, 0.0F, stand_ins_[i])
                             : glm::vec4(Vec3f(place_of(static_cast<std::size_t>(slots_[i]))),
                                         std::numeric_limits<float>::infinity());
  }
  const Index3 n = layout_.bricks;
  glTextureSubImage3D(index_.name(), 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_FLOAT, index.data());
  label_object(GpuObject::Kind::kTexture, pool_.name(),
               "voxels in bricks, " + std::to_string(held_) + " of " + std::to_string(slots_.size()));
}

void VoxelBricks::bind() const {
  glBindTextureUnit(volume_shader::kVoxels, pool_.name());
  glBindTextureUnit(volume_shader::kBrickIndex, index_.name());
}

}  // namespace palpate
