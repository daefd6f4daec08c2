#include "common/render/volume/context_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"
#include "common/render/gl/target.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {
namespace {

constexpr std::uint64_t kContextPixelBytes = 8 + 8 + 8;

VolumeView context_of(const VolumeView& view) {
  VolumeView context = view;
  for (Lens& lens : context.lenses) {
    lens.transfer.reset();
    lens.regions.reset();
    lens.field = 0;
    lens.samples_per_voxel = view.samples_per_voxel;
    lens.cut = true;
    lens.colored = false;
  }
  context.table_entries = view.context.table_entries;
  context.far_sampling = 1.0;
  context.storage = {};  // shared with the whole picture, or as coarse as its share of the memory asks for
  return context;
}

// The coarser voxels, whole, in the memory that there is for them.
std::shared_ptr<const VolumeImage> coarse_context(const VolumeView& view) {
  const std::uint64_t memory = view.storage.memory / kContextShare;
  return fitting_image(coarse_image(*view.image, view.context.level), memory);
}

}  // namespace

void ContextPicture::update(const VolumeView& view, const SceneFrame& frame, const VolumeTextures& whole) {
  PALPATE_CHECK(draws_context_alone(view));
  PALPATE_CHECK(view.context.viewport > 0.0 && view.context.viewport <= 1.0);
  const auto coarse = fine_ == view.image && level_ == view.context.level ? view_.image
                      : view.context.level == 0                           ? view.image
                                                                          : coarse_context(view);
  fine_ = view.image;
  level_ = view.context.level;
  view_ = context_of(view);
  view_.image = coarse;
  if (level_ > 0)
    view_.storage.least_pinned = std::numeric_limits<std::uint64_t>::max();  // lenses blend with a texture
  frame_ = frame;
  share_ = view.context.viewport;
  magnifies_ = has_magnified_parts(view);
  textures_.update(view_, {}, &whole);
  room_ = ShapeRoom::of(view_);
  std::vector<std::string> defines = textures_.shader_defines();
  defines.push_back(room_.shader_define());
  std::ranges::copy(look_defines(view), std::back_inserter(defines));
  if (defines != defines_) {
    unlit_.reset();
    shaded_.reset();
    tiles_.reset();
    defines_ = std::move(defines);
  }
  volume_block_ = volume_shader::make_block_buffer(make_volume_block(view_, frame, {textures_.bricks()}));
  shape_block_ = make_buffer(make_shape_block(view_, frame, room_));
}

void ContextPicture::resize(int width, int height) {
  if (width == width_ && height == height_) return;
  width_ = width;
  height_ = height;
  front_ = make_picture_texture(GL_RGBA16, width, height, "context before lenses");
  back_ = make_picture_texture(GL_RGBA16, width, height, "context behind lenses");
  kind_ = make_picture_texture(GL_RG32F, width, height, "kinds of context pixels");
  glTextureParameteri(front_.name(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  glTextureParameteri(front_.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(front_.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  framebuffer_ = make_framebuffer();
  constexpr std::array<GLenum, 3> kAttachments{GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1,
                                               GL_COLOR_ATTACHMENT2};
  const std::array<GLuint, 3> textures{front_.name(), back_.name(), kind_.name()};
  for (std::size_t i = 0; i < textures.size(); ++i)
    glNamedFramebufferTexture(framebuffer_.name(), kAttachments[i], textures[i], 0);
  glNamedFramebufferDrawBuffers(framebuffer_.name(), static_cast<GLsizei>(kAttachments.size()),
                                kAttachments.data());
}

void ContextPicture::draw_context(const FrameBlock& smaller) {
  const bool asks = asks_tiles(view_);
  if (asks) glBindTextureUnit(volume_shader::kTiles, textures_.tiles().draw(*view_.image, frame_, smaller));
  use_blocks();
  constexpr std::array<float, 4> kNothing{};
  constexpr std::array<float, 4> kAnyKind{2.0F, 0.0F, 0.0F, 0.0F};
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, kNothing.data());
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 1, kNothing.data());
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 2, kAnyKind.data());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, width_, height_);
  const bool lit = view_.shading || has_illustration(view_);
  GlProgram& program = lit ? shaded_ : unlit_;
  if (!program)
    program = compile_program(
        "volume/volume.vert",
        ShaderVariant{.fragment = "volume/context.frag",
                      .defines = lit ? std::vector<std::string>{"SHADED"} : std::vector<std::string>{}},
        defines_);
  glUseProgram(program.name());
  glUniform1i(volume_shader::kHasOpaqueDepth, has_opaque_depth_ ? 1 : 0);
  glUniform3f(volume_shader::kDepthPixel, 1.0F / scale_, -left_ / scale_, -bottom_ / scale_);
  if (asks) return draw_tiles(textures_.tiles().grid());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

// How far along a ray lenses may be seen.
float ContextPicture::farthest(const Vec3& eye) const {
  // What is enlarged may be seen beyond the volume: tiles are not told apart.
  if (magnifies_) return 1e30F;
  double far = 0.0;
  for (const Vec3& corner : corners_in_scene(*view_.image, frame_))
    far = std::max(far, glm::distance(corner, eye));
  return static_cast<float>(far);
}

void ContextPicture::draw_kinds(const FrameBlock& block) {
  const TileGrid grid = TileGrid::of(block);
  if (!(grid == grid_)) {
    grid_ = grid;
    tile_kinds_ = make_picture_texture(GL_R8UI, grid.columns, grid.rows, "kinds of tiles");
    tile_framebuffer_ = make_framebuffer();
    glNamedFramebufferTexture(tile_framebuffer_.name(), GL_COLOR_ATTACHMENT0, tile_kinds_.name(), 0);
  }
  use_blocks();
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, tile_framebuffer_.name());
  glViewport(0, 0, grid.columns, grid.rows);
  if (!tiles_)
    tiles_ =
        compile_program("background/background.vert", "volume/context_tiles.frag", shader_files(), defines_);
  glUseProgram(tiles_.name());
  glUniform1i(volume_shader::kHasOpaqueDepth, has_opaque_depth_ ? 1 : 0);
  glUniform3f(volume_shader::kContextPixel, scale_, left_, bottom_);
  glUniform1f(volume_shader::kFarthestLens, farthest(Vec3(block.eye)));
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

void ContextPicture::use_blocks() const {
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kVolumeBlock, volume_block_.name());
  bind_shape_block(shape_block_, room_);
  textures_.bind(false);
  glBindVertexArray(no_vertices_.name());
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_BLEND);
}

