#include "common/render/volume/volume_textures.h"

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/volume/preintegration.h"
#include "common/render/volume/volume_bindings.h"

namespace palpate {
namespace {

GlTexture make_texture(GLenum target, std::string_view what) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
  label_object(GpuObject::Kind::kTexture, name, what);
  return GlTexture(name);
}

void set_sampling(const GlTexture& texture, GLint filter, GLint border = GL_CLAMP_TO_EDGE) {
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, filter);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(texture.name(), wrap, border);
  }
}

void set_voxel_sampling(const GlTexture& texture) {
  // One voxel beyond the border, as far as gradients reach, mirroring is the same as clamping. It keeps a
  // software rasteriser (llvmpipe) from interpolating 8-bit voxels in 8 bits, which is up to 6/255 off.
  set_sampling(texture, GL_LINEAR, GL_MIRROR_CLAMP_TO_EDGE);
}

struct VoxelFormat {
  GLenum internal, type;
};

VoxelFormat format_of(ScalarType type) {
  switch (type) {
    case ScalarType::kUint8:
      return {GL_R8, GL_UNSIGNED_BYTE};
    case ScalarType::kUint16:
      return {GL_R16, GL_UNSIGNED_SHORT};
    default:
      return {GL_R32F, GL_FLOAT};
  }
}

GlTexture upload_voxels(const VolumeImage& image) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  const Index3 n = image.points;
  if (std::max({n.x, n.y, n.z}) > largest) {
    throw usage_error("a volume of " + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                      std::to_string(n.z) + " voxels does not fit the driver's textures; each side is 1 to " +
                      std::to_string(largest));
  }
  GlTexture texture = make_texture(GL_TEXTURE_3D, "voxels");
  const VoxelFormat format = format_of(image.type);
  glTextureStorage3D(texture.name(), 1, format.internal, n.x, n.y, n.z);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage3D(texture.name(), 0, 0, 0, 0, n.x, n.y, n.z, GL_RED, format.type, image.bytes.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  set_voxel_sampling(texture);
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

// The transfer functions of a view: that of the context, then those of lenses that have one.
std::vector<const ColorTransfer*> transfers_of(const VolumeView& view) {
  std::vector<const ColorTransfer*> transfers{&view.transfer};
  for (const Lens& lens : view.lenses) {
    if (lens.transfer) transfers.push_back(&*lens.transfer);
  }
  return transfers;
}

}  // namespace

bool VolumeTextures::TableKey::operator==(const TableKey& other) const {
  return transfers == other.transfers && range.lower == other.range.lower &&
         range.upper == other.range.upper && longest == other.longest && entries == other.entries &&
         lengths == other.lengths;
}

void VolumeTextures::update(const VolumeView& view, const VolumeTextures* other) {
  PALPATE_CHECK(view.image != nullptr);
  PALPATE_CHECK(view.table_entries >= 2 && view.table_lengths >= static_cast<int>(kLengthGroup));
  if (other != nullptr) tiles_.share_program(other->tiles_);
  update_image(view, other);
  update_colors(view);
  update_tables(view);
}

void VolumeTextures::bind(bool colors) const {
  glBindTextureUnit(volume_shader::kVoxels, voxels_->name());
  glBindTextureUnit(volume_shader::kTables, tables_.name());
  glBindTextureUnit(volume_shader::kEmptyBricks, empty_bricks_.name());
  if (colors) glBindTextureUnit(volume_shader::kColors, colors_.name());
}

void VolumeTextures::bind_voxels(std::uint32_t unit) const { glBindTextureUnit(unit, voxels_->name()); }

void VolumeTextures::update_image(const VolumeView& view, const VolumeTextures* other) {
  if (image_ == view.image) return;
  const bool shared = other != nullptr && other->image_ == view.image;
  voxels_ = shared ? other->voxels_ : std::make_shared<const GlTexture>(upload_voxels(*view.image));
  ranges_ = shared ? other->ranges_ : brick_ranges(*view.image);
  image_ = view.image;
  colors_ = GlTexture();
  key_ = {};
  cost_.voxel_bytes = shared ? 0 : image_->bytes.size();
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
  set_sampling(tables_, GL_LINEAR);
  const Index3 b = ranges_.bricks;
  empty_bricks_ = make_texture(GL_TEXTURE_3D, "empty bricks");
  glTextureStorage3D(empty_bricks_.name(), 1, GL_R8UI, b.x, b.y, b.z * static_cast<int>(transfers.size()));
  set_sampling(empty_bricks_, GL_NEAREST);
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
