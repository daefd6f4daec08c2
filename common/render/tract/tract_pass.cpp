#include "common/render/tract/tract_pass.h"

#include <algorithm>
#include <cmath>

#include <epoxy/gl.h>

#include "common/base/clock.h"
#include "common/math/power_of_two.h"
#include "common/render/gl/program.h"
#include "common/render/tract/tract_bundle.h"

namespace palpate {
namespace {

// Between two questions whether to stop [ms]: what a hand that moves the view hardly feels, and many times
// what it costs to wait for the driver.
constexpr double kBetweenQuestions = 30.0;

// Locations and bindings of shaders/tract/.
enum Uniform : GLint {
  kWidth = 0,
  kFading = 1,
  kDimming = 2,
  kOpacity = 3,
  kPiece = 4,
  kSlab = 5,
  kSlabHalf = 6
};
constexpr GLuint kPointBuffer = 0, kColorBuffer = 1;

}  // namespace

void TractPass::update(const std::shared_ptr<const TractBundle>& bundle, const SceneFrame& frame) {
  const bool same_frame = frame.center == frame_.center && frame.exponent == frame_.exponent;
  if (bundle_ == bundle && same_frame) return;
  bundle_ = bundle;
  frame_ = frame;
  pieces_.clear();
  pieces_.resize(pieces_with_room(*bundle_));
}

void TractPass::draw_piece(const TractDraw& how, std::size_t number) {
  Piece& piece = pieces_[number];
  if (piece.tolerance != how.tolerance) {
    std::vector<std::uint32_t> colors;
    const std::vector<TractPoint> points =
        piece_points(*bundle_, number, frame_, how.tolerance, bundle_->colors.empty() ? nullptr : &colors);
    piece.points = make_buffer(std::span<const TractPoint>(points));
    if (!bundle_->colors.empty()) piece.colors = make_buffer(std::span<const std::uint32_t>(colors));
    piece.vertices = static_cast<int>(2 * points.size());
    piece.tolerance = how.tolerance;
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kPointBuffer, piece.points.name());
  if (piece.colors) glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kColorBuffer, piece.colors.name());
  glDrawArrays(GL_TRIANGLE_STRIP, 0, piece.vertices);
}

std::size_t TractPass::pieces_in(double milliseconds) const noexcept {
  if (!std::isfinite(milliseconds)) return std::max<std::size_t>(1, pieces());
  if (piece_ms_ <= 0.0) return 1;
  return static_cast<std::size_t>(
      std::clamp(milliseconds / piece_ms_, 1.0, static_cast<double>(std::max<std::size_t>(1, pieces()))));
}

std::size_t TractPass::draw(const TractDraw& how, std::size_t first, std::size_t last, double milliseconds,
                            const std::function<bool()>& stop) {
  const Stopwatch watch;
  const bool screened = how.opacity < 1.0F;
  if (how.slab && !(how.slab->half > 0.0)) return last;
  const bool colored = !bundle_->colors.empty();
  GlProgram& program = programs_[(screened ? 1U : 0U) + (how.slab ? 2U : 0U) + (colored ? 4U : 0U)];
  if (!program) {
    std::vector<std::string> defines;
    if (how.slab) defines.emplace_back("SLAB");
    if (colored) defines.emplace_back("COLORED");
    program = compile_program("tract/tract.vert", screened ? "tract/screened.frag" : "tract/tract.frag",
                              shader_files(), defines);
  }
  if (!no_vertices_) no_vertices_ = make_vertex_array();
  glUseProgram(program.name());
  glBindVertexArray(no_vertices_.name());
  glUniform1f(kWidth, how.width);
  glUniform1f(kFading, how.fading);
  glUniform1f(kDimming, how.dimming);
  if (screened) glUniform1f(kOpacity, how.opacity);
  if (how.slab) {
    const Vec3f normal(how.slab->normal);
    const float at = static_cast<float>(glm::dot(how.slab->normal, frame_.scene_from_data(how.slab->place)));
    glUniform4f(kSlab, normal.x, normal.y, normal.z, at);
    glUniform1f(kSlabHalf, static_cast<float>(how.slab->half * power_of_two(-frame_.exponent)));
    glEnable(GL_CLIP_DISTANCE0);
    glEnable(GL_CLIP_DISTANCE1);
  }
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
  // Between two waits half of what there seems to be time for, so that a driver's threads seldom wait for
  // each other.
  std::size_t piece = first;
  const auto stretch = [&](double time) { return stop ? std::min(time, kBetweenQuestions) : time; };
  std::size_t batch = pieces_in(stretch(0.5 * milliseconds));
  while (piece < last) {
    for (const std::size_t end = std::min(piece + batch, last); piece < end; ++piece) {
      if (screened) glUniform1ui(kPiece, static_cast<GLuint>(piece));
      draw_piece(how, piece);
    }
    if (!std::isfinite(milliseconds)) continue;
    // The driver takes calls faster than it draws: without waiting there is nothing to measure.
    glFinish();
    const double spent = 1e3 * watch.seconds();
    piece_ms_ = spent / static_cast<double>(piece - first);
    if (spent + piece_ms_ > milliseconds) break;
    if (stop && stop()) break;
    batch = pieces_in(stretch(0.5 * (milliseconds - spent)));
  }
  glDisable(GL_CLIP_DISTANCE0);
  glDisable(GL_CLIP_DISTANCE1);
  return piece;
}

}  // namespace palpate
