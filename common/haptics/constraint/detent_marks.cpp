#include "common/haptics/constraint/detent_marks.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "common/haptics/fade.h"
#include "common/haptics/motion_rule.h"
#include "common/trace/line_time.h"

namespace palpate {

void TickMarks::apply(const ChainSettings& settings) noexcept {
  const LocalFrame& frame = streamline_.field().frame();
  interval_ = settings.ticks.interval * power_of_two(frame.speed_exponent - frame.length_exponent);
  kappa_ = settings.ticks.stiffness;
}

void TickMarks::update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept {
  link.proxy = probe;
  const GrowingLine* line = streamline_.line();
  if (line == nullptr || !(interval_ > 0.0) || line->first() == line->last()) return;
  const double now = time_at(*line, streamline_.piece(), streamline_.arc());
  if (!std::isfinite(now)) return;
  if (line_ != streamline_.catches()) {
    line_ = streamline_.catches();
    mark_ = interval_ * std::round(now / interval_);
  }
  mark_ = interval_ * std::round((mark_ + snap_drag(now - mark_, interval_)) / interval_);
  const TimePlace place = find_time(*line, streamline_.piece(), mark_, budget.iterations);
  link.iterations = place.pieces;
  if (!place.found) return;
  const HermitePiece piece = line->piece(place.piece);
  const Workspace& workspace = streamline_.workspace();
  link.proxy = workspace.workspace_from_local(piece.at(place.arc - line->node(place.piece).arc));
  link.residual = line->gap(place.piece) * workspace.local_scale();
  link.kappa = Vec3{kappa_};
  link.jacobian = Mat3{0.0};  // it sits on its mark
  link.state = HoldState::kHeld;
}

DetentMarks::DetentMarks(std::span<const Vec3> marks, double reach) : count_(marks.size()), reach_(reach) {
  if (marks.empty() || marks.size() > kMost) throw std::length_error("one to 128 detents are possible");
  std::copy(marks.begin(), marks.end(), marks_.begin());
}

void DetentMarks::update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept {
  const auto* const nearest =
      std::min_element(marks_.begin(), marks_.begin() + count_, [&](const Vec3& a, const Vec3& b) {
        return glm::dot(a - probe, a - probe) < glm::dot(b - probe, b - probe);
      });
  link.proxy = *nearest;
  link.kappa = Vec3{notch_hold(glm::distance(*nearest, probe), reach_)};
  link.jacobian = Mat3{0.0};
  link.state = HoldState::kHeld;
}

}  // namespace palpate
