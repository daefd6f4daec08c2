/// Finds out that a line came back to itself, in constant work and storage a step.
///
/// Brent's scheme: an anchor is put on the line after 1, 2, 4, 8, … steps; a line that closes passes the
/// plane through the anchor, normal to the flow there, again within its error. A loop of n steps is found
/// after at most 3 n.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>

#include "common/geometry/line.h"
#include "common/ode/root.h"
#include "common/trace/line_builder.h"

namespace palpate {

class LoopDetector {
 public:
  void start() noexcept { *this = LoopDetector(); }

  /// Looks at one piece. @param direction unit tangent at its end.
  /// @return kLoop where the line has closed; kStagnation where the loop is no larger than the error of the
  /// line, so that it cannot be told from a point.
  [[nodiscard]] std::optional<End> closes(const DensePiece& piece, const LinePoint& begin,
                                          const LinePoint& end, const Vec3& direction) {
    const Vec3 apart = end.position - anchor_;
    const double side = glm::dot(apart, normal_);
    farthest_ = std::max(farthest_, glm::dot(apart, apart));
    const bool crossed = side_ < 0.0 && side >= 0.0;
    if (crossed && near_anchor(piece, begin, end, side)) {
      const double point = kPoint * end.error;
      return farthest_ > point * point ? End::kLoop : End::kStagnation;
    }
    side_ = side;
    if (++steps_ >= next_) {
      next_ = 2 * steps_;
      anchor_ = end.position;
      normal_ = direction;
      side_ = 0.0;
      farthest_ = 0.0;
    }
    return std::nullopt;
  }

 private:
  static constexpr double kPoint = 30.0;  ///< loops of fewer error estimates across are points
  static constexpr double kErrors = 4.0;  ///< how many error estimates apart still count as the same point

  [[nodiscard]] bool near_anchor(const DensePiece& piece, const LinePoint& begin, const LinePoint& end,
                                 double side) const {
    const double reach = (end.arc - begin.arc) + kErrors * end.error;
    if (glm::distance(end.position, anchor_) > 2.0 * reach) return false;
    constexpr double kThetaTolerance = 0x1p-46;
    const double theta =
        bracketed_root([&](double at) { return glm::dot(piece.at(at).position - anchor_, normal_); }, 0.0,
                       1.0, side_, side, kThetaTolerance);
    const LinePoint passing = piece.at(theta);
    return glm::distance(passing.position, anchor_) <= kErrors * passing.error;
  }

  Vec3 anchor_{0.0};
  Vec3 normal_{0.0};
  double side_ = 0.0;
  double farthest_ = 0.0;  ///< square of the largest distance from the anchor since it was put
  std::int64_t steps_ = 0;
  std::int64_t next_ = 1;
};

}  // namespace palpate
