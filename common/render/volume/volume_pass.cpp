#include "common/render/volume/volume_pass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/object.h"
#include "common/render/gl/program.h"
#include "common/render/line/line_layers.h"
#include "common/render/volume/cached_volume.h"
#include "common/render/volume/context_picture.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/plane_image_pass.h"
#include "common/render/volume/shape_block.h"
#include "common/render/volume/slab_cache.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/volume_textures.h"

namespace palpate {
namespace {

enum class Variant : std::uint8_t { kPlain, kShaded, kLenses, kColored, kMagnified, kMagnifiedColored };
constexpr std::size_t kVariants = 6;

/// What is cast of a ray: all of it; a slab, over what is kept; or lenses, over a picture of the context,
/// into whose values theirs may go over.
enum class Reach : std::uint8_t { kAll, kSlab, kLenses, kBlendedLenses };
constexpr std::size_t kReaches = 4;

constexpr const char* kLayersDefine = "LAYERS";

bool over_context(Reach reach) { return reach == Reach::kLenses || reach == Reach::kBlendedLenses; }

bool is_magnified(Variant variant) {
  return variant == Variant::kMagnified || variant == Variant::kMagnifiedColored;
}

bool is_colored(Variant variant) {
  return variant == Variant::kColored || variant == Variant::kMagnifiedColored;
}

ShaderVariant shader_of(Reach reach, Variant variant) {
  const bool parts = variant != Variant::kPlain && variant != Variant::kShaded;
  ShaderVariant shader{.fragment = parts ? "volume/lenses.frag" : "volume/volume.frag", .defines = {}};
  const auto define = [&](bool on, const char* name) {
    if (on) shader.defines.emplace_back(name);
  };
  define(reach == Reach::kSlab, "SLABS");
  define(over_context(reach), "CONTEXT");
  define(reach == Reach::kBlendedLenses, "BLENDED");
  define(variant == Variant::kShaded, "SHADED");
  define(is_magnified(variant), "MAGNIFIED");
  define(is_colored(variant), "COLORED");
  return shader;
}

Variant variant_of(const VolumeView& view) {
  if (has_magnified_parts(view))
    return has_colored_parts(view) ? Variant::kMagnifiedColored : Variant::kMagnified;
  if (has_colored_parts(view)) return Variant::kColored;
  if (!view.lenses.empty()) return Variant::kLenses;
  return view.shading || has_illustration(view) ? Variant::kShaded : Variant::kPlain;
}

// What there is for the voxels that are not those of a coarser context.
VoxelStorage storage_of_whole(const VolumeView& view) {
  VoxelStorage storage = view.storage;
  if (draws_context_alone(view) && view.context.level > 0) storage.memory -= storage.memory / kContextShare;
  return storage;
}

}  // namespace

struct VolumePass::State {
  std::array<std::array<GlProgram, kVariants>, kReaches> programs;
  GlVertexArray no_vertices = make_vertex_array();
  VolumeTextures textures;
  GlBuffer volume_block, shape_block;
  ShapeRoom room;
  Cost cost;
  std::unique_ptr<VolumeVariant> again;     // once some of its rays were asked for
  std::unique_ptr<ContextPicture> context;  // where the context is drawn by itself

  PlaneImagePass planes;
  Variant variant = Variant::kPlain;
  std::vector<std::string> defines;  // of all programs
  SceneFrame frame;
  bool asks_tiles = true;
  const LineLayers* layers = nullptr;

  // What was drawn last, and what is kept of it.
  VolumeView shown;  // of update()
  VolumeView asked;  // for, whose voxels may be finer
  std::optional<VolumeView> drawn_view;
  FrameBlock drawn_block;
  std::uint32_t drawn_depth = 0;  // of opaque things, as draw() was given it
  std::unique_ptr<SlabCache> slabs;
  std::unique_ptr<CachedVolume> cached;
  bool made_slabs = false, made_cached = false;  // by the last draw()
  std::function<bool()> stop;                    // of the draw() that goes on

  const GlProgram& program_of(Reach reach) {
    GlProgram& program = programs[as_size(reach)][as_size(variant)];
    if (!program) {
      program = compile_program(over_context(reach) ? "volume/context_tiles.vert" : "volume/volume.vert",
                                shader_of(reach, variant), defines);
      ++cost.programs;
    }
    return program;
  }

