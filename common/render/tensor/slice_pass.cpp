#include "common/render/tensor/slice_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "common/base/error.h"
#include "common/render/gl/program.h"

namespace palpate {
namespace {

// Of shaders/tensor/slice_block.glsl.
constexpr GLint kSceneFromGrid = 0, kPoints = 4, kCrossAt = 5, kAxis = 6, kCrossLine = 7, kBorder = 8,
                kBrightness = 9;
constexpr GLuint kVoxelsUnit = 0;
constexpr GLsizei kCorners = 4;
// Slices step back behind glyphs in the same colours.
constexpr float kBehindGlyphs = 0.4F;

glm::mat4 scene_from_grid(const TensorVoxels& image, const SceneFrame& frame) {
  const double scale = power_of_two(-frame.exponent);
  const Vec3 origin = frame.scene_from_data(image.origin);
  glm::mat4 matrix{1.0F};
  for (int axis = 0; axis < 3; ++axis) matrix[axis] = glm::vec4(Vec3f(image.axes[axis] * scale), 0.0F);
  matrix[3] = glm::vec4(Vec3f(origin), 1.0F);
  return matrix;
}

std::vector<std::array<std::uint8_t, 4>> grey_voxels(const TensorVoxels& image) {
  std::vector<std::array<std::uint8_t, 4>> voxels(image.directions.size());
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const std::uint8_t grey = image.anisotropies[i];
    voxels[i] = {grey, grey, grey, image.directions[i][3]};
  }
  return voxels;
}

}  // namespace

void SlicePass::upload(const TensorView& view) {
  if (image_ == view.image && color_ == view.color) return;
  const TensorVoxels& image = *view.image;
  const Index3 n = image.points;
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  if (std::max({n.x, n.y, n.z}) > largest) {
    throw usage_error("an image of " + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                      std::to_string(n.z) + " voxels does not fit the driver's textures; each side is 1 to " +
                      std::to_string(largest));
  }
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  voxels_ = GlTexture(name);
  glTextureStorage3D(name, 1, GL_RGBA8, n.x, n.y, n.z);
  const auto send = [&](const std::vector<std::array<std::uint8_t, 4>>& voxels) {
    glTextureSubImage3D(name, 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_UNSIGNED_BYTE, voxels.data());
  };
  if (view.color == TensorColor::kFa) {
    send(grey_voxels(image));
  } else {
    send(image.directions);
  }
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
  }
  image_ = view.image;
  color_ = view.color;
}

void SlicePass::draw(const TensorView& view, const SceneFrame& frame, const Palette& colors, float unit) {
  if (std::none_of(view.slices.begin(), view.slices.end(), [](bool shown) { return shown; })) return;
  if (!program_) {
    program_ = compile_program("tensor/slice.vert", "tensor/slice.frag");
    no_vertices_ = make_vertex_array();
  }
  upload(view);
  const GLint filter = view.smooth ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(voxels_.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(voxels_.name(), GL_TEXTURE_MAG_FILTER, filter);

  const TensorVoxels& image = *view.image;
  const float half_line = std::max(0.5F, 0.6F * unit);
  const glm::mat4 matrix = scene_from_grid(image, frame);
  const Vec3f points(image.points), cross(image.grid_coordinates(view.position));
  glUseProgram(program_.name());
  glUniformMatrix4fv(kSceneFromGrid, 1, GL_FALSE, glm::value_ptr(matrix));
  glUniform3fv(kPoints, 1, glm::value_ptr(points));
  glUniform3fv(kCrossAt, 1, glm::value_ptr(cross));
  glUniform4f(kCrossLine, colors.ink.r, colors.ink.g, colors.ink.b, view.crosshair ? half_line : 0.0F);
  glUniform4f(kBorder, colors.outline.r, colors.outline.g, colors.outline.b, half_line);
  glUniform1f(kBrightness, view.glyphs == GlyphShape::kNone ? 1.0F : kBehindGlyphs);
  glBindTextureUnit(kVoxelsUnit, voxels_.name());
  glBindVertexArray(no_vertices_.name());
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  for (int axis = 0; axis < 3; ++axis) {
    if (!view.slices[static_cast<std::size_t>(axis)]) continue;
    glUniform1i(kAxis, axis);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, kCorners);
  }
}

}  // namespace palpate
