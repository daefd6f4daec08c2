/// Finds out that a line came back to itself, in constant work and storage a step.
///
/// A line is closed where it passes the plane through an earlier point of it, an anchor, normal to the flow
/// there, again within its error. The seed is one anchor: a closed line ends at its first return. The other one
/// is for lines that only run into a closed one: by Brent's scheme it is put on the line after 1, 2, 4, 8, ...
/// steps, and finds a loop of n steps after at most 3 n of it.
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
  /// Where on a piece, and why, the line ends.
  struct Closing {
    double theta = 1.0;
    End why =
        End::kLoop;  ///< kStagnation where the loop is no larger than the line's error: as good as a point
  };

  /// Begins with a line at its seed. @param direction unit tangent there.
  void start(const LinePoint& seed, const Vec3& direction) noexcept {
    *this = LoopDetector();
    seed_.put(seed, direction);
    anchor_ = seed_;
  }

  /// Looks at one piece. @param direction unit tangent at its end.
  [[nodiscard]] std::optional<Closing> closes(const DensePiece& piece, const LinePoint& begin,
                                              const LinePoint& end, const Vec3& direction) {
    if (const auto closing = seed_.passed(piece, begin, end)) return closing;
    if (const auto closing = anchor_.passed(piece, begin, end)) return closing;
    if (++steps_ >= next_) {
      next_ = 2 * steps_;
      anchor_.put(end, direction);
    }
    return std::nullopt;
  }

 private:
  static constexpr double kPoint = 30.0;  ///< loops of fewer error estimates across are points
  static constexpr double kErrors = 4.0;  ///< how many error estimates apart still count as the same point

  class Anchor {
   public:
    void put(const LinePoint& point, const Vec3& normal) noexcept {
      *this = Anchor();
      position_ = point.position;
      error_ = point.error;
      normal_ = normal;
    }

    [[nodiscard]] std::optional<Closing> passed(const DensePiece& piece, const LinePoint& begin,
                                                const LinePoint& end) {
      const Vec3 apart = end.position - position_;
      const double before = side_, away = farthest_;
      side_ = glm::dot(apart, normal_);
      farthest_ = std::max(farthest_, glm::dot(apart, apart));
      if (!(before < 0.0 && side_ >= 0.0)) return std::nullopt;
      const double reach = (end.arc - begin.arc) + kErrors * end.error;
      if (glm::length(apart) > 2.0 * reach) return std::nullopt;
      constexpr double kThetaTolerance = 0x1p-46;
      const double theta =
          bracketed_root([&](double at) { return glm::dot(piece.at(at).position - position_, normal_); }, 0.0,
                         1.0, before, side_, kThetaTolerance);
      const LinePoint passing = piece.at(theta);
      if (glm::distance(passing.position, position_) > kErrors * passing.error) return std::nullopt;
      // A line that rounding has moved back by, and that now goes on its way, was never away.
      const double uncertain = kErrors * error_, point = kPoint * end.error;
      if (!(away > uncertain * uncertain)) return std::nullopt;
      if (!(farthest_ > point * point)) return Closing{theta, End::kStagnation};
      if (!(away > point * point)) return std::nullopt;
      return Closing{theta, End::kLoop};
    }

   private:
    Vec3 position_{0.0};
    Vec3 normal_{0.0};
    double error_ = 0.0;  ///< of the line there
    double side_ = 0.0;
    double farthest_ = 0.0;  ///< square of the largest distance from the anchor since it was put
  };

  Anchor seed_, anchor_;
  std::int64_t steps_ = 0;
  std::int64_t next_ = 1;
};

}  // namespace palpate
