#include "common/render/gl/frame_timer.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include <epoxy/gl.h>

namespace palpate {

double TimerCheck::add(double query, double clock) noexcept {
  agreed_[frames_++ % kFrames] = query >= kLeast * clock && query <= kMost * clock;
  const bool possible = query > 0.0 && query <= kMost * clock;
  return holds() && possible ? query : clock;
}

bool TimerCheck::holds() const noexcept {
  const auto agreed = std::count(agreed_.begin(), agreed_.end(), true);
  return static_cast<double>(agreed) >= kShare * static_cast<double>(kFrames);
}

void FrameTimer::begin() {
  if (!query_) {
    GLuint name = 0;
    glCreateQueries(GL_TIME_ELAPSED, 1, &name);
    query_ = GlQuery(name);
  }
  clock_.restart();
  if (std::exchange(running_, true)) glEndQuery(GL_TIME_ELAPSED);
  glBeginQuery(GL_TIME_ELAPSED, query_.name());
}

void FrameTimer::leave() {
  if (std::exchange(running_, false)) glEndQuery(GL_TIME_ELAPSED);
}

double FrameTimer::finish() {
  const bool timed = std::exchange(running_, false);
  if (timed) glEndQuery(GL_TIME_ELAPSED);
  glFinish();
  const double clock = 1e3 * clock_.seconds();
  if (!timed) return clock;
  constexpr double kNanosecond = 1e-6;  // [ms]
  GLuint64 elapsed = 0;
  glGetQueryObjectui64v(query_.name(), GL_QUERY_RESULT, &elapsed);
  milliseconds_ = check_.add(kNanosecond * static_cast<double>(elapsed), clock);
  return clock;
}

}  // namespace palpate
