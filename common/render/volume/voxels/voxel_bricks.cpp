#include "common/render/volume/voxels/voxel_bricks.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/math/lattice.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/voxels/seen_bricks.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {
namespace {

using Range = BrickRanges::Range;

Index3 at_index(std::size_t index, const Index3& n) {
  const auto x = as_size(n.x), y = as_size(n.y);
  return {static_cast<int>(index % x), static_cast<int>(index / x % y), static_cast<int>(index / x / y)};
}

std::uint64_t pool_bytes(const Index3& bricks, const BrickLayout& layout, ScalarType type) {
  return count_of(bricks) * count_of(layout.points) * byte_size(type);
}

// Calls f(small, large) for each brick of `ranges` and the one of `layout` that it lies in.
template <typename F>
void for_each_part(const BrickRanges& ranges, const BrickLayout& layout, F f) {
  const int parts = layout.cells / kBrickCells;
  for (std::size_t i = 0; i < ranges.ranges.size(); ++i)
    f(i, index_in(layout.bricks, at_index(i, ranges.bricks) / parts));
}

// The range of each brick of `layout`.
std::vector<Range> joined_ranges(const BrickRanges& ranges, const BrickLayout& layout) {
  std::vector<Range> joined(count_of(layout.bricks));
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

// Calls f(read) with what reads the number of a point of the image: read(p).
template <typename F>
auto with_reader(const VolumeImage& image, F f) {
  if (image.sparse) {
    SparseReader reader(*image.sparse);
    return f([&](const Index3& p) { return static_cast<double>(reader.at(p)); });
  }
  return f([&](const Index3& p) { return image.number(index_in(image.points, p)); });
}

// Whether all points of a brick have the number, NaN being none.
bool is_even(const VolumeImage& image, std::size_t brick, const BrickLayout& layout, double number) {
  if (image.type != ScalarType::kFloat32 || image.all_finite) return true;  // its range says so
  const Index3 first = first_point(brick, layout), end = glm::min(first + layout.points, image.points);
  return with_reader(image, [&](auto read) {
    for (int z = first.z; z < end.z; ++z) {
      for (int y = first.y; y < end.y; ++y) {
        for (int x = first.x; x < end.x; ++x) {
          if (read(Index3(x, y, z)) != number) return false;
        }
      }
    }
    return true;
  });
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
  const PointsPlace at = place_of_points(image, first_point(brick, layout), layout.points, 1.5);
  return std::any_of(view.cuts.begin(), view.cuts.end(), [&](const CuttingPlane& cut) {
    const Vec3 reach = glm::abs(glm::transpose(at.half) * cut.kept.outward);
    return std::abs(glm::dot(cut.kept.outward, at.center) - cut.kept.offset) <= reach.x + reach.y + reach.z;
  });
}

// Points of a coarse brick, an axis.
Index3 coarse_points(const BrickLayout& layout) {
  return (layout.points - 1 + kBrickCells - 1) / kBrickCells + 1;
}

// Mean of the finite ones of the numbers about a point, as far as the next coarse points are halfway; every
// other one. Points beyond the volume are its last ones.
template <typename Read>
double mean_about(const VolumeImage& image, const Index3& point, const Read& read) {
  constexpr int kHalf = kBrickCells / 2, kStep = 2;
  const Index3 last = image.points - 1;
  const Index3 middle = glm::min(point, last);
  const Index3 from = glm::max(middle - kHalf, Index3(0)), to = glm::min(middle + kHalf, last);
  double sum = 0.0;
  int count = 0;
  // The first ones that are not below the middle. Octants of sparse numbers lie in few blocks each.
  const Index3 half = from + kStep * ((middle - from + kStep - 1) / kStep);
  for (unsigned octant = 0; octant < 8; ++octant) {
    Index3 start = from, end = to + 1;
    for (int a = 0; a < 3; ++a) ((octant >> static_cast<unsigned>(a) & 1U) != 0 ? start : end)[a] = half[a];
    for (int z = start.z; z < end.z; z += kStep) {
      for (int y = start.y; y < end.y; y += kStep) {
        for (int x = start.x; x < end.x; x += kStep) {
          const double number = read(Index3(x, y, z));
          if (!std::isfinite(number)) continue;
          sum += number;
          ++count;
        }
      }
    }
  }
  return count > 0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

void put_number(std::byte* to, ScalarType type, double number) {
  if (type == ScalarType::kUint8) {
    *to = static_cast<std::byte>(std::lround(number));
  } else if (type == ScalarType::kUint16) {
    const auto value = static_cast<std::uint16_t>(std::lround(number));
    std::memcpy(to, &value, sizeof(value));
  } else {
    const auto value = static_cast<float>(number);
    std::memcpy(to, &value, sizeof(value));
  }
}

}  // namespace

PointsPlace place_of_points(const VolumeImage& image, const Index3& first, const Index3& points,
                            double beyond) {
  const Vec3 from = image.mean_of_grid(Vec3(first) - beyond),
             to = image.mean_of_grid(Vec3(first + points) - 1.0 + beyond);
  PointsPlace place{image.origin + image.axes * (0.5 * (from + to)), image.axes};
  for (int a = 0; a < 3; ++a) place.half[a] *= 0.5 * (to[a] - from[a]);
  return place;
}

BrickLayout brick_layout(const VolumeImage& image, int cells) {
  PALPATE_CHECK(cells > 0 && cells % kBrickCells == 0);
  const Index3 all = glm::max(image.points - 1, Index3(1));
  return {.cells = cells, .bricks = (all + cells - 1) / cells, .points = glm::min(all, Index3(cells)) + 1};
}

std::vector<bool> needed_bricks(const VolumeView& view, const BrickRanges& ranges,
                                const BrickLayout& layout) {
  std::vector<bool> needed(count_of(layout.bricks), false);
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

std::size_t coarse_places(std::size_t bricks, const BrickLayout& layout) {
  const std::size_t each = count_of(layout.points / coarse_points(layout));
  return (bricks + each - 1) / each;
}

Index3 pool_size(std::size_t count, const BrickLayout& layout, int largest) {
  PALPATE_CHECK(count > 0);
  const Index3 most = Index3(largest) / layout.points;
  if (count_of(glm::max(most, Index3(0))) < count) return Index3(0);
  const auto n = static_cast<double>(count);
  // A row that is as long as a cube of them, or what the sides of textures ask for.
  const double x = std::clamp(std::ceil(std::cbrt(n)), std::ceil(n / (static_cast<double>(most.y) * most.z)),
                              double(most.x));
  const double y = std::clamp(std::ceil(std::sqrt(n / x)), std::ceil(n / (x * most.z)), double(most.y));
  return {static_cast<int>(x), static_cast<int>(y), static_cast<int>(std::ceil(n / (x * y)))};
}

std::uint64_t brick_index_bytes(const BrickLayout& layout) {
  return count_of(layout.bricks) * sizeof(glm::vec4);
}

std::uint64_t bricked_bytes(std::size_t count, const BrickLayout& layout, ScalarType type, int largest) {
  const Index3 pool = pool_size(std::max<std::size_t>(count, 1), layout, largest);
  if (pool.x == 0) return std::numeric_limits<std::uint64_t>::max();
  return brick_index_bytes(layout) + pool_bytes(pool, layout, type);
}

VoxelBricks::VoxelBricks(std::shared_ptr<const VolumeImage> image, const BrickLayout& layout,
                         const BrickRanges& ranges, bool coarse, const FinerBricks& finer, BrickPool pool)
    : image_(std::move(image)),
      layout_(layout),
      coarse_(coarse),
      coarse_points_(coarse_points(layout)),
      coarse_rows_(layout.points / coarse_points_),
      finer_(finer),
      pool_(std::move(pool)) {
  const double unit = largest_number(image_->type);
  for (const Range& range : joined_ranges(ranges, layout)) {
    // Infinite numbers show nothing, as NaN does; in the index they would mean the pool.
    const bool none = range.highest < range.lowest || !std::isfinite(range.lowest);
    stand_ins_.push_back(none ? std::numeric_limits<float>::quiet_NaN()
                              : static_cast<float>(static_cast<double>(range.lowest) / unit));
  }
  slots_.assign(stand_ins_.size(), -1);
  coarse_numbers_.assign(stand_ins_.size(), -1);
  looked_up_.assign(stand_ins_.size(), 0);
  share_.all = slots_.size();
  index_ = make_texture(GL_TEXTURE_3D, "index of bricks");
  const Index3 n = layout.bricks;
  glTextureStorage3D(index_.name(), 1, GL_RGBA32F, n.x, n.y, n.z);
  set_sampling(index_, GL_NEAREST, GL_CLAMP_TO_EDGE);
}

void VoxelBricks::find_pool(std::size_t needed, std::size_t wanted, std::uint64_t memory) {
  const int largest = largest_volume_texture();
  const auto fits = [&](std::size_t places) {
    const std::uint64_t bytes = bricked_bytes(places, layout_, image_->type, largest);
    if (bytes == std::numeric_limits<std::uint64_t>::max()) return false;
    const std::uint64_t index = std::max(brick_index_bytes(layout_), finer_.index_bytes);
    return memory == 0 || bytes - brick_index_bytes(layout_) + index <= memory;
  };
  const auto coarse_for = [&](std::size_t bricks) { return coarse_ ? coarse_places(bricks, layout_) : 0; };
  // Some room, for functions that are dragged.
  const std::size_t roomy = std::min(needed + needed / 4, slots_.size());
  coarse_room_ = fits(roomy + coarse_for(roomy)) ? roomy : needed;
  const std::size_t coarse = coarse_for(coarse_room_);
  // As many as the memory has room for: what was looked up before may be again.
  std::size_t fine = std::max<std::size_t>(wanted, 1), too_many = std::max(coarse_room_, finer_.needed) + 1;
  while (fine + 1 < too_many) {
    const std::size_t middle = fine + (too_many - fine) / 2;
    (fits(middle + coarse) ? fine : too_many) = middle;
  }
  const Index3 size = pool_size(fine + coarse, layout_, largest);
  PALPATE_CHECK(size.x > 0);
  const std::uint64_t pool = pool_bytes(size, layout_, image_->type);
  PALPATE_CHECK(memory == 0 || brick_index_bytes(layout_) + pool <= memory);
  const bool does =
      pool_.texture && pool_.points == layout_.points && pool_.type == image_->type &&
      count_of(pool_.bricks) >= count_of(size) &&
      (memory == 0 || brick_index_bytes(layout_) + pool_bytes(pool_.bricks, layout_, image_->type) <= memory);
  if (!does) {
    pool_ = {};  // before there is another one
    pool_ = {.texture = make_voxel_texture(size * layout_.points, image_->type, "voxels in bricks"),
             .bricks = size,
             .points = layout_.points,
             .type = image_->type,
             .places = {}};
  }
  placed_ = true;
  bytes_ = brick_index_bytes(layout_) + pool_bytes(pool_.bricks, layout_, image_->type);
  std::fill(coarse_numbers_.begin(), coarse_numbers_.end(), -1);
  coarse_held_ = 0;
  first_coarse_ = count_of(pool_.bricks) - coarse;
  take_places();
}

// Of what stands in the pool its own bricks stay; the places of others are free, those last that were looked up last.
void VoxelBricks::take_places() {
  const auto own = [&](std::size_t place) { return pool_.places[place].image.lock() == image_; };
  const auto held = [&] {
    return static_cast<std::uint64_t>(
        std::count_if(slots_.begin(), slots_.end(), [](int slot) { return slot >= 0; }));
  };
  const std::uint64_t before = held();
  std::fill(slots_.begin(), slots_.end(), -1);
  pool_.places.resize(count_of(pool_.bricks));
  for (std::size_t place = first_coarse_; place < pool_.places.size(); ++place) pool_.places[place] = {};
  free_.clear();
  for (std::size_t place = 0; place < first_coarse_; ++place) {
    if (!own(place)) {
      free_.push_back(static_cast<int>(place));
      continue;
    }
    const BrickPool::Place& at = pool_.places[place];
    slots_[at.brick] = static_cast<int>(place);
    looked_up_[at.brick] = at.looked_up;
  }
  std::stable_sort(free_.begin(), free_.end(), [&](int a, int b) {
    return pool_.places[as_size(a)].looked_up > pool_.places[as_size(b)].looked_up;
  });
  const std::uint64_t now = held();
  (now > before ? kept_ : share_.left) += now > before ? now - before : before - now;
}

BrickPool VoxelBricks::give_pool() && {
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i] >= 0) pool_.places[as_size(slots_[i])].looked_up = looked_up_[i];
  }
  return std::move(pool_);
}