  [[nodiscard]] bool caches_slabs() const {
    return shown.cache_slabs && !shown.shadows && !context && layers == nullptr && !has_regions(shown) &&
           !samples_less_far(shown) && !is_colored(variant) && !has_uneven_steps(shown);
  }

  // Whether this picture can use what is kept, or begins to keep it.
  bool uses_slabs(const FrameBlock& block, std::uint32_t opaque_depth) {
    if (slabs && !context && slabs->fits(shown, block, opaque_depth != 0)) return true;
    slabs.reset();
    if (!caches_slabs()) return false;
    if (!drawn_view || !same_camera(drawn_block, block)) return false;
    const auto cut = moved_cut(*drawn_view, shown);
    if (!cut) return false;
    slabs = std::make_unique<SlabCache>(shown, *cut, block, frame, opaque_depth);
    return true;
  }

  [[nodiscard]] VolumeBlock make_volume(const VolumeView& view) const {
    VolumeBlock block = make_volume_block(view, frame, textures.field_bricks());
    // Beside light it costs little to ask.
    float& fewest = block.fields[0].samples_to_leap;
    if (variant == Variant::kPlain)
      fewest = std::max(fewest, static_cast<float>(textures.fewest_samples_to_leap()));
    return block;
  }

  [[nodiscard]] GlBuffer make_shapes(const VolumeView& view) const {
    return make_buffer(make_shape_block(view, frame, room));
  }

  // What all programs of the volume know.
  void bind_volume(const GlBuffer& volume, const GlBuffer& shapes) {
    glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kVolumeBlock, volume.name());
    bind_shape_block(shapes, room);
    textures.bind(is_colored(variant));
  }

  void bind(const GlProgram& program, const GlBuffer& volume, const GlBuffer& shapes,
            std::uint32_t opaque_depth) {
    bind_volume(volume, shapes);
    use(program, opaque_depth, 1.0F);
    if (!context) glUniform1i(volume_shader::kHasCached, 0);
  }

  // @param step pixels of opaque_depth to one of the picture.
  void use(const GlProgram& program, std::uint32_t opaque_depth, float step) const {
    glUseProgram(program.name());
    glBindTextureUnit(volume_shader::kOpaqueDepth, opaque_depth);
    glUniform1i(volume_shader::kHasOpaqueDepth, opaque_depth != 0 ? 1 : 0);
    glUniform3f(volume_shader::kDepthPixel, step, 0.0F, 0.0F);
    if (layers != nullptr) layers->bind();
    glDisable(GL_DEPTH_TEST);
    glBindVertexArray(no_vertices.name());
  }

  // What is shown and what is drawn again have one program where they are told the same.
  const GlProgram& program_again() {
    std::vector<std::string> all_defines = again->defines;
    if (layers != nullptr) all_defines.emplace_back(kLayersDefine);
    if (all_defines == defines) return program_of(Reach::kAll);
    if (!again->program) {
      const ShaderVariant shader = shader_of(Reach::kAll, variant);
      again->program = compile_program("volume/volume.vert", shader, all_defines);
      label_object(GpuObject::Kind::kProgram, again->program.name(), shader.label() + ", again");
      ++cost.programs;
    }
    return again->program;
  }

