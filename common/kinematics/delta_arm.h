/// Delta arms of three legs after Stamper 1997, such as that of the Novint Falcon: each leg is a driven thigh
/// and a parallelogram of two shins, and the platform keeps its orientation.
///
/// Frame D of the device: x right, y up, z out of the device towards the user, origin in the base plane;
/// metres, radians. Leg i lies in the direction phi_i about z, and has a frame of its own:
///
///   u = cos(phi) x + sin(phi) y - r     v = -sin(phi) x + cos(phi) y - s     w = z
///
/// Symbols: a thigh, b shin, c and f offsets of the platform along u and v, e both ends of the shin together,
/// r and s offsets of the base along u and v. theta_1 is the angle of the thigh that the encoder shows,
/// theta_2 that of the parallelogram in the plane of u and w, theta_3 its swing out of it. The loop closes:
///
///   u = a cos(theta_1) + L cos(theta_2) - c        v = b cos(theta_3) - f                               (1)
///   w = a sin(theta_1) + L sin(theta_2)            L = e + b sin(theta_3)
///
/// Differentiated, the thigh turns by   d theta_1 = k . d(u, v, w) / (a sin(theta_3) sin(theta_2 - theta_1)),
/// k = (cos(theta_2) sin(theta_3), cos(theta_3), sin(theta_2) sin(theta_3)).                             (2)
/// With A of these rows, theta' = A p', J = A^-1 = dp/dtheta, and by equal power tau = J^T F.
#pragma once

#include <array>
#include <optional>

#include "common/math/vec.h"

namespace palpate {

/// What a calibration finds. The defaults are published measurements of the Falcon; single devices differ by
/// millimetres.
struct DeltaGeometry {
  double thigh = 0.0600;        ///< a [m]
  double shin = 0.1025;         ///< b [m]
  double shin_ends = 0.0225;    ///< e [m]
  double platform_u = 0.01443;  ///< c [m]
  double platform_v = -0.025;   ///< f [m]
  double base_u = 0.0400;       ///< r [m]
  double base_v = -0.02309;     ///< s [m]
  std::array<double, 3> leg_direction{1.8325957145940461, -0.2617993877991494,
                                      -2.356194490192345};  ///< phi [rad]: 105, -15, -135 degrees

  bool operator==(const DeltaGeometry&) const = default;
  /// Finite, lengths of thigh and shin above zero, the other lengths below a metre.
  [[nodiscard]] bool valid() const noexcept;
};

/// The arm at a position.
struct DeltaPose {
  Vec3 angles{0.0};  ///< theta_1 of each leg [rad]
  Mat3 rates{1.0};   ///< A of (2) [rad/m]
};

struct DeltaForward {
  Vec3 position{0.0};     ///< [m] the last one inside of the workspace where there was no solution
  Mat3 rates{1.0};        ///< A there
  double residual = 0.0;  ///< [rad] largest difference between its angles and those that were asked for
  int iterations = 0;
  bool converged = false;
};

class DeltaArm {
 public:
  static constexpr double kTolerance = 1e-7;  ///< [rad] residual of forward()
  static constexpr int kMostIterations = 10;  ///< of forward()

  /// @pre geometry.valid().
  explicit DeltaArm(const DeltaGeometry& geometry) noexcept;

  /// The arm with its platform at `position`; none where it cannot be, or where a leg is stretched so that
  /// its rate has no bound. @rt Safe.
  [[nodiscard]] std::optional<DeltaPose> at(const Vec3& position) const noexcept;

  /// Where the platform is when the thighs are at `angles`, by Newton's method from `seed`, which lies in
  /// the workspace and near, and on the same side of the base: p <- p + J (angles - theta_1(p)).
  /// Never NaN. @rt Safe.
  [[nodiscard]] DeltaForward forward(const Vec3& angles, const Vec3& seed) const noexcept;

  [[nodiscard]] const DeltaGeometry& geometry() const noexcept { return geometry_; }

 private:
  struct Leg {
    double cosine = 1.0, sine = 0.0;  ///< of phi
  };

  DeltaGeometry geometry_;
  std::array<Leg, 3> legs_{};
};

/// tau of the thighs [N m] that shows `force` [N] on the platform of an arm with these rates.
[[nodiscard]] Vec3 delta_torques(const Mat3& rates, const Vec3& force) noexcept;

}  // namespace palpate
