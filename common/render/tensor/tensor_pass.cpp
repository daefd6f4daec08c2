#include "common/render/tensor/tensor_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include <epoxy/gl.h>
#include <glm/gtc/type_ptr.hpp>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/grid/grid_from_data.h"
#include "common/render/color/palette.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/program.h"
#include "common/render/scene_view.h"

namespace palpate {
namespace {

// Of shaders/tensor/slice_block.glsl.
constexpr GLint kSceneFromGrid = 0, kPoints = 4, kCrossAt = 5, kAxis = 6, kCrossLine = 7, kBorder = 8,
                kBrightness = 9, kUnderFromGrid = 10, kUnderPoints = 14, kUnderGrey = 15, kUnderBlend = 16,
                kAnisotropyGrey = 17;
constexpr GLuint kVoxelsUnit = 0, kUnderUnit = 1;
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

/// A texture of `n` voxels, not filled yet. @throws Error (usage) where it is larger than the driver's.
GlTexture make_voxel_texture(GLenum format, const Index3& n) {
  GLint largest = 0;
  glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &largest);
  if (std::max({n.x, n.y, n.z}) > largest) {
    throw usage_error("an image of " + std::to_string(n.x) + "x" + std::to_string(n.y) + "x" +
                      std::to_string(n.z) + " voxels does not fit the driver's textures; each side is 1 to " +
                      std::to_string(largest));
  }
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_3D, 1, &name);
  GlTexture texture(name);
  label_object(GpuObject::Kind::kTexture, name, "tensor image");
  glTextureStorage3D(name, 1, format, n.x, n.y, n.z);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T, GL_TEXTURE_WRAP_R}) {
    glTextureParameteri(name, wrap, GL_CLAMP_TO_EDGE);
  }
  return texture;
}

// Glyphs longer than this show the corners of a coarse mesh [pixels, half axis].
constexpr double kLargeGlyph = 20.0;

bool same_glyphs(const TensorView& a, const TensorView& b) {
  return a.image == b.image && a.position == b.position && a.slices == b.slices && a.color == b.color &&
         a.glyphs == b.glyphs && a.glyph_least_fa == b.glyph_least_fa;
}

// Those whose ball reaches into the picture.
std::vector<TensorGlyph> in_picture(const std::vector<TensorGlyph>& glyphs, float reach,
                                    const glm::mat4& clip_from_scene) {
  // Planes of the picture's sides in the scene frame: w +- x, w +- y >= 0.
  std::vector<glm::vec4> planes;
  const glm::mat4 rows = glm::transpose(clip_from_scene);
  for (const int side : {0, 1}) {
    for (const float sign : {1.0F, -1.0F}) {
      const glm::vec4 plane = rows[3] + sign * rows[side];
      planes.push_back(plane / glm::length(Vec3f(plane)));
    }
  }
  std::vector<TensorGlyph> seen;
  seen.reserve(glyphs.size());
  for (const TensorGlyph& glyph : glyphs) {
    bool inside = true;
    for (const glm::vec4& plane : planes) inside &= glm::dot(plane, glm::vec4(glyph.center, 1.0F)) >= -reach;
    if (inside) seen.push_back(glyph);
  }
  return seen;
}

}  // namespace

void SlicePass::upload(const TensorView& view) {
  if (image_ == view.image && color_ == view.color) return;
  const TensorVoxels& image = *view.image;
  const bool tensors = !image.directions.empty();  // else a lattice alone: one open voxel
  const Index3 n = tensors ? image.points : Index3{1};
  voxels_ = make_voxel_texture(GL_RGBA8, n);
  image_ = view.image;
  color_ = view.color;
  const GLuint name = voxels_.name();
  const auto send = [&](const std::vector<std::array<std::uint8_t, 4>>& voxels) {
    glTextureSubImage3D(name, 0, 0, 0, 0, n.x, n.y, n.z, GL_RGBA, GL_UNSIGNED_BYTE, voxels.data());
  };
  if (!tensors) {
    send({{0, 0, 0, 0}});
  } else if (view.color == TensorColor::kFa) {
    send(grey_voxels(image));
  } else {
    send(image.directions);
  }
}