  // Rays of all pixels but those that `seen` shows already, with other samples and tables.
  void cast_again(const VolumeView& as, std::uint32_t opaque_depth, float step, const CachedVolume* seen) {
    if (!again) again = std::make_unique<VolumeVariant>();
    again->update(as, frame, textures);
    glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kVolumeBlock, again->volume_block.name());
    bind_shape_block(again->shape_block, again->room);
    again->textures.bind(is_colored(variant));
    use(program_again(), opaque_depth, step);
    glUniform1i(volume_shader::kHasCached, seen != nullptr ? 1 : 0);
    if (seen != nullptr) glBindTextureUnit(volume_shader::kStillDepth, seen->depth());
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
  }

  void cast_rays() const {
    if (asks_tiles && layers == nullptr) return draw_tiles(textures.tiles().grid(), stop);
    if (!stop) return glDrawArrays(GL_TRIANGLES, 0, 3);
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    glEnable(GL_SCISSOR_TEST);
    draw_rows(viewport[3], stop, [&](int first, int count) {
      glScissor(viewport[0], viewport[1] + first, viewport[2], count);
      glDrawArrays(GL_TRIANGLES, 0, 3);
    });
    glDisable(GL_SCISSOR_TEST);
  }

  void set_slab(const SlabCache::Slab& slab) const {
    glUniform3f(volume_shader::kSlabNormal, slab.normal.x, slab.normal.y, slab.normal.z);
    glUniform2f(volume_shader::kSlabBorders, slab.lower, slab.upper);
    glBindTextureUnit(volume_shader::kCachedPicture, slab.kept);
    glBindTextureUnit(volume_shader::kCachedDepth, slabs->depth());
  }

  // Drivers compile at the first draw into a framebuffer: here with no pixel of it.
  void compile_slab_draw() {
    std::array<GLint, 4> viewport{};
    glGetIntegerv(GL_VIEWPORT, viewport.data());
    bind(program_of(Reach::kSlab), volume_block, shape_block, drawn_depth);
    glEnable(GL_SCISSOR_TEST);
    glScissor(0, 0, 0, 0);
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    cast_rays();
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
  }

  // Casts a slab that is to be kept. Rays end at what was opaque when the first one was made: what has moved
  // since is cast anew in each picture.
  [[nodiscard]] SlabCache::DrawSlab caster() {
    struct Blocks {
      GlBuffer volume, shapes;
    };
    auto uncut = std::make_shared<const Blocks>(
        Blocks{volume_shader::make_block_buffer(make_volume(slabs->uncut())), make_shapes(slabs->uncut())});
    return [this, uncut](const SlabCache::Slab& slab) {
      bind(program_of(Reach::kSlab), uncut->volume, uncut->shapes, slabs->depth());
      set_slab(slab);
      glDisable(GL_BLEND);
      cast_rays();
    };
  }

  // Makes what lacks below the slab of the cut, and leaves the shader ready for the rest.
  void begin_slab(std::uint32_t opaque_depth) {
    const GlProgram& program = program_of(Reach::kSlab);
    const int before = slabs->drawn();
    const SlabCache::Slab slab = slabs->slab_below(shown.cuts[slabs->cut()].kept.offset, caster());
    made_slabs = slabs->drawn() > before;
    bind(program, volume_block, shape_block, opaque_depth);
    set_slab(slab);
  }

  // Casts rays over the framebuffer that is bound, but for those that `seen` shows already.
  void draw_volume(bool slab, std::uint32_t opaque_depth, const FrameBlock& block, const CachedVolume* seen) {
    if (context) {
      context->draw(opaque_depth, block);
      context->show();
    }
    if (asks_tiles)
      glBindTextureUnit(volume_shader::kTiles, textures.tiles().draw(*shown.image, frame, block));
    if (slab) {
      begin_slab(opaque_depth);
    } else {
      const Reach reach = !context               ? Reach::kAll
                          : blends_values(shown) ? Reach::kBlendedLenses
                                                 : Reach::kLenses;
      bind(program_of(reach), volume_block, shape_block, opaque_depth);
      if (context) context->bind();
    }
    if (seen != nullptr) {
      glBindTextureUnit(volume_shader::kStillDepth, seen->depth());
      glUniform1i(volume_shader::kHasCached, 1);
    }
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
    if (context) {
      draw_tiles(context->grid(), stop);
    } else {
      cast_rays();
    }
    glDisable(GL_BLEND);
  }

  // As VolumePass::draw().
  void draw_picture(std::uint32_t opaque_depth, const FrameBlock& block, bool has_bricks) {
    made_slabs = made_cached = false;
    const bool with_slabs = uses_slabs(block, opaque_depth);
    const bool stands = drawn_view && drawn_block == block && same_picture(*drawn_view, shown);
    const bool keeps =
        CachedVolume::possible(shown) || (cached && cached->refined() && cached->fits(shown, block));
    if (opaque_depth != 0 && keeps && has_bricks && (stands || !with_slabs)) {
      if (!cached || !cached->fits(shown, block)) {
        cached = std::make_unique<CachedVolume>(
            shown, block, opaque_depth, [&] { draw_volume(with_slabs, opaque_depth, block, nullptr); });
        made_cached = true;
      }
      cached->show(opaque_depth);
      if (!made_cached && context) {
        cast_again(sampled_view(shown, 1.0, 1.0), opaque_depth, 1.0F, cached.get());
      } else if (!made_cached) {
        draw_volume(with_slabs, opaque_depth, block, cached.get());
      }
    } else {
      cached.reset();
      draw_volume(with_slabs, opaque_depth, block, nullptr);
    }
    drawn_view = shown;
    drawn_block = block;
    drawn_depth = opaque_depth;
  }
};

