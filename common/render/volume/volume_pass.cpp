#include "common/render/volume/volume_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/render/gl/object.h"
#include "common/render/gl/program.h"
#include "common/render/volume/brick_map.h"
#include "common/render/volume/preintegration.h"
#include "common/render/volume/slab_cache.h"
#include "common/render/volume/tile_pass.h"
#include "common/render/volume/volume_block.h"

namespace palpate {
namespace {

// Bindings and locations of shaders/volume/.
enum Unit : GLuint {
  kVoxels = 0,
  kTables = 1,
  kEmptyBricks = 2,
  kOpaqueDepth = 3,
  kTiles = 4,
  kColors = 5,
  kKeptPicture = 6,
  kKeptDepth = 7
};
enum Block : GLuint { kVolumeBlock = 1, kLensBlock = 2 };
constexpr GLint kHasOpaqueDepth = 0, kSlabNormal = 1, kSlabBorders = 2;

enum class Variant : std::uint8_t { kPlain, kShaded, kLenses, kColored, kMagnified, kMagnifiedColored };
constexpr std::array<const char*, 6> kFragments{"volume/volume.frag",    "volume/shaded.frag",
                                                "volume/lenses.frag",    "volume/colored.frag",
                                                "volume/magnified.frag", "volume/magnified_colored.frag"};

/// As kFragments, for slabs; colours of voxels are drawn in one go.
constexpr std::array<const char*, 6> kSlabFragments{"volume/slab_volume.frag",    "volume/slab_shaded.frag",
                                                    "volume/slab_lenses.frag",    nullptr,
                                                    "volume/slab_magnified.frag", nullptr};

/// Whether the shader is told of lenses, be there none.
bool knows_lenses(Variant variant) { return variant != Variant::kPlain && variant != Variant::kShaded; }

Variant variant_of(const VolumeView& view) {
  if (has_magnified_parts(view))
    return has_colored_parts(view) ? Variant::kMagnifiedColored : Variant::kMagnified;
  if (has_colored_parts(view)) return Variant::kColored;
  if (!view.lenses.empty()) return Variant::kLenses;
  return view.shading ? Variant::kShaded : Variant::kPlain;
}

GlTexture make_texture(GLenum target) {
  GLuint name = 0;
  glCreateTextures(target, 1, &name);
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
  GlTexture texture = make_texture(GL_TEXTURE_3D);
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
  GlTexture texture = make_texture(GL_TEXTURE_3D);
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

// All that the tables depend on.
struct TableKey {
  std::vector<ColorTransfer> transfers;
  NumberRange range;
  double longest = 0.0;  // in units of the opacity length
  int entries = 0, lengths = 0;

  bool operator==(const TableKey& other) const {
    return transfers == other.transfers && range.lower == other.range.lower &&
           range.upper == other.range.upper && longest == other.longest && entries == other.entries &&
           lengths == other.lengths;
  }
};

template <typename BlockType>
GlBuffer make_block_buffer(const BlockType& block) {
  return make_buffer(std::span<const BlockType>(&block, 1));
}

}  // namespace

struct VolumePass::State {
  std::array<GlProgram, kFragments.size()> programs, slab_programs;
  GlVertexArray no_vertices = make_vertex_array();
  GlTexture voxels, colors, tables, empty_bricks;
  GlBuffer volume_block, lens_block;
  Cost cost;

  std::shared_ptr<const VolumeImage> image;
  BrickRanges ranges;
  TilePass tiles;
  TableKey key;
  std::vector<std::uint16_t> table;  // kept: it is large and asked for again while a function is dragged
  Variant variant = Variant::kPlain;
  SceneFrame frame;
  bool asks_tiles = true;

  // What was drawn last, and what is kept of it.
  VolumeView shown;  // of update()
  std::optional<VolumeView> drawn_view;
  FrameBlock drawn_block;
  std::unique_ptr<SlabCache> slabs;
  std::size_t moving_cut = 0;  // of `slabs`
  bool made_slabs = false;

  void update_image(const VolumeView& view) {
    if (image == view.image) return;
    voxels = upload_voxels(*view.image);
    ranges = brick_ranges(*view.image);
    image = view.image;
    colors = GlTexture();
    key = {};
    cost.voxel_bytes = image->bytes.size();
  }

  void update_colors(const VolumeView& view) {
    if (colors || !has_colored_parts(view)) return;
    PALPATE_CHECK(image->colors->size() == image->point_count());
    colors = upload_colors(*image);
    cost.voxel_bytes += image->colors->size() * sizeof(image->colors->front());
  }

