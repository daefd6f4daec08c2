#include "common/render/volume/tile_pass.h"

#include <algorithm>
#include <array>

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/math/power_of_two.h"
#include "common/render/gl/program.h"
#include "common/render/gl/target.h"
#include "common/render/volume/voxels/brick_map.h"

namespace palpate {
namespace {

// Locations and bindings of shaders/volume/tiles.vert.
enum TileUniform : GLint { kSceneFromGrid = 1, kHalfCells = 2, kTileCount = 3 };
constexpr GLuint kBricks = 0;

// Half edges of a brick [cells], a little more for rounding; along an axis of one voxel a brick begins half a
// cell earlier.
Vec3 half_cells_of(const Index3& points) {
  constexpr double kHalf = 0.5 * kBrickCells, kRounding = 1.0 / 64.0;
  Vec3 half(kHalf + kRounding);
  for (int a = 0; a < 3; ++a) half[a] += points[a] == 1 ? 0.5 : 0.0;
  return half;
}

// The farthest corner of a brick from its middle.
double brick_radius(const Mat3& scene_from_grid, const Vec3& half) {
  double radius = 0.0;
  for (const double y : {-1.0, 1.0}) {
    for (const double z : {-1.0, 1.0})
      radius = std::max(radius, glm::length(scene_from_grid * (half * Vec3(1.0, y, z))));
  }
  return radius;
}

}  // namespace

TileGrid TileGrid::of(const FrameBlock& block) noexcept {
  return {(static_cast<int>(block.size.x) + kPixels - 1) / kPixels,
          (static_cast<int>(block.size.y) + kPixels - 1) / kPixels};
}

void draw_rows(int rows, const std::function<bool()>& stop, const DrawRows& draw) {
  if (!stop) return draw(0, rows);
  constexpr double kPart = 0.02;  // [s]
  constexpr int kFewestParts = 40;
  const int most = std::max(1, rows / kFewestParts);
  int count = 1;
  for (int first = 0; first < rows;) {
    count = std::min(count, rows - first);
    const Stopwatch watch;
    draw(first, count);
    glFinish();
    first += count;
    if (first < rows && stop()) throw DrawingStopped();
    const double seconds = watch.seconds();
    if (seconds < 0.5 * kPart) count = std::min(2 * count, most);
    if (seconds > kPart) count = std::max(count / 2, 1);
  }
}

void draw_tiles(const TileGrid& grid, const std::function<bool()>& stop) {
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  glViewport(viewport[0], viewport[1], TileGrid::kPixels * grid.columns, TileGrid::kPixels * grid.rows);
  glPointSize(TileGrid::kPixels);
  draw_rows(grid.rows, stop, [&](int first, int count) {
    glDrawArrays(GL_POINTS, grid.columns * first, grid.columns * count);
  });
  glViewport(viewport[0], viewport[1], viewport[2], viewport[3]);
}

std::vector<std::uint32_t> shell_bricks(const Index3& bricks, std::span<const std::uint8_t> distances) {
  PALPATE_CHECK(std::max({bricks.x, bricks.y, bricks.z}) <= 1024);
  const auto nx = as_size(bricks.x), ny = as_size(bricks.y);
  const std::size_t count = nx * ny * as_size(bricks.z);
  PALPATE_CHECK(count > 0 && distances.size() % count == 0);
  std::vector<std::uint8_t> seen(count, 0);
  for (std::size_t i = 0; i < distances.size(); ++i) {
    if (distances[i] == 0) seen[i % count] = 1;
  }
  std::vector<std::uint32_t> shell;
  for (int z = 0; z < bricks.z; ++z) {
    for (int y = 0; y < bricks.y; ++y) {
      for (int x = 0; x < bricks.x; ++x) {
        const std::size_t i = as_size(x) + nx * (as_size(y) + ny * as_size(z));
        if (seen[i] == 0) continue;
        const bool border =
            x == 0 || y == 0 || z == 0 || x + 1 == bricks.x || y + 1 == bricks.y || z + 1 == bricks.z;
        const bool inner = !border && seen[i - 1] != 0 && seen[i + 1] != 0 && seen[i - nx] != 0 &&
                           seen[i + nx] != 0 && seen[i - nx * ny] != 0 && seen[i + nx * ny] != 0;
        if (inner) continue;
        shell.push_back(static_cast<std::uint32_t>(x) | static_cast<std::uint32_t>(y) << 10U |
                        static_cast<std::uint32_t>(z) << 20U);
      }
    }
  }
  return shell;
}

void TilePass::set_bricks(std::span<const std::uint32_t> shell) {
  bricks_ = make_buffer(shell);
  brick_count_ = shell.size();
  drawn_.reset();
}

std::uint32_t TilePass::draw(const VolumeImage& image, const SceneFrame& frame, const FrameBlock& block) {
  // The frame of the scene is that of the image, whose bricks these are.
  if (drawn_ && *drawn_ == block) return tiles_.name();
  drawn_ = block;
  const FramebufferGuard before;
  const TileGrid grid = TileGrid::of(block);
  if (!*program_) *program_ = compile_program("volume/tiles.vert", "volume/tiles.frag");
  if (!no_vertices_) no_vertices_ = make_vertex_array();
  if (!(grid == grid_)) {
    tiles_ = make_picture_texture(GL_RG32F, grid.columns, grid.rows, "tiles that rays are cast in");
    framebuffer_ = make_framebuffer();
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, tiles_.name(), 0);
    grid_ = grid;
  }

  const double to_scene = power_of_two(-frame.exponent);
  const Mat3 axes = image.axes * to_scene;
  glm::mat4 scene_from_grid{Mat4(axes)};
  scene_from_grid[3] = {Vec3f(frame.scene_from_data(image.origin)), 1.0F};

  constexpr std::array<float, 4> kNothing{-1e30F, -1e30F, 0.0F, 0.0F};
  glClearNamedFramebufferfv(framebuffer_.name(), GL_COLOR, 0, kNothing.data());
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_.name());
  glViewport(0, 0, grid.columns, grid.rows);
  glUseProgram(program_->name());
  glUniformMatrix4fv(kSceneFromGrid, 1, GL_FALSE, glm::value_ptr(scene_from_grid));
  const Vec3f half(half_cells_of(image.points));
  glUniform4f(kHalfCells, half.x, half.y, half.z,
              static_cast<float>(brick_radius(axes, half_cells_of(image.points))));
  glUniform2f(kTileCount, static_cast<float>(grid.columns), static_cast<float>(grid.rows));
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBricks, bricks_.name());
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendEquation(GL_MAX);
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * brick_count_));
  glBlendEquation(GL_FUNC_ADD);
  glDisable(GL_BLEND);
  return tiles_.name();
}

}  // namespace palpate
