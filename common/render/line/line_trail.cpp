#include "common/render/line/line_trail.h"

#include <algorithm>
#include <span>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/line/line_geometry.h"
#include "common/render/line/line_values.h"

namespace palpate {
namespace {

// The piece of the path that point i lies in, as the half-open range of its points.
struct Piece {
  std::size_t begin = 0, end = 0;
};

template <class Visit>
void for_each_piece(const ProbePath& path, std::size_t count, const Visit& visit) {
  const auto starts = path.pieces();
  for (std::size_t k = 0; k < starts.size() && starts[k] < count; ++k) {
    visit(Piece{starts[k], k + 1 < starts.size() ? std::min(starts[k + 1], count) : count});
  }
}

// A copy of the first `used` bytes in a buffer that has room for more.
GlBuffer grown(const GlBuffer& old, std::size_t used, std::size_t bytes) {
  GLuint name = 0;
  glCreateBuffers(1, &name);
  GlBuffer buffer(name);
  glNamedBufferStorage(name, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  if (used > 0) glCopyNamedBufferSubData(old.name(), name, 0, 0, static_cast<GLsizeiptr>(used));
  return buffer;
}

template <class T>
void upload(const GlBuffer& buffer, std::size_t first, std::span<const T> values) {
  glNamedBufferSubData(buffer.name(), static_cast<GLintptr>(first * sizeof(T)),
                       static_cast<GLsizeiptr>(values.size_bytes()), values.data());
}

}  // namespace

void LineTrail::reserve(std::size_t count) {
  constexpr std::size_t kFirstRoom = 1024;
  if (count <= capacity_) return;
  const std::size_t room = std::max({count, 2 * capacity_, kFirstRoom});
  points_ = grown(points_, size_ * sizeof(LineVertex), room * sizeof(LineVertex));
  values_ = grown(values_, size_ * sizeof(float), room * sizeof(float));
  capacity_ = room;
}

bool LineTrail::extend(const std::shared_ptr<const ProbePath>& path, std::size_t count,
                       const SceneFrame& frame, const ValueRange& range) {
  count = path ? std::min(count, path->size()) : 0;
  const bool anew = path != path_ || frame.center != frame_.center || frame.exponent != frame_.exponent ||
                    range != range_ || count < size_;
  if (anew) {
    path_ = path;
    frame_ = frame;
    range_ = range;
    size_ = 0;
    above_range_ = false;
  }
  if (count == size_) return anew;
  reserve(count);
  if (!vertex_array_) vertex_array_ = make_vertex_array();

  // From the last point that is there: its direction changes with the next one.
  const std::size_t from = settled();
  for_each_piece(*path, count, [&](const Piece& piece) {
    if (piece.end <= from) return;
    const std::size_t first = std::max(piece.begin, from);
    // The point before gives the direction at `first`.
    const std::size_t context = first > piece.begin ? first - 1 : first;
    const auto positions = path->positions().subspan(context, piece.end - context);
    const LineGeometry geometry = make_line_geometry({{positions.begin(), positions.end()}}, frame);
    upload(points_, first, std::span<const LineVertex>(geometry.vertices).subspan(first - context));
  });
  const auto forces = path->forces().subspan(from, count - from);
  const std::vector<float> places = map_coordinates({forces.begin(), forces.end()}, LineStyle{}, range);
  upload(values_, from, std::span<const float>(places));
  above_range_ = above_range_ ||
                 std::any_of(forces.begin(), forces.end(), [&](double force) { return force > range.upper; });
  size_ = count;
  return anew;
}

void LineTrail::draw(const LineDraw& how, std::size_t first, std::size_t last) const {
  if (size_ == 0 || first >= last) return;
  PALPATE_CHECK(last < size_);
  std::vector<GLint> starts;
  std::vector<GLsizei> counts;
  for_each_piece(*path_, size_, [&](const Piece& piece) {
    const std::size_t a = std::max(piece.begin, first), b = std::min(piece.end, last + 1);
    if (b < a + 2) return;
    // Each point gives two vertices; those of a strip are the corners of the ribbon in turn.
    starts.push_back(static_cast<GLint>(2 * a));
    counts.push_back(static_cast<GLsizei>(2 * (b - a)));
  });
  if (starts.empty()) return;
  detail::begin_lines(how, true);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLinePoints, points_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, detail::kLineValues, values_.name());
  glBindVertexArray(vertex_array_.name());
  glMultiDrawArrays(GL_TRIANGLE_STRIP, starts.data(), counts.data(), static_cast<GLsizei>(starts.size()));
  detail::end_lines();
}

}  // namespace palpate