  void update_tables(const VolumeView& view) {
    const std::vector<const ColorTransfer*> transfers = transfers_of(view);
    TableKey wanted;
    for (const ColorTransfer* transfer : transfers) wanted.transfers.push_back(*transfer);
    wanted.range = table_range(view);
    wanted.longest = step_lengths(view).longest / opacity_length_of(view);
    wanted.entries = view.table_entries;
    wanted.lengths = view.table_lengths;
    if (wanted == key) return;

    const Stopwatch clock;
    const auto entries = static_cast<std::size_t>(wanted.entries);
    const auto lengths = static_cast<std::size_t>(wanted.lengths);
    const int layers = wanted.lengths * static_cast<int>(transfers.size());
    tables = make_texture(GL_TEXTURE_2D_ARRAY);
    glTextureStorage3D(tables.name(), 1, GL_RGBA16, wanted.entries, wanted.entries, layers);
    set_sampling(tables, GL_LINEAR);
    const Index3 b = ranges.bricks;
    empty_bricks = make_texture(GL_TEXTURE_3D);
    glTextureStorage3D(empty_bricks.name(), 1, GL_R8UI, b.x, b.y, b.z * static_cast<int>(transfers.size()));
    set_sampling(empty_bricks, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);

    table.resize(4 * entries * entries * lengths);
    std::vector<std::uint8_t> maps;
    for (std::size_t i = 0; i < transfers.size(); ++i) {
      const std::vector<OpticalEntry> optical =
          optical_entries(*transfers[i], image->offset + image->scale * wanted.range.lower,
                          image->offset + image->scale * wanted.range.upper, entries, wanted.longest);
      preintegrate(optical, lengths, 0, table);
      glTextureSubImage3D(tables.name(), 0, 0, 0, static_cast<GLint>(i) * wanted.lengths, wanted.entries,
                          wanted.entries, wanted.lengths, GL_RGBA, GL_UNSIGNED_SHORT, table.data());
      const std::vector<std::uint8_t> distances =
          empty_distances(ranges, optical, wanted.range.lower, wanted.range.upper);
      glTextureSubImage3D(empty_bricks.name(), 0, 0, 0, static_cast<GLint>(i) * b.z, b.x, b.y, b.z,
                          GL_RED_INTEGER, GL_UNSIGNED_BYTE, distances.data());
      maps.insert(maps.end(), distances.begin(), distances.end());
      if (i > 0) continue;
      const auto empty = std::count_if(distances.begin(), distances.end(), [](auto d) { return d > 0; });
      cost.empty_share = static_cast<double>(empty) / static_cast<double>(distances.size());
    }
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    tiles.set_bricks(shell_bricks(b, maps));
    cost.table_bytes = table.size() * sizeof(std::uint16_t) * transfers.size();
    cost.brick_bytes = ranges.ranges.size() * transfers.size();
    cost.table_ms = 1e3 * clock.seconds();
    key = std::move(wanted);
  }

  void update_program(const VolumeView& view) {
    variant = variant_of(view);
    GlProgram& program = programs[static_cast<std::size_t>(variant)];
    if (program) return;
    program = compile_program("volume/volume.vert", kFragments[static_cast<std::size_t>(variant)]);
    ++cost.programs;
  }

  // Whether this picture can use what is kept, or begins to keep it.
  bool uses_slabs(const FrameBlock& block, bool opaque) {
    if (slabs && slabs->fits(shown, block, opaque)) return true;
    slabs.reset();
    if (!shown.keep_slabs || kSlabFragments[static_cast<std::size_t>(variant)] == nullptr) return false;
    if (!drawn_view || !same_camera(drawn_block, block)) return false;
    const auto cut = moved_cut(*drawn_view, shown);
    if (!cut) return false;
    slabs = std::make_unique<SlabCache>(shown, *cut, block, frame);
    moving_cut = *cut;
    GlProgram& program = slab_programs[static_cast<std::size_t>(variant)];
    if (!program) {
      program = compile_program("volume/volume.vert", kSlabFragments[static_cast<std::size_t>(variant)]);
      ++cost.programs;
    }
    return true;
  }