Index3 VoxelBricks::place_of(std::size_t slot) const { return layout_.points * at_index(slot, pool_.bricks); }

Index3 VoxelBricks::coarse_place_of(std::size_t brick) const {
  const auto number = as_size(coarse_numbers_[brick]);
  const std::size_t each = count_of(coarse_rows_);
  return place_of(first_coarse_ + number / each) + coarse_points_ * at_index(number % each, coarse_rows_);
}

void VoxelBricks::upload(std::size_t brick, std::size_t slot) {
  const Index3 first = first_point(brick, layout_), last = image_->points - 1, size = layout_.points;
  const std::size_t bytes = byte_size(image_->type);
  const Index3 there = glm::min(size, last + 1 - first);
  scratch_.resize(count_of(there) * bytes);
  image_->copy({first, first + there}, scratch_.data());
  if (there != size) {
    // Beyond the volume its last points, again.
    std::vector<std::byte> whole(count_of(size) * bytes);
    std::byte* to = whole.data();
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x, to += bytes) {
          const std::size_t from = index_in(there, glm::min(Index3(x, y, z), there - 1));
          std::memcpy(to, scratch_.data() + from * bytes, bytes);
        }
      }
    }
    scratch_.swap(whole);
  }
  upload_voxels(pool_.texture, place_of(slot), size, image_->type, scratch_.data());
  ++share_.entered;
}

