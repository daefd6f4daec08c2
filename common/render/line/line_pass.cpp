#include "common/render/line/line_pass.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include <epoxy/gl.h>
#include <glm/vec4.hpp>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/program.h"
#include "common/render/volume/tile_pass.h"

namespace palpate {
namespace {

// Locations and bindings of shaders/line/.
enum Uniform : GLint {
  kWidth = 0,
  kHaloWidth = 1,
  kMinWidth = 2,
  kHasValues = 3,
  kColoring = 4,
  kLineColor = 5,
  kFading = 6,
  kHaloColor = 7,
  kDimming = 8,
  kLift = 9,
  kLens = 10,
  kClearing = 11
};
constexpr GLuint kTableUnit = 0, kLensTableUnit = 1;

GlProgram compile_lines(bool layers, bool lens) {
  std::vector<std::string> defines;
  if (layers) defines.emplace_back("LAYERS");
  if (lens) defines.emplace_back("LENS");
  GlProgram program = compile_program("line/line.vert", "line/line.frag", shader_files(), defines);
  const std::string name =
      std::string("line/line.frag") + (layers ? ", as layers" : "") + (lens ? ", with a lens" : "");
  label_object(GpuObject::Kind::kProgram, program.name(), name);
  return program;
}

constexpr std::size_t kRunSegments = 512;
constexpr std::size_t kIndices = 6;  // of a segment: two triangles
// How often segments are joined more before lines are left out, and by how much more each time.
constexpr int kMostJoins = 2;
constexpr double kFarther = 4.0;
constexpr std::size_t kMostLevels = 8;  // that are kept

std::vector<std::uint32_t> corners_of(std::span<const LineSegment> segments) {
  std::vector<std::uint32_t> corners;
  corners.reserve(kIndices * segments.size());
  for (const LineSegment& s : segments) {
    const std::uint32_t a = 2 * s.first, b = 2 * s.last;
    corners.insert(corners.end(), {a, a + 1, b, b, a + 1, b + 1});
  }
  return corners;
}

// Whether some of a box may be seen. A tenth of the picture more is looked at: lines have a width, and halos.
bool is_seen(const Mat4& clip, const Vec3& lower, const Vec3& upper) {
  constexpr double kMargin = 1.1;
  std::array<bool, 4> outside{true, true, true, true};
  for (int i = 0; i < 8; ++i) {
    const glm::dvec4 x = clip * glm::dvec4((i & 1) != 0 ? upper.x : lower.x, (i & 2) != 0 ? upper.y : lower.y,
                                           (i & 4) != 0 ? upper.z : lower.z, 1.0);
    if (!(x.w > 0.0)) return true;  // beside the eye
    const double most = kMargin * x.w;
    outside[0] = outside[0] && x.x < -most;
    outside[1] = outside[1] && x.x > most;
    outside[2] = outside[2] && x.y < -most;
    outside[3] = outside[3] && x.y > most;
  }
  return std::none_of(outside.begin(), outside.end(), [](bool all) { return all; });
}

}  // namespace

namespace detail {

void begin_lines(const LineDraw& how, bool has_values) {
  const bool transparent = how.transparent();
  const Rgb rim = how.halo_color.value_or(Rgb{0.0F});
  glUniform1f(kWidth, how.width);
  glUniform1f(kHaloWidth, transparent ? 0.0F : how.halo_width);
  glUniform1f(kMinWidth, how.min_width);
  glUniform1i(kHasValues, has_values ? 1 : 0);
  glUniform1i(kColoring, static_cast<GLint>(how.coloring));
  glUniform4f(kLineColor, how.color.r, how.color.g, how.color.b, how.opacity);
  glUniform1f(kFading, how.fading);
  glUniform1f(kDimming, how.dimming);
  glUniform1f(kLift, how.lift);
  glUniform1f(kClearing, has_values ? how.clearing : 0.0F);
  glUniform4f(kHaloColor, rim.r, rim.g, rim.b, how.halo_color ? 1.0F : 0.0F);

  glEnable(GL_DEPTH_TEST);
  glDepthFunc(how.hidden_part ? GL_GREATER : GL_LEQUAL);
  glDepthMask(transparent ? GL_FALSE : GL_TRUE);
  if (transparent) {
    glEnable(GL_BLEND);
    glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
  } else {
    glDisable(GL_BLEND);
  }
}

void end_lines() {
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

}  // namespace detail

void LineProgram::use(ColorMap map, std::optional<ColorMap> lens_map) {
  const bool lens = lens_map.has_value();
  GlProgram& program = programs_[lens ? 1 : 0];
  if (!program) program = compile_lines(into_ == Into::kLayers, lens);
  glUseProgram(program.name());
  tables_.bind_linear(map, kTableUnit);
  tables_.bind_linear(lens_map.value_or(map), kLensTableUnit);
}

void LineSet::set_geometry(LineGeometry geometry) {
  geometry_ = std::move(geometry);
  coordinates_.clear();
  levels_.clear();
  sorting_.reset();
  if (!vertex_array_) vertex_array_ = make_vertex_array();
  points_ = make_buffer(std::span<const LineVertex>(geometry_.vertices));
  values_ = make_buffer(std::span<const float>());
  set_lens_values({});
}

void LineSet::set_values(std::vector<float> coordinates) {
  PALPATE_CHECK(coordinates.size() == geometry_.vertices.size());
  coordinates_ = std::move(coordinates);
  levels_.clear();
  sorting_.reset();
  values_ = make_buffer(std::span<const float>(coordinates_));
}

void LineSet::set_lens_values(std::span<const float> coordinates) {
  PALPATE_CHECK(coordinates.empty() || coordinates.size() == geometry_.vertices.size());
  has_lens_values_ = !coordinates.empty();
  lens_values_ = make_buffer(coordinates);
}

const LineSet::Level& LineSet::keep(const Detail& detail, std::vector<LineSegment> segments) {
  Level made{.detail = detail, .segments = std::move(segments)};
  for (std::size_t first = 0; first < made.segments.size(); first += kRunSegments) {
    Run run{.first = first, .last = std::min(first + kRunSegments, made.segments.size())};
    run.lower = run.upper = geometry_.vertices[made.segments[first].first].position;
    for (std::size_t i = run.first; i < run.last; ++i) {
      for (const std::uint32_t vertex : {made.segments[i].first, made.segments[i].last}) {
        run.lower = glm::min(run.lower, geometry_.vertices[vertex].position);
        run.upper = glm::max(run.upper, geometry_.vertices[vertex].position);
      }
    }
    made.runs.push_back(run);
  }
  made.indices = make_buffer(std::span<const std::uint32_t>(corners_of(made.segments)));
  levels_.push_front(std::move(made));
  if (levels_.size() > kMostLevels) levels_.pop_back();
  return levels_.front();
}

const LineSet::Level& LineSet::level(const Detail& wanted) {
  const auto found =
      std::find_if(levels_.begin(), levels_.end(), [&](const Level& l) { return l.detail == wanted; });
  if (found != levels_.end()) {
    levels_.splice(levels_.begin(), levels_, found);
    return levels_.front();
  }
  if (wanted.share < 1.0) {
    const Level& all = level({wanted.tolerance, wanted.joined});
    return keep(wanted, sample_lines(all.segments, wanted.share));
  }
  if (wanted.joined == 0) return keep(wanted, simplify(geometry_, coordinates_, wanted.tolerance));
  // An arc whose middle is farther from its chord by a factor turns by the root of that.
  const LineTolerance usual{.distance = wanted.tolerance};
  const double farther = std::pow(kFarther, wanted.joined);
  const double turn = std::sqrt(farther) * std::acos(static_cast<double>(usual.cosine));
  const LineTolerance tolerance{.distance = (1.0 - 1.0 / kFarther) * farther * wanted.tolerance,
                                .cosine = static_cast<float>(std::cos(turn)),
                                .coordinate = static_cast<float>(std::sqrt(farther)) * usual.coordinate};
  const Level& finer = level({wanted.tolerance, wanted.joined - 1});
  return keep(wanted, join_segments(geometry_.vertices, finer.segments, coordinates_, tolerance));
}

const LineSet::Level& LineSet::level(const LineDraw& how) {
  // Points are left out by the first values alone: with others all are there.
  Detail detail{.tolerance = has_lens_values_ ? 0.0 : how.tolerance};
  const double most = how.detail * static_cast<double>(level(detail).segments.size());
  const auto count = [&] { return static_cast<double>(level(detail).segments.size()); };
  if (has_lens_values_) detail.joined = 0;
  while (!has_lens_values_ && detail.joined < kMostJoins && count() > most) ++detail.joined;
  if (count() > most) detail.share = most / count();
  return level(detail);
}

void LineSet::draw_sorted(const Level& level, const Vec3f& along) {
  const Sorting wanted{level.detail, along};
  if (sorting_ != wanted) {
    std::vector<LineSegment> sorted = level.segments;
    sort_back_to_front(sorted, geometry_.vertices, along);
    sorted_ = make_buffer(std::span<const std::uint32_t>(corners_of(sorted)));
    sorting_ = wanted;
  }
  glVertexArrayElementBuffer(vertex_array_.name(), sorted_.name());
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(kIndices * level.segments.size()), GL_UNSIGNED_INT,
                 nullptr);
}

void LineSet::draw_seen(const Level& level, const LineDraw& how) {
  const double reach = static_cast<double>((0.5F * how.width + how.halo_width) * how.pixel);
  std::vector<Run> seen;  // neighbours as one
  for (const Run& run : level.runs) {
    if (how.clip_from_scene &&
        !is_seen(*how.clip_from_scene, Vec3(run.lower) - reach, Vec3(run.upper) + reach))
      continue;
    if (!seen.empty() && seen.back().last == run.first) {
      seen.back().last = run.last;
    } else {
      seen.push_back(run);
    }
  }
  const auto draw = [](std::size_t first, std::size_t last) {
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(kIndices * (last - first)), GL_UNSIGNED_INT,
                   reinterpret_cast<const void*>(kIndices * sizeof(std::uint32_t) * first));
  };
  if (how.stop == nullptr) {
    for (const Run& run : seen) draw(run.first, run.last);
    return;
  }
  // The driver takes calls faster than it draws: it is waited for before each question.
  constexpr double kBetweenQuestions = 20.0;  // [ms]
  constexpr std::size_t kFirst = 4096, kSlowest = 256;
  std::size_t batch = kFirst;
  for (const Run& run : seen) {
    for (std::size_t first = run.first; first < run.last;) {
      const std::size_t last = std::min(first + batch, run.last);
      const Stopwatch watch;
      draw(first, last);
      glFinish();
      const double spent = 1e3 * watch.seconds();
      if ((*how.stop)()) throw DrawingStopped();
      const double next = static_cast<double>(last - first) *
                          std::clamp(kBetweenQuestions / std::max(spent, 1e-3), 0.25, 4.0);
      batch = std::max(kSlowest, static_cast<std::size_t>(next));
      first = last;
    }
  }
}

void LineSet::draw(const LineDraw& how) {
  if (geometry_.segments.empty()) return;
  const Level& drawn = level(how);
  detail::begin_lines(how, !coordinates_.empty());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLinePoints, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineValues, values_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineLensValues, lens_values_.name());
  glUniform4f(kLens, how.lens_center.x, how.lens_center.y, how.lens_center.z,
              has_lens_values_ ? how.lens_radius : 0.0F);
  glBindVertexArray(vertex_array_.name());
  // What shines through is too faint for its order to matter, what is seen again has its depths: neither is sorted.
  if (how.transparent() && !how.hidden_part && !how.seen_again) {
    draw_sorted(drawn, how.back);
  } else {
    glVertexArrayElementBuffer(vertex_array_.name(), drawn.indices.name());
    draw_seen(drawn, how);
  }
  glUniform4f(kLens, 0.0F, 0.0F, 0.0F, 0.0F);  // trails have none
  detail::end_lines();
}

}  // namespace palpate
