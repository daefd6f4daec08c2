/// Segments and polylines.
///
/// On a segment from a to b the nearest point a + t (b - a), 0 <= t <= 1, moves no farther than the probe,
/// and the force is continuous everywhere. On a polyline the proxy goes from segment to neighbouring segment
/// as long as that brings it nearer: round a bend it changes over where both are equally near, as a hand that
/// follows the line expects, and it never leaps to another loop that happens to come nearer. A probe that is
/// free is caught by the nearest segment of all.
#pragma once

#include <vector>

#include "common/haptics/constraint/shape.h"

namespace palpate {

class PolylineConstraint final : public ShapeConstraint {
 public:
  /// @param vertices [m], finite, at least two that differ; a closed line repeats the first one, where its
  /// proxy stops.
  explicit PolylineConstraint(std::vector<Vec3> vertices);
  /// A segment.
  PolylineConstraint(const Vec3& a, const Vec3& b) : PolylineConstraint(std::vector<Vec3>{a, b}) {}

 private:
  using Index = std::size_t;

  bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void forget() noexcept override { next_ = 0; }

  [[nodiscard]] double place(Index segment, const Vec3& probe) const noexcept;
  [[nodiscard]] Vec3 point(Index segment, double t) const noexcept;
  [[nodiscard]] double distance(Index segment, const Vec3& probe) const noexcept;
  void stand_at(double t, Foot& foot) const noexcept;

  std::vector<Vec3> vertices_;
  Index segment_ = 0;     ///< that the proxy is on, or the nearest so far
  Index next_ = 0;        ///< the search for the nearest segment goes on here
  double nearest_ = 0.0;  ///< distance of segment_ in that search
};

}  // namespace palpate