  void bind(const GlProgram& program, const GlBuffer& block, std::uint32_t opaque_depth) {
    glUseProgram(program.name());
    glBindBufferBase(GL_UNIFORM_BUFFER, kVolumeBlock, block.name());
    if (knows_lenses(variant)) glBindBufferBase(GL_UNIFORM_BUFFER, kLensBlock, lens_block.name());
    glBindTextureUnit(kVoxels, voxels.name());
    glBindTextureUnit(kTables, tables.name());
    glBindTextureUnit(kEmptyBricks, empty_bricks.name());
    if (variant == Variant::kColored || variant == Variant::kMagnifiedColored)
      glBindTextureUnit(kColors, colors.name());
    glBindTextureUnit(kOpaqueDepth, opaque_depth);
    glUniform1i(kHasOpaqueDepth, opaque_depth != 0 ? 1 : 0);
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_vertices.name());
  }

  void cast_rays() const { glDrawArrays(GL_TRIANGLES, 0, asks_tiles ? 6 * tiles.count() : 6); }

  static void set_slab(const SlabCache::Slab& slab) {
    glUniform3f(kSlabNormal, slab.normal.x, slab.normal.y, slab.normal.z);
    glUniform2f(kSlabBorders, slab.lower, slab.upper);
    glBindTextureUnit(kKeptPicture, slab.kept);
    glBindTextureUnit(kKeptDepth, slab.depth);
  }

  // Makes what lacks below the slab of the cut, and leaves the shader ready for the rest.
  void begin_slab(std::uint32_t opaque_depth) {
    const GlProgram& program = slab_programs[static_cast<std::size_t>(variant)];
    const GlBuffer uncut = make_block_buffer(make_volume_block(slabs->uncut(), frame, ranges.bricks));
    const int before = slabs->drawn();
    const SlabCache::Slab slab = slabs->slab_below(shown.cuts[moving_cut].kept.offset, opaque_depth,
                                                   [&](const SlabCache::Slab& below) {
                                                     // Rays end at what was opaque then: what has moved since
                                                     // is cast anew in each picture.
                                                     bind(program, uncut, below.depth);
                                                     set_slab(below);
                                                     glDisable(GL_BLEND);
                                                     cast_rays();
                                                   });
    made_slabs = slabs->drawn() > before;
    cost.slab_bytes = slabs->bytes();
    bind(program, volume_block, opaque_depth);
    set_slab(slab);
  }
};

VolumePass::VolumePass() : state_(std::make_unique<State>()) {}
VolumePass::~VolumePass() = default;

void VolumePass::update(const VolumeView& view, const SceneFrame& frame) {
  PALPATE_CHECK(view.image != nullptr);
  PALPATE_CHECK(view.samples_per_voxel > 0.0 && std::isfinite(view.samples_per_voxel));
  for (const Lens& lens : view.lenses) {
    PALPATE_CHECK(lens.samples_per_voxel > 0.0 && std::isfinite(lens.samples_per_voxel));
  }
  PALPATE_CHECK(view.table_entries >= 2 && view.table_lengths >= static_cast<int>(kLengthGroup));
  State& s = *state_;
  s.update_image(view);
  s.update_colors(view);
  s.update_tables(view);
  s.update_program(view);
  s.frame = frame;
  s.asks_tiles = asks_tiles(view);
  s.volume_block = make_block_buffer(make_volume_block(view, frame, s.ranges.bricks));
  if (knows_lenses(s.variant)) s.lens_block = make_block_buffer(make_lens_block(view, frame));
  s.shown = view;
}

void VolumePass::draw(std::uint32_t opaque_depth, const FrameBlock& block) {
  State& s = *state_;
  PALPATE_CHECK(s.image != nullptr);
  s.made_slabs = false;
  s.cost.slab_bytes = 0;
  const bool slabs = s.uses_slabs(block, opaque_depth != 0);
  if (s.asks_tiles) {
    if (!s.tiles.compiled()) ++s.cost.programs;
    glBindTextureUnit(kTiles, s.tiles.draw(*s.image, s.frame, block));
  }
  if (slabs) {
    s.begin_slab(opaque_depth);
  } else {
    s.bind(s.programs[static_cast<std::size_t>(s.variant)], s.volume_block, opaque_depth);
  }
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  s.cast_rays();
  glDisable(GL_BLEND);
  s.drawn_view = s.shown;
  s.drawn_block = block;
}

bool VolumePass::made_slabs() const noexcept { return state_->made_slabs; }

void VolumePass::forget_slabs() {
  state_->slabs.reset();
  state_->cost.slab_bytes = 0;
}

const VolumePass::Cost& VolumePass::cost() const noexcept { return state_->cost; }

}  // namespace palpate