void SlicePass::upload_underlay(const VolumeImage& image) {
  struct Layout {
    GLenum internal, type;
  };
  const Layout layout = image.type == ScalarType::kUint8    ? Layout{GL_R8, GL_UNSIGNED_BYTE}
                        : image.type == ScalarType::kUint16 ? Layout{GL_R16, GL_UNSIGNED_SHORT}
                                                            : Layout{GL_R32F, GL_FLOAT};
  const Index3 n = image.points;
  under_ = make_voxel_texture(layout.internal, n);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  std::vector<std::byte> layer(image.byte_count() / as_size(n.z));
  for (int z = 0; z < n.z; ++z) {
    image.copy({{0, 0, z}, {n.x, n.y, z + 1}}, layer.data());
    glTextureSubImage3D(under_.name(), 0, 0, 0, z, n.x, n.y, 1, GL_RED, layout.type, layer.data());
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void SlicePass::set_underlay(const TensorView& view) {
  if (!view.underlay) {
    under_image_.reset();
    under_ = GlTexture();
    glUniform1i(kUnderBlend, 0);
    return;
  }
  const UnderlayView& under = *view.underlay;
  const VolumeImage& image = *under.image;
  if (under_image_ != under.image) upload_underlay(image);
  under_image_ = under.image;
  const GLint filter = view.smooth ? GL_LINEAR : GL_NEAREST;
  glTextureParameteri(under_.name(), GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(under_.name(), GL_TEXTURE_MAG_FILTER, filter);

  // Its grid coordinates are affine in those of the slices.
  const GridFromData grid(image.axes, image.origin);
  glm::mat4 matrix{1.0F};
  for (int axis = 0; axis < 3; ++axis)
    matrix[axis] = glm::vec4(Vec3f(grid.direction(view.image->axes[axis])), 0.0F);
  matrix[3] = glm::vec4(Vec3f(grid.point(view.image->origin)), 1.0F);
  glUniformMatrix4fv(kUnderFromGrid, 1, GL_FALSE, glm::value_ptr(matrix));
  const Vec3f points(image.points);
  glUniform3fv(kUnderPoints, 1, glm::value_ptr(points));

  // The texture's whole numbers come as parts of the largest one.
  constexpr double kMost8 = 255.0, kMost16 = 65535.0;
  const double most = image.type == ScalarType::kUint8    ? kMost8
                      : image.type == ScalarType::kUint16 ? kMost16
                                                          : 1.0;
  const double black = under.window.level - 0.5 * under.window.width;
  glUniform2f(kUnderGrey, static_cast<float>(most * (image.scale / under.window.width)),
              static_cast<float>((image.offset - black) / under.window.width));
  glUniform1i(kUnderBlend, 1 + static_cast<GLint>(under.blend));
  glBindTextureUnit(kUnderUnit, under_.name());
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
  set_underlay(view);
  glUniform1i(kAnisotropyGrey, view.color == TensorColor::kFa ? 1 : 0);
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
    if (!view.slices[as_size(axis)]) continue;
    glUniform1i(kAxis, axis);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, kCorners);
  }
}

void TensorGlyphPass::update(const TensorView& view, const SceneFrame& frame, const Index3& stride) {
  const bool same = view_ && same_glyphs(*view_, view) && stride_ == stride &&
                    frame_.center == frame.center && frame_.exponent == frame.exponent;
  if (same) return;
  glyphs_ = make_slice_glyphs(view, frame, stride);
  view_ = view;
  frame_ = frame;
  stride_ = stride;
}

void TensorGlyphPass::draw(const TensorView& view, const SceneFrame& frame, const Camera& camera,
                           const ViewTransform& transform, double pixel) {
  if (view.glyphs == GlyphShape::kNone) return;
  update(view, frame, glyph_stride(*view.image, 1e-3 * view.glyph_spacing * camera.view_height));
  float reach = 0.0F;
  for (const TensorGlyph& glyph : glyphs_) {
    reach =
        std::max({reach, glm::length(glyph.axis_x), glm::length(glyph.axis_y), glm::length(glyph.axis_z)});
  }
  const std::vector<TensorGlyph> seen = in_picture(glyphs_, reach, glm::mat4(transform.clip_from_scene));
  mesh_.draw(seen, static_cast<double>(reach) > kLargeGlyph * pixel);
}

void TensorPass::draw(const SceneView& view, const SceneFrame& frame, const ViewTransform& transform,
                      float unit) {
  slices_.draw(*view.tensors, frame, palette_of(view.background), unit);
  glyphs_.draw(*view.tensors, frame, view.camera, transform, 1e-3 * transform.view_height / unit);
}

}  // namespace palpate