void ContextPicture::draw(std::uint32_t opaque_depth, const FrameBlock& block) {
  const auto pixels = [&](float whole) {
    return std::max(1, static_cast<int>(std::ceil(whole * share_ - 1e-6)));
  };
  resize(pixels(block.size.x), pixels(block.size.y));
  has_opaque_depth_ = opaque_depth != 0;
  // The same view in larger pixels, the middle in the middle.
  scale_ = static_cast<float>(share_);
  FrameBlock smaller = block;
  smaller.size.x = static_cast<float>(width_);
  smaller.size.y = static_cast<float>(height_);
  smaller.size.z = block.size.z / scale_;
  left_ = 0.5F * (smaller.size.x - scale_ * block.size.x);
  bottom_ = 0.5F * (smaller.size.y - scale_ * block.size.y);

  const FramebufferGuard before;
  GLint frame_buffer = 0;
  glGetIntegeri_v(GL_UNIFORM_BUFFER_BINDING, volume_shader::kFrameBlock, &frame_buffer);
  if (!no_vertices_) no_vertices_ = make_vertex_array();
  glBindTextureUnit(volume_shader::kOpaqueDepth, opaque_depth);
  draw_kinds(block);
  const GlBuffer smaller_buffer = volume_shader::make_block_buffer(smaller);
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kFrameBlock, smaller_buffer.name());
  draw_context(smaller);
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kFrameBlock, static_cast<GLuint>(frame_buffer));
}

void ContextPicture::bind_pictures(std::uint32_t wanted) const {
  glBindTextureUnit(volume_shader::kContextFront, front_.name());
  glBindTextureUnit(volume_shader::kContextBack, back_.name());
  glBindTextureUnit(volume_shader::kContextKind, kind_.name());
  glBindTextureUnit(volume_shader::kTileKinds, tile_kinds_.name());
  glUniform3f(volume_shader::kContextPixel, scale_, left_, bottom_);
  glUniform1ui(volume_shader::kWantedKind, wanted);
}

void ContextPicture::bind() const {
  bind_pictures(1);
  if (level_ > 0) textures_.bind_voxels(volume_shader::kCoarseVoxels);
}

void ContextPicture::show() {
  if (!enlarged_) enlarged_ = compile_program("volume/context_tiles.vert", "volume/enlarged.frag");
  use_blocks();
  glUseProgram(enlarged_.name());
  bind_pictures(0);
  glEnable(GL_BLEND);
  glBlendFunc(GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  draw_tiles(grid_);
  glDisable(GL_BLEND);
}

ContextPicture::Cost ContextPicture::cost() const noexcept {
  const VolumeTextures::Cost& textures = textures_.cost();
  Cost cost;
  for (const GlProgram* program : {&unlit_, &shaded_, &tiles_, &enlarged_}) cost.programs += *program ? 1 : 0;
  cost.bytes = textures.voxel_bytes + textures.table_bytes + textures.brick_bytes +
               kContextPixelBytes * static_cast<std::uint64_t>(width_) * static_cast<std::uint64_t>(height_) +
               static_cast<std::uint64_t>(grid_.columns) * static_cast<std::uint64_t>(grid_.rows);
  return cost;
}

}  // namespace palpate