// Of those that have no coarse one, the first ones get theirs: as many as a picture has time for.
void VoxelBricks::hold_coarse(std::vector<std::size_t> bricks) {
  constexpr std::size_t kAPicture = 512;  // some 20 ms of a core
  std::erase_if(bricks, [&](std::size_t i) { return coarse_numbers_[i] >= 0; });
  bricks.resize(std::min({bricks.size(), kAPicture, coarse_room_}));
  if (coarse_held_ + bricks.size() > coarse_room_) {
    std::fill(coarse_numbers_.begin(), coarse_numbers_.end(), -1);
    coarse_held_ = 0;
  }
  const std::size_t bytes = byte_size(image_->type), each = count_of(coarse_points_) * bytes;
  scratch_.resize(bricks.size() * each);
  parallel_for(bricks.size(), 0, [&](std::size_t begin, std::size_t end) {
    with_reader(*image_, [&](auto read) {
      for (std::size_t k = begin; k < end; ++k) {
        std::byte* to = scratch_.data() + k * each;
        const Index3 first = first_point(bricks[k], layout_);
        for (int z = 0; z < coarse_points_.z; ++z) {
          for (int y = 0; y < coarse_points_.y; ++y) {
            for (int x = 0; x < coarse_points_.x; ++x, to += bytes)
              put_number(to, image_->type, mean_about(*image_, first + kBrickCells * Index3(x, y, z), read));
          }
        }
      }
    });
  });
  for (std::size_t k = 0; k < bricks.size(); ++k) {
    coarse_numbers_[bricks[k]] = static_cast<int>(coarse_held_++);
    upload_voxels(pool_.texture, coarse_place_of(bricks[k]), coarse_points_, image_->type,
                  scratch_.data() + k * each);
  }
}

