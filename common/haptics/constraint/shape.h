/// A shape of the workspace that holds a probe which comes near it: spheres, circles, segments and polylines,
/// of which widgets are made (Ikits 2006, sec. 6.6 and 8.6).
///
/// The proxy is the point of the shape nearest to the probe. Free motion and being held are two states: the
/// probe is caught within the snap distance, and let go where it is stretched beyond the release distance, so
/// that a hand at the edge does not flicker between the two.
#pragma once

#include <vector>

#include "common/haptics/constraint.h"

namespace palpate {

/// The point of a shape nearest to a probe.
struct Foot {
  Vec3 point{0.0};      ///< [m]
  Mat3 axes{1.0};       ///< of the link, orthonormal
  Vec3 kappa{1.0};      ///< along them; below 1 next to where the nearest point leaps
  Mat3 jacobian{0.0};   ///< d point / d probe
  int iterations = 0;   ///< used
  bool certain = true;  ///< false: the budget ended the search, at a point of the shape all the same
};

class ShapeConstraint : public Constraint {
 public:
  void apply(const ChainSettings& settings) noexcept final { settings_ = settings.shape; }
  void reset() noexcept final;
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept final;

 private:
  /// The nearest point of all, for a probe that is free. False while a search goes on over several updates.
  [[nodiscard]] virtual bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept = 0;
  /// The nearest point next to where the proxy was.
  virtual void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept = 0;
  /// The probe is free again.
  virtual void forget() noexcept {}

  ShapeSettings settings_;
  bool held_ = false;
};

/// A circle.
///
///   p = c + R u,   u = d / |d|,   d = (x - c) - ((x - c) . n) n,   J = (R / |d|) t t^T,   t = n x u      (1)
///
/// On the axis u has no direction: next to it the stiffness along u fades, over the inner quarter of the
/// radius, and the direction of the last step is kept where there is none. The pull along n stays.
class CircleConstraint final : public ShapeConstraint {
 public:
  /// @param center c [m]  @param normal n, of any length but zero  @param radius R [m], > 0 and finite.
  CircleConstraint(const Vec3& center, const Vec3& normal, double radius);

 private:
  bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 center_, normal_;
  double radius_;
  Vec3 outward_;  ///< u of the last step
};

/// The surface of a sphere.
///
///   p = c + R n,   n = (x - c) / |x - c|,   J = (R / |x - c|) (1 - n n^T)                               (1)
///
/// At the centre n has no direction, and next to it p leaps to the other side: there kappa fades, over the
/// inner quarter of the radius, and the direction of the last step is kept where there is none. The pull
/// depends on |x - c| alone, so it stays conservative.
class SphereConstraint final : public ShapeConstraint {
 public:
  /// @param center c [m]  @param radius R [m], > 0 and finite.
  SphereConstraint(const Vec3& center, double radius) : center_(center), radius_(radius) {}

 private:
  bool catch_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 center_;
  double radius_;
  Vec3 normal_{1.0, 0.0, 0.0};  ///< n of the last step
};

/// Segments and polylines.
///
/// On a segment from a to b the nearest point a + t (b - a), 0 <= t <= 1, moves no farther than the probe,
/// and the force is continuous everywhere. On a polyline the proxy goes from segment to neighbouring segment
/// as long as that brings it nearer: round a bend it changes over where both are equally near, as a hand that
/// follows the line expects, and it never leaps to another loop that happens to come nearer. A probe that is
/// free is caught by the nearest segment of all.
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
