#include "common/render/volume/estimate/sparse_rays.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include <epoxy/gl.h>
#include <glm/mat4x4.hpp>

#include "common/base/index.h"
#include "common/base/ledger.h"
#include "common/render/gl/object.h"
#include "common/render/gl/target.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/voxels/voxel_bricks.h"

namespace palpate {
namespace {

// Memory for the finest voxels: half of the picture's.
std::uint64_t memory_beside(const VolumeView& view) { return view.storage.memory / 2; }

// Bricks so small that those along a few rays fit.
int brick_cells_for(const VolumeView& view) {
  const Index3 n = view.image->points;
  const auto bytes_along_a_ray = [&](int cells) {
    const double points = cells + 3.0;
    return 3.0 * std::max({n.x, n.y, n.z}) / cells * points * points * points *
           static_cast<double>(byte_size(view.image->type));
  };
  constexpr double kRays = 4.0;
  int cells = view.storage.brick_cells > 0 ? view.storage.brick_cells : kPoolBrickCells;
  while (cells % (2 * kBrickCells) == 0 &&
         kRays * bytes_along_a_ray(cells) > static_cast<double>(memory_beside(view)))
    cells /= 2;
  return cells;
}

// The pixels of `lattice` over what lies behind, once `draw` has drawn rays there.
template <typename Draw>
std::vector<std::uint8_t> drawn_pixels(const StillPicture& picture, const PixelLattice& lattice,
                                       const Draw& draw) {
  const FramebufferGuard before;
  constexpr const char* kPixels = "pixels looked at again";
  const GlTexture pixels = make_picture_texture(GL_RGBA8, lattice.columns, lattice.rows, kPixels);
  // It is gone before the objects of the picture are counted.
  Ledger::enter(std::string("texture ") + kPixels, "the error of the picture", 0.0,
                4 * as_size(lattice.columns) * as_size(lattice.rows));
  const auto& sharp = picture.sharp;
  std::vector<std::uint8_t> bytes = pixels_of(sharp ? sharp->behind : picture.behind, lattice);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  glTextureSubImage2D(pixels.name(), 0, 0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE,
                      bytes.data());
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const GlFramebuffer framebuffer = make_framebuffer();
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, pixels.name(), 0);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, lattice.columns, lattice.rows);

  // The same view in pixels k times as large, the middle in the middle; their middles are those of the
  // picture's.
  const auto step = static_cast<float>(lattice.step);
  FrameBlock larger = picture.block;
  larger.size.x /= step;
  larger.size.y /= step;
  larger.size.z *= step;
  const GlBuffer block = volume_shader::make_block_buffer(larger);
  glBindBufferBase(GL_UNIFORM_BUFFER, volume_shader::kFrameBlock, block.name());
  draw(sharp ? sharp->opaque_depth : picture.opaque_depth,
       static_cast<float>(lattice.step * (sharp ? 1.0 : picture.resolution)));

  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, lattice.columns, lattice.rows, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  return bytes;
}

// The block of the picture that the pixels of `box` are of: no more is in sight.
FrameBlock seen_through(const LatticeBox& box, const PixelLattice& lattice, FrameBlock block) {
  const auto zoom = [&](int axis, int first, int end, float size) {
    const float pixel = 2.0F * static_cast<float>(lattice.step) / size;  // in clip coordinates
    const float half = 0.5F * pixel * static_cast<float>(end - first);
    const float middle = 0.5F * pixel * static_cast<float>(first + end) - 1.0F;
    glm::mat4 to_box(1.0F);
    to_box[axis][axis] = 1.0F / half;
    to_box[3][axis] = -middle / half;
    block.clip_from_scene = to_box * block.clip_from_scene;
  };
  zoom(0, box.left, box.right, block.size.x);
  zoom(1, box.bottom, box.top, block.size.y);
  return block;
}

}  // namespace

std::vector<std::uint8_t> pixels_of(const Image& image, const PixelLattice& lattice) {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(4 * as_size(lattice.columns) * as_size(lattice.rows));
  for (int j = 0; j < lattice.rows; ++j) {
    for (int i = 0; i < lattice.columns; ++i) {
      for (const int component : image.pixel(lattice.place(i), image.height - 1 - lattice.place(j)))
        bytes.push_back(static_cast<std::uint8_t>(component));
    }
  }
  return bytes;
}

std::vector<std::uint8_t> cast_sparse_rays(VolumePass& pass, const VolumeView& as,
                                           const StillPicture& picture, const PixelLattice& lattice) {
  return drawn_pixels(picture, lattice,
                      [&](std::uint32_t opaque_depth, float step) { pass.draw_as(as, opaque_depth, step); });
}

std::vector<LatticeBox> FinestRays::boxes(const VolumeView& asked, const PixelLattice& lattice) {
  constexpr double kRoom = 8.0;  // bricks at the border of a box are those of its neighbours, too
  const auto memory = static_cast<double>(memory_beside(asked));
  const double parts = memory > 0.0 ? kRoom * static_cast<double>(asked.image->byte_count()) / memory : 1.0;
  const auto most = static_cast<double>(std::max(lattice.columns, lattice.rows));
  const int side = static_cast<int>(std::clamp(std::ceil(std::sqrt(parts)), 1.0, most));
  const int across = std::min(side, lattice.columns), up = std::min(side, lattice.rows);
  std::vector<LatticeBox> boxes;
  for (int j = 0; j < up; ++j) {
    for (int i = 0; i < across; ++i) {
      boxes.push_back({.left = i * lattice.columns / across,
                       .bottom = j * lattice.rows / up,
                       .right = (i + 1) * lattice.columns / across,
                       .top = (j + 1) * lattice.rows / up});
    }
  }
  return boxes;
}

std::optional<std::vector<std::uint8_t>> FinestRays::cast(const VolumePass& pass, const StillPicture& picture,
                                                          const SceneFrame& frame,
                                                          const PixelLattice& lattice,
                                                          const LatticeBox& box) {
  const VolumeView converged = converged_view(pass.asked_view());
  VolumeView held = converged;
  held.storage = {.memory = memory_beside(converged), .brick_cells = brick_cells_for(converged)};
  held.table_entries = 2;  // nothing is drawn with them
  finest_.show_layers(pass.layers(), true);
  finest_.update(held, frame, seen_through(box, lattice, picture.block));
  if (!finest_.has_asked_voxels()) return std::nullopt;
  return drawn_pixels(picture, lattice, [&](std::uint32_t opaque_depth, float step) {
    glEnable(GL_SCISSOR_TEST);
    glScissor(box.left, box.bottom, box.right - box.left, box.top - box.bottom);
    finest_.draw_as(converged, opaque_depth, step);
    glDisable(GL_SCISSOR_TEST);
  });
}

}  // namespace palpate