// Empties as many places as are asked for, those that were looked up the longest ago first, and none of the
// picture's own.
void VoxelBricks::find_room(std::size_t places) {
  if (free_.size() >= places) return;
  std::vector<std::size_t> leaving;
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (slots_[i] >= 0 && looked_up_[i] < pool_.pictures) leaving.push_back(i);
  }
  std::sort(leaving.begin(), leaving.end(), [&](std::size_t a, std::size_t b) {
    return looked_up_[a] != looked_up_[b] ? looked_up_[a] < looked_up_[b] : a < b;
  });
  for (const std::size_t i : leaving) {
    if (free_.size() >= places) return;
    free_.push_back(std::exchange(slots_[i], -1));
    ++share_.left;
  }
}

void VoxelBricks::hold(const std::vector<bool>& needed, const std::vector<std::size_t>& wanted,
                       const VoxelStorage& storage) {
  PALPATE_CHECK(needed.size() == slots_.size());
  const auto count = as_size(std::count(needed.begin(), needed.end(), true));
  if (!placed_ || wanted.size() > first_coarse_ || count > coarse_room_ ||
      (storage.memory > 0 && bytes_ > storage.memory))
    find_pool(count, wanted.size(), storage.memory);
  ++pool_.pictures;
  for (const std::size_t i : wanted) looked_up_[i] = pool_.pictures;
  share_.held = 0;
  std::vector<std::size_t> lacking;
  for (const std::size_t i : wanted) {
    if (slots_[i] >= 0) {
      ++share_.held;
    } else {
      lacking.push_back(i);
    }
  }
  if (coarse_ && storage.upload > 0) {
    const std::uint64_t each = count_of(layout_.points) * byte_size(image_->type);
    const std::size_t now = std::min(lacking.size(), std::max<std::size_t>(1, storage.upload / each));
    hold_coarse({lacking.begin() + static_cast<std::ptrdiff_t>(now), lacking.end()});
    lacking.resize(now);
  }
  find_room(lacking.size());
  for (const std::size_t i : lacking) {
    slots_[i] = free_.back();
    free_.pop_back();
    pool_.places[as_size(slots_[i])] = {.image = image_, .brick = i, .looked_up = pool_.pictures};
    upload(i, as_size(slots_[i]));
  }
  share_.held += lacking.size();
  share_.wanted = wanted.size();
  share_.bytes = bytes_;
  write_index(needed);
}

void VoxelBricks::write_index(const std::vector<bool>& needed) {
  constexpr float kPool = std::numeric_limits<float>::infinity();
  std::vector<glm::vec4> index(slots_.size());
  std::size_t held = 0;
  for (std::size_t i = 0; i < index.size(); ++i) {
    if (slots_[i] >= 0) {
      index[i] = glm::vec4(Vec3f(place_of(as_size(slots_[i]))), kPool);
      ++held;
    } else if (needed[i] && coarse_numbers_[i] >= 0) {
      index[i] = glm::vec4(Vec3f(coarse_place_of(i)), -kPool);
    } else {
      index[i] = glm::vec4(0.0F, 0.0F, 0.0F, stand_ins_[i]);
    }
  }
  const Index3 n = layout_.bricks;
  glTextureSubImage3D(index_.name(), 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_FLOAT, index.data());
  label_object(GpuObject::Kind::kTexture, pool_.texture.name(),
               "voxels in bricks, " + std::to_string(held) + " of " + std::to_string(slots_.size()));
}

void VoxelBricks::bind() const {
  glBindTextureUnit(volume_shader::kVoxels, pool_.texture.name());
  glBindTextureUnit(volume_shader::kBrickIndex, index_.name());
}

}  // namespace palpate
