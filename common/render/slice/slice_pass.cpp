#include "common/render/slice/slice_pass.h"

#include <epoxy/gl.h>

#include "common/render/gl/program.h"
#include "common/render/gl/target.h"
#include "common/render/slice/slice_raster.h"

namespace palpate {

void VolumeSlicePass::draw(const SliceView& slice, const Camera& camera, int width, int height) {
  if (!program_) {
    program_ = compile_program("background/background.vert", "slice/slice.frag");
    no_vertices_ = make_vertex_array();
  }
  const bool same_size = texture_ && width == width_ && height == height_;
  if (!same_size) {
    texture_ = make_picture_texture(GL_RGBA8, width, height, "slice");
    width_ = width;
    height_ = height;
  }
  if (!same_size || !shown_ || !same_pixels(*shown_, slice) || !(camera_ == camera)) {
    const Image image = slice_raster(slice, camera, width, height);
    glTextureSubImage2D(texture_.name(), 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE,
                        image.rgba.data());
    shown_ = slice;
    camera_ = camera;
  }
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  glUseProgram(program_.name());
  glBindTextureUnit(0, texture_.name());
  glBindVertexArray(no_vertices_.name());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDisable(GL_BLEND);
}

}  // namespace palpate