VolumePass::VolumePass() : state_(std::make_unique<State>()) {}
VolumePass::~VolumePass() = default;

void VolumePass::show_layers(const LineLayers* layers, bool same) {
  State& s = *state_;
  if ((layers != nullptr) != (s.layers != nullptr)) {
    s.slabs.reset();
    s.cached.reset();
  }
  if (!same) s.cached.reset();
  s.layers = layers;
}

void VolumePass::update(const VolumeView& asked, const SceneFrame& frame, const FrameBlock& block) {
  PALPATE_CHECK(asked.image != nullptr);
  PALPATE_CHECK(asked.samples_per_voxel > 0.0 && std::isfinite(asked.samples_per_voxel));
  for (const Lens& lens : asked.lenses) {
    PALPATE_CHECK(lens.samples_per_voxel > 0.0 && std::isfinite(lens.samples_per_voxel));
  }
  State& s = *state_;
  VolumeView view = asked;
  if (s.layers != nullptr) view.context = {};
  view.storage = storage_of_whole(view);
  if (s.again && s.asked.image != asked.image) s.again.reset();
  if (s.again) s.again->textures.release_bricks();
  const std::uint64_t voxels = s.textures.changes();
  s.textures.update(view, make_brick_sight(block, frame));
  if (s.textures.changes() != voxels) {
    s.slabs.reset();
    s.cached.reset();
  }
  view.storage = asked.storage;
  view = s.textures.drawn(std::move(view));
  s.asked = asked;
  s.room = ShapeRoom::of(view);
  std::vector<std::string> defines = s.textures.shader_defines();
  defines.push_back(s.room.shader_define());
  std::ranges::copy(look_defines(view), std::back_inserter(defines));
  if (samples_less_far(view)) defines.emplace_back("FAR");
  if (s.layers != nullptr) defines.emplace_back(kLayersDefine);
  if (defines != s.defines) {
    s.programs = {};
    s.planes = {};
    s.context.reset();
    if (s.again) s.again->program.reset();
    s.defines = std::move(defines);
  }
  if (s.again && s.variant != variant_of(view)) s.again->program.reset();
  s.variant = variant_of(view);
  s.frame = frame;
  s.asks_tiles = asks_tiles(view);
  VolumeBlock filled = s.make_volume(view);
  filled.far = far_range(view, frame, block);
  s.volume_block = volume_shader::make_block_buffer(filled);
  s.shape_block = s.make_shapes(view);
  s.shown = view;
  if (!draws_context_alone(view)) {
    s.context.reset();
  } else {
    if (!s.context) s.context = std::make_unique<ContextPicture>();
    s.context->update(view, frame, s.textures);
  }
}

void VolumePass::draw(std::uint32_t opaque_depth, const FrameBlock& block,
                      const std::function<bool()>& stop) {
  State& s = *state_;
  PALPATE_CHECK(s.textures.image() != nullptr);
  s.stop = stop;
  try {
    s.draw_picture(opaque_depth, block, bricks().complete());
  } catch (const DrawingStopped&) {
    s.stop = {};
    s.cached.reset();
    s.slabs.reset();
    s.drawn_view.reset();
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    throw;
  }
  s.stop = {};
}

const VolumeView& VolumePass::drawn_view() const {
  PALPATE_CHECK(state_->drawn_view);
  return *state_->drawn_view;
}

void VolumePass::draw_as(const VolumeView& as, std::uint32_t opaque_depth, float step) {
  PALPATE_CHECK(state_->textures.image() != nullptr && bricks().complete());
  state_->cast_again(as, opaque_depth, step, nullptr);
}

