#include "common/render/volume/volume_textures.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/render/volume/coarse_image.h"
#include "common/render/volume/preintegration.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/voxel_texture.h"

namespace palpate {
namespace {

void check_size(const VolumeImage& image, int largest) {
  const Index3 n = image.points;
  if (std::max({n.x, n.y, n.z}) <= largest) return;
  throw usage_error("a volume of " + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                    std::to_string(n.z) +
                    " voxels with colours does not fit the driver's textures; each side is 1 to " +
                    std::to_string(largest));
}

GlTexture upload_whole(const VolumeImage& image) {
  GlTexture texture = make_voxel_texture(image.points, image.type, "voxels");
  upload_voxels(texture, Index3(0), image.points, image.type, image.bytes.data());
  return texture;
}

GlTexture upload_colors(const VolumeImage& image) {
  const Index3 n = image.points;
  GlTexture texture = make_texture(GL_TEXTURE_3D, "colours of voxels");
  glTextureStorage3D(texture.name(), 1, GL_RGBA8, n.x, n.y, n.z);
  glTextureSubImage3D(texture.name(), 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_UNSIGNED_BYTE,
                      image.colors->data());
  set_voxel_sampling(texture);
  return texture;
}

bool fits_whole(const VolumeImage& image, std::uint64_t memory) {
  const Index3 n = image.points;
  return std::max({n.x, n.y, n.z}) <= largest_volume_texture() &&
         (memory == 0 || image.bytes.size() <= memory);
}

std::string megabytes(std::uint64_t bytes) { return std::to_string(bytes >> 20U) + " MB"; }

}  // namespace

bool VolumeTextures::TableKey::operator==(const TableKey& other) const {
  return transfers == other.transfers && range.lower == other.range.lower &&
         range.upper == other.range.upper && longest == other.longest && entries == other.entries &&
         lengths == other.lengths;
}

void VolumeTextures::update(const VolumeView& view, const BrickSight& sight, const VolumeTextures* other) {
  PALPATE_CHECK(view.image != nullptr);
  PALPATE_CHECK(view.table_entries >= 2 && view.table_lengths >= static_cast<int>(kLengthGroup));
  if (other != nullptr) tiles_.share_program(other->tiles_);
  VolumeView drawn = view;
  if (other != nullptr && other->image_ == view.image) {
    share_voxels(*other);
  } else {
    place_voxels(drawn, sight);
  }
  drawn.image = image_;
  update_colors(drawn);
  update_tables(drawn);
}

void VolumeTextures::bind(bool colors) const {
  if (bricks_) {
    bricks_->bind();
  } else {
    glBindTextureUnit(volume_shader::kVoxels, voxels_->name());
  }
  glBindTextureUnit(volume_shader::kTables, tables_.name());
  glBindTextureUnit(volume_shader::kEmptyBricks, empty_bricks_.name());
  if (colors) glBindTextureUnit(volume_shader::kColors, colors_.name());
}

void VolumeTextures::bind_voxels(std::uint32_t unit) const { glBindTextureUnit(unit, voxels_->name()); }

std::vector<std::string> VolumeTextures::shader_defines() const {
  if (!bricks_) return {};
  return {"BRICKED " + std::to_string(bricks_->layout().cells)};
}

void VolumeTextures::take_image(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges) {
  if (image_ == image) return;
  image_ = image;
  ranges_ = ranges;
  colors_ = GlTexture();
  key_ = {};
}

void VolumeTextures::share_voxels(const VolumeTextures& other) {
  take_image(other.image_, other.ranges_);
  voxels_ = other.voxels_;
  bricks_ = other.bricks_;
  placed_ = {};
  changes_ = other.changes_;
  cost_.voxel_bytes = 0;
}

BrickShare VolumeTextures::bricks_held() const noexcept { return bricks_ ? bricks_->share() : BrickShare{}; }

void VolumeTextures::place_voxels(const VolumeView& view, const BrickSight& sight) {
  PlaceKey wanted{.image = view.image, .storage = view.storage, .transfers = {}, .cuts = {}};
  const bool may_cut = !view.image->colors;
  const bool whole =
      !may_cut || (view.storage.brick_cells == 0 && fits_whole(*view.image, view.storage.memory));
  if (!whole) {
    // What bricks that are needed depend on.
    for (const ColorTransfer* transfer : transfers_of(view)) wanted.transfers.push_back(*transfer);
    wanted.step = step_lengths(view).longest;
    wanted.opacity_length = opacity_length_of(view);
    wanted.magnified = has_magnified_parts(view);
    wanted.blended = blends_values(view);
    if (shows_planes(view)) wanted.cuts = view.cuts;
  }
  if (wanted != placed_) {
    if (wanted.image != placed_.image) levels_.clear();
    for (Level& level : levels_) level.needed.clear();
    placed_ = {};
    sight_.reset();
    if (whole) {
      check_size(*view.image, largest_volume_texture());
      place_whole(view.image, brick_ranges(*view.image));
    }
  }
  if (!whole && !(sight_ == sight && lenses_ == view.lenses)) place_bricks(view, sight);
  placed_ = std::move(wanted);
}

void VolumeTextures::place_whole(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges) {
  if (image_ == image && voxels_) return;
  bricks_.reset();
  voxels_.reset();
  voxels_ = std::make_shared<const GlTexture>(upload_whole(*image));
  cost_.voxel_bytes = image->bytes.size();
  ++changes_;
  take_image(image, ranges);
}

// The finest level of which all that the picture looks up fits.
void VolumeTextures::place_bricks(VolumeView view, const BrickSight& sight) {
  const int largest = largest_volume_texture();
  const int cells = view.storage.brick_cells > 0 ? view.storage.brick_cells : kPoolBrickCells;
  const bool coarse = view.storage.upload > 0;
  lenses_ = view.lenses;
  for (std::size_t level = 0;; ++level) {
    if (level == levels_.size()) {
      auto image = level == 0 ? view.image : coarse_image(*levels_.back().image, 1);
      if (level > 0 && image->points == levels_.back().image->points) {
        throw usage_error("no " + megabytes(view.storage.memory) +
                          " of memory hold a volume, however coarse");
      }
      BrickRanges ranges = brick_ranges(*image);
      levels_.push_back({std::move(image), std::move(ranges), {}});
    }
    Level& at = levels_[level];
    view.image = at.image;
    if (level > 0 && fits_whole(*at.image, view.storage.memory)) {
      place_whole(at.image, at.ranges);
      sight_ = sight;
      return;
    }
    const BrickLayout layout = brick_layout(*at.image, cells);
    if (at.needed.empty()) at.needed = needed_bricks(view, at.ranges, layout);
    const std::vector<std::size_t> wanted = bricks_in_sight(view, at.needed, layout, sight);
    const auto count = static_cast<std::size_t>(std::count(at.needed.begin(), at.needed.end(), true));
    const std::size_t places = wanted.size() + (coarse ? coarse_places(count, layout) : 0);
    const std::uint64_t bytes = bricked_bytes(places, layout, at.image->type, largest);
    if (bytes == std::numeric_limits<std::uint64_t>::max() ||
        (view.storage.memory > 0 && bytes > view.storage.memory))
      continue;
    voxels_.reset();
    if (!bricks_ || image_ != at.image || bricks_->layout().cells != cells || bricks_->coarse() != coarse) {
      bricks_.reset();
      bricks_ = std::make_shared<VoxelBricks>(at.image, layout, at.ranges, coarse);
      ++changes_;
    }
    const std::uint64_t before = bricks_->uploads();
    bricks_->hold(at.needed, wanted, view.storage);
    changes_ += bricks_->uploads() != before ? 1 : 0;
    cost_.voxel_bytes = bricks_->bytes();
    take_image(at.image, at.ranges);
    sight_.reset();
    if (bricks_->share().complete()) sight_ = sight;
    return;
  }
}

void VolumeTextures::update_colors(const VolumeView& view) {
  if (colors_ || !has_colored_parts(view)) return;
  PALPATE_CHECK(image_->colors->size() == image_->point_count());
  colors_ = upload_colors(*image_);
  cost_.voxel_bytes += image_->colors->size() * sizeof(image_->colors->front());
}

void VolumeTextures::update_tables(const VolumeView& view) {
  const std::vector<const ColorTransfer*> transfers = transfers_of(view);
  TableKey wanted;
  for (const ColorTransfer* transfer : transfers) wanted.transfers.push_back(*transfer);
  wanted.range = table_range(view);
  wanted.longest = step_lengths(view).longest / opacity_length_of(view);
  wanted.entries = view.table_entries;
  wanted.lengths = view.table_lengths;
  if (wanted == key_) return;

  const Stopwatch clock;
  const auto entries = static_cast<std::size_t>(wanted.entries);
  const auto lengths = static_cast<std::size_t>(wanted.lengths);
  const int layers = wanted.lengths * static_cast<int>(transfers.size());
  tables_ = make_texture(GL_TEXTURE_2D_ARRAY, "preintegrated tables");
  glTextureStorage3D(tables_.name(), 1, GL_RGBA16, wanted.entries, wanted.entries, layers);
  set_sampling(tables_, GL_LINEAR, GL_CLAMP_TO_EDGE);
  const Index3 b = ranges_.bricks;
  empty_bricks_ = make_texture(GL_TEXTURE_3D, "empty bricks");
  glTextureStorage3D(empty_bricks_.name(), 1, GL_R8UI, b.x, b.y, b.z * static_cast<int>(transfers.size()));
  set_sampling(empty_bricks_, GL_NEAREST, GL_CLAMP_TO_EDGE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);

  table_.resize(4 * entries * entries * lengths);
  std::vector<std::uint8_t> maps;
  for (std::size_t i = 0; i < transfers.size(); ++i) {
    const std::vector<OpticalEntry> optical =
        optical_entries(*transfers[i], image_->offset + image_->scale * wanted.range.lower,
                        image_->offset + image_->scale * wanted.range.upper, entries, wanted.longest);
    preintegrate(optical, lengths, 0, table_);
    glTextureSubImage3D(tables_.name(), 0, 0, 0, static_cast<GLint>(i) * wanted.lengths, wanted.entries,
                        wanted.entries, wanted.lengths, GL_RGBA, GL_UNSIGNED_SHORT, table_.data());
    const std::vector<std::uint8_t> distances =
        empty_distances(ranges_, optical, wanted.range.lower, wanted.range.upper);
    glTextureSubImage3D(empty_bricks_.name(), 0, 0, 0, static_cast<GLint>(i) * b.z, b.x, b.y, b.z,
                        GL_RED_INTEGER, GL_UNSIGNED_BYTE, distances.data());
    maps.insert(maps.end(), distances.begin(), distances.end());
    if (i > 0) continue;
    const auto empty = std::count_if(distances.begin(), distances.end(), [](auto d) { return d > 0; });
    cost_.empty_share = static_cast<double>(empty) / static_cast<double>(distances.size());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  tiles_.set_bricks(shell_bricks(b, maps));
  cost_.table_bytes = table_.size() * sizeof(std::uint16_t) * transfers.size();
  cost_.brick_bytes = ranges_.ranges.size() * transfers.size();
  cost_.table_ms = 1e3 * clock.seconds();
  key_ = std::move(wanted);
}

}  // namespace palpate
