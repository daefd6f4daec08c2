/// A small picture that says for each tile of the large one between which distances rays can meet something:
/// the shell of bricks that show something, drawn as rectangles about what is seen of them
/// (shaders/volume/tiles.vert; Krueger and Westermann 2003 draw their faces). Rays of the other tiles are not
/// cast at all.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/math/vec.h"
#include "common/render/camera.h"
#include "common/render/frame_block.h"
#include "common/render/gl/object.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// Bricks that show something in any of the maps, and have a neighbour that does not or lie at the border:
/// all others lie between these along any ray. As the shader reads them, 10 bits an axis.
/// @param distances of empty_distances(), one or several maps one after another. @pre at most 1024 bricks an
/// axis.
[[nodiscard]] std::vector<std::uint32_t> shell_bricks(const Index3& bricks,
                                                      std::span<const std::uint8_t> distances);

/// Tiles of a picture of so many pixels.
struct TileGrid {
  static constexpr int kPixels = 8;  ///< along either edge of a tile
  int columns = 0;
  int rows = 0;

  [[nodiscard]] static TileGrid of(const FrameBlock& block) noexcept;
  bool operator==(const TileGrid&) const = default;
};

/// What was asked for while a picture was drawn, whose drawing it ends: to be caught where that began.
struct DrawingStopped {};

/// Draws rows from `first` on, `count` of them.
using DrawRows = std::function<void(int first, int count)>;
/// Draws `rows` of a picture at once, or where `stop` is set in parts of some hundredths of a second, between
/// which it is asked. @throws DrawingStopped when it says so.
void draw_rows(int rows, const std::function<bool()>& stop, const DrawRows& draw);

/// Draws one point for each tile with the program in use; vertex number column + columns row belongs to the
/// middle of its tile in clip coordinates of all tiles, out of which tiles are left out. Points are squares
/// of pixels, where two triangles would have software rasterisers compute those on their diagonal twice.
/// Keeps the viewport. @param stop as of draw_rows(), whose exception it throws.
void draw_tiles(const TileGrid& grid, const std::function<bool()>& stop = {});

class TilePass {
 public:
  void set_bricks(std::span<const std::uint32_t> shell);
  /// Draws the tiles of a picture as large as the frame's. Needs the frame's uniform block bound to 0; keeps
  /// the framebuffer and viewport.
  /// @return the name of the texture: minus the first and the last t of each tile; the last before the first
  /// where nothing is. The same bricks from the same place are not drawn again.
  /// @param block the frame's.
  [[nodiscard]] std::uint32_t draw(const VolumeImage& image, const SceneFrame& frame,
                                   const FrameBlock& block);
  [[nodiscard]] const TileGrid& grid() const noexcept { return grid_; }  ///< of the last picture
  /// Whether its program, or one that it shares, is compiled.
  [[nodiscard]] bool compiled() const noexcept { return static_cast<bool>(*program_); }
  /// From now on both have one program, compiled when either first draws.
  void share_program(const TilePass& other) { program_ = other.program_; }

 private:
  std::shared_ptr<GlProgram> program_ = std::make_shared<GlProgram>();
  GlVertexArray no_vertices_;
  GlBuffer bricks_;
  std::size_t brick_count_ = 0;
  GlTexture tiles_;
  GlFramebuffer framebuffer_;
  TileGrid grid_;
  std::optional<FrameBlock> drawn_;  ///< what the tiles show these bricks from
};

}  // namespace palpate
