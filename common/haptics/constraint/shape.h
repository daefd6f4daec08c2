/// A shape of the workspace that holds a probe which comes near it: planes, spheres, circles, segments and polylines,
/// of which widgets and virtual fixtures are made (Ikits 2006, sec. 2.3.3, 6.6 and 8.6).
///
/// The proxy is the point of the shape nearest to the probe. Free motion and being held are two states: the
/// probe is caught within the snap distance, and let go where it is stretched beyond the release distance, so
/// that a hand at the edge does not flicker between the two.
///
/// Along a curve a hand can be carried (passive playback, sec. 2.3.3): a place g goes along it at a speed v, and takes
/// the hand with it by a spring of its own along the tangent t, whose force is bounded by F,
///
///   s_g += v dt,   |s_g - s_x| <= min(F / k, r / 2),   f = k ((g - x) . t) t,   |f| <= F             (c)
///
/// with s_x the arc of the hand's own foot and r the release distance: g waits for a hand that holds back, and is
/// pushed on by one that runs ahead. Across the curve the hand is held as ever. At the end of a curve g stays; on a
/// joined one it goes round.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/box_tree.h"
#include "common/haptics/constraint.h"
#include "common/haptics/constraint/touched_surface.h"

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

/// A place on a curve.
struct CurvePlace {
  double arc = 0.0;     ///< from its beginning [m]
  double length = 0.0;  ///< of the curve [m]
  bool closed = false;  ///< its end is its beginning
};

class ShapeConstraint : public Constraint, public TouchedSurface {
 public:
  void apply(const ChainSettings& settings) noexcept final;
  void reset() noexcept final;
  void advance(double seconds) noexcept final { passed_ += seconds; }
  void update(const Vec3& probe, const UpdateBudget& budget, LinkUpdate& link) noexcept final;
  /// Of a surface: how the probe presses on it. The normal is that of a plane or sphere.
  [[nodiscard]] SurfaceContact contact() const noexcept final { return contact_; }

 private:
  /// The nearest point of all within `reach` [m], for a probe that is free. False where there is none.
  [[nodiscard]] virtual bool catch_foot(const Vec3& probe, double reach, int iterations,
                                        Foot& foot) noexcept = 0;
  /// The nearest point next to where the proxy was.
  virtual void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept = 0;
  /// Where the foot of the last search is on a curve; none: it is on a surface.
  [[nodiscard]] virtual std::optional<CurvePlace> place() const noexcept { return std::nullopt; }
  /// The point of that curve at an arc, its tangent first of the axes. @pre place().
  virtual void stand_at_arc(double /*arc*/, Foot& /*foot*/) const noexcept {}
  void carry(const Vec3& probe, const CurvePlace& hand, LinkUpdate& link) noexcept;

  ShapeSettings settings_;
  CarrySettings carry_;
  double stiffness_ = 0.0;  ///< [N/m]
  double passed_ = 0.0;     ///< [s] since the last update
  SurfaceContact contact_;
  std::optional<double> carried_;  ///< s_g [m]; none: it is not carried
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
  bool catch_foot(const Vec3& probe, double reach, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  [[nodiscard]] std::optional<CurvePlace> place() const noexcept override;
  void stand_at_arc(double arc, Foot& foot) const noexcept override;

  Vec3 center_, normal_;
  double radius_;
  Vec3 start_;    ///< u where arcs begin
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
  bool catch_foot(const Vec3& probe, double reach, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 center_;
  double radius_;
  Vec3 normal_{1.0, 0.0, 0.0};  ///< n of the last step
};

/// A plane, from both sides.
///
///   p = x - ((x - o) . n) n,   J = 1 - n n^T                                                            (1)
class PlaneConstraint final : public ShapeConstraint {
 public:
  /// @param point o on the plane [m]  @param normal n, of any length but zero
  PlaneConstraint(const Vec3& point, const Vec3& normal);

 private:
  bool catch_foot(const Vec3& probe, double reach, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;

  Vec3 point_;
  Mat3 axes_;  ///< n first
};

/// Segments and polylines, one or many.
///
/// On a segment from a to b the nearest point a + t (b - a), 0 <= t <= 1, moves no farther than the probe,
/// and the force is continuous everywhere. On a polyline the proxy goes from segment to neighbouring segment
/// as long as that brings it nearer: round a bend it changes over where both are equally near, as a hand that
/// follows the line expects, and it never leaps to another loop, or line, that happens to come nearer. A probe that is
/// free is caught by the nearest segment of all, which a tree of boxes finds; where the budget ends that search,
/// by the nearest of those that were looked at.
class PolylineConstraint final : public ShapeConstraint {
 public:
  enum class Ends : std::uint8_t {
    kStop,   ///< the proxy stops there, of a closed line too, which repeats its first vertex
    kJoined  ///< of a closed line it goes on
  };

  /// @param lines vertices each [m], finite. Of lines with fewer than two that differ nothing is felt; @pre one line
  /// has two.
  PolylineConstraint(std::span<const std::vector<Vec3>> lines, Ends ends);
  explicit PolylineConstraint(const std::vector<Vec3>& line)
      : PolylineConstraint(std::span<const std::vector<Vec3>>(&line, 1), Ends::kStop) {}
  /// A segment.
  PolylineConstraint(const Vec3& a, const Vec3& b) : PolylineConstraint(std::vector<Vec3>{a, b}) {}

 private:
  using Index = std::uint32_t;
  static constexpr Index kEnd = 0xffff'ffffU;

  struct Line {
    Index first, end;  ///< its segments
    double length;     ///< [m]
    bool joined;
  };
  struct Segment {
    Vec3 a, b;
    double arc;  ///< of a from the beginning of its line [m]
    Index line;
  };

  bool catch_foot(const Vec3& probe, double reach, int iterations, Foot& foot) noexcept override;
  void follow_foot(const Vec3& probe, int iterations, Foot& foot) noexcept override;
  [[nodiscard]] std::optional<CurvePlace> place() const noexcept override;
  void stand_at_arc(double arc, Foot& foot) const noexcept override;

  [[nodiscard]] double part_of(Index segment, const Vec3& probe) const noexcept;
  [[nodiscard]] Vec3 point(Index segment, double t) const noexcept;
  [[nodiscard]] double distance(Index segment, const Vec3& probe) const noexcept;
  /// The one after or before it, kEnd where its line ends.
  [[nodiscard]] Index neighbour(Index segment, bool after) const noexcept;
  void stand_at(double t, Foot& foot) noexcept;

  std::vector<Segment> segments_;
  std::vector<Line> lines_;
  BoxTree tree_;
  Index segment_ = 0;  ///< that the proxy is on
  double part_ = 0.0;  ///< of it, from 0 to 1
};

}  // namespace palpate
