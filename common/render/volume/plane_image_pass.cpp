#include "common/render/volume/plane_image_pass.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/gl/program.h"
#include "common/render/volume/volume_block.h"

namespace palpate {
namespace {

// Of shaders/volume/plane_image.frag.
constexpr GLint kGrey = 1, kShown = 2, kLongestParts = 3, kLineWidth = 4, kContourCount = 5, kContours = 6;
// Of lines, in thousandths of the picture's height.
constexpr float kThickness = 1.8F;

}  // namespace

void PlaneImagePass::draw(const VolumeView& view, const SceneFrame& frame, const FrameBlock& block,
                          std::span<const std::string> defines) {
  PALPATE_CHECK(view.planes.contours.size() <= kMostContours);
  if (!program_)
    program_ = compile_program("volume/plane_image.vert", "volume/plane_image.frag", shader_files(), defines);
  const VolumeImage& image = *view.image;
  const double unit = largest_number(image.type);
  const auto number = [&](double value) { return (value - image.offset) / image.scale / unit; };
  const ValueWindow window = window_of(view);
  glUseProgram(program_.name());
  glUniform2f(kGrey, static_cast<float>(number(window.level - 0.5 * window.width)),
              static_cast<float>(image.scale * unit / window.width));
  glUniform1i(kShown, view.planes.shown ? 1 : 0);
  glUniform1f(kLongestParts, static_cast<float>(opacity_length_of(view) / step_lengths(view).longest));
  glUniform1f(kLineWidth, std::max(1.0F, kThickness * block.size.y / 1000.0F));
  std::array<float, kMostContours> contours{};
  std::transform(view.planes.contours.begin(), view.planes.contours.end(), contours.begin(),
                 [&](double value) { return static_cast<float>(number(value)); });
  glUniform1i(kContourCount, static_cast<GLint>(view.planes.contours.size()));
  glUniform1fv(kContours, static_cast<GLsizei>(contours.size()), contours.data());

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  // A hair back, so that outlines that lie on a plane are before it.
  glEnable(GL_POLYGON_OFFSET_FILL);
  glPolygonOffset(0.0F, 4.0F);
  for (std::size_t i = 0; i < view.cuts.size(); ++i) {
    std::vector<Vec3f> corners;
    for (const Vec3& x : shown_section(view, i)) corners.emplace_back(frame.scene_from_data(x));
    if (corners.empty()) continue;
    const GlVertexArray array = make_vertex_array();
    const GlBuffer vertices = make_buffer(std::span<const Vec3f>(corners));
    glVertexArrayVertexBuffer(array.name(), 0, vertices.name(), 0, sizeof(Vec3f));
    glEnableVertexArrayAttrib(array.name(), 0);
    glVertexArrayAttribFormat(array.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
    glVertexArrayAttribBinding(array.name(), 0, 0);
    glBindVertexArray(array.name());
    glDrawArrays(GL_TRIANGLE_FAN, 0, static_cast<GLsizei>(corners.size()));
  }
  glDisable(GL_POLYGON_OFFSET_FILL);
  glBindVertexArray(0);
}

}  // namespace palpate