const VolumeView& VolumePass::asked_view() const noexcept { return state_->asked; }

const LineLayers* VolumePass::layers() const noexcept { return state_->layers; }

bool VolumePass::has_asked_voxels() const {
  const VolumeView &asked = state_->asked, &shown = state_->shown;
  for (std::size_t field = 0; field < field_count(asked); ++field) {
    if (shows_field(asked, field) && image_of(asked, field) != image_of(shown, field)) return false;
  }
  return true;
}

bool VolumePass::refine(int doublings) {
  State& s = *state_;
  if (!s.drawn_view || s.drawn_depth == 0 || !bricks().complete()) return false;
  if (!s.cached || !s.cached->fits(s.shown, s.drawn_block)) {
    s.cached = std::make_unique<CachedVolume>(s.shown, s.drawn_block, s.drawn_depth, [&] {
      s.draw_volume(false, s.drawn_depth, s.drawn_block, nullptr);
    });
    return true;
  }
  const VolumeView finer = finer_view(s.shown, doublings);
  return s.cached->refine(doublings, [&] { draw_as(finer, s.cached->depth(), 1.0F); });
}

bool VolumePass::prepare_slabs(std::size_t cut) {
  State& s = *state_;
  if (!s.drawn_view || !s.caches_slabs() || cut >= s.shown.cuts.size() || !s.shown.cuts[cut].on) return false;
  if (s.slabs && (s.slabs->cut() != cut || !s.slabs->fits(s.shown, s.drawn_block, s.drawn_depth != 0)))
    s.slabs.reset();
  if (!s.slabs) {
    s.slabs = std::make_unique<SlabCache>(s.shown, cut, s.drawn_block, s.frame, s.drawn_depth);
    s.compile_slab_draw();
  }
  return s.slabs->prepare(s.shown.cuts[cut].kept.offset, s.caster());
}

void VolumePass::draw_planes(const FrameBlock& block) {
  State& s = *state_;
  PALPATE_CHECK(s.textures.image() != nullptr);
  if (!shows_planes(s.shown)) return;
  s.bind_volume(s.volume_block, s.shape_block);
  s.planes.draw(s.shown, s.frame, block, s.defines);
}

std::optional<CoarserVoxels> VolumePass::coarser_voxels() const noexcept {
  const auto& drawn = state_->textures.image();
  if (drawn == nullptr || drawn == state_->asked.image) return std::nullopt;
  return CoarserVoxels{.points = drawn->points, .hidden = state_->textures.hidden()};
}

BrickShare VolumePass::bricks() const noexcept { return state_->textures.bricks_held(); }

bool VolumePass::made(PictureCache cache) const noexcept {
  return (cache == PictureCache::kVolume && state_->made_cached) ||
         (cache == PictureCache::kSlabs && state_->made_slabs);
}

void VolumePass::forget(PictureCache cache) noexcept {
  if (cache == PictureCache::kVolume) state_->cached.reset();
  if (cache == PictureCache::kSlabs) state_->slabs.reset();
}

VolumePass::Cost VolumePass::cost() const {
  Cost cost = state_->cost;
  const VolumeTextures::Cost& textures = state_->textures.cost();
  cost.programs += state_->textures.tiles().compiled() ? 1 : 0;
  cost.slab_bytes = state_->slabs ? state_->slabs->bytes() : 0;
  cost.cached_bytes = state_->cached ? state_->cached->bytes() : 0;
  cost.voxel_bytes = textures.voxel_bytes + textures.field_bytes;
  cost.table_bytes = textures.table_bytes;
  cost.brick_bytes = textures.brick_bytes;
  cost.table_ms = textures.table_ms;
  cost.tables_made = textures.tables_made;
  cost.segments_made = textures.segments_made;
  cost.tables_by = state_->textures.table_choice().text();
  cost.empty_share = textures.empty_share;
  if (state_->again) cost.again_bytes = state_->again->textures.cost().table_bytes;
  if (state_->context) {
    const ContextPicture::Cost context = state_->context->cost();
    cost.programs += context.programs;
    cost.context_bytes = context.bytes;
  }
  return cost;
}

}  // namespace palpate
