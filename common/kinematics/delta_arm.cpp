#include "common/kinematics/delta_arm.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {
namespace {

/// The rate of a leg has no bound where its thigh and shin are in line, or its shin lies along v.
constexpr double kLeastSine = 1e-3;
/// [m] A longer step of Newton's method is shortened: it would leave the workspace.
constexpr double kLongestStep = 0.03;
/// Below this part of its terms the determinant of A is rounding.
constexpr double kLeastDeterminant = 1e-9;

double largest(const Vec3& x) noexcept { return std::max({std::abs(x.x), std::abs(x.y), std::abs(x.z)}); }

/// Whether the rows of A are independent enough to be inverted.
bool regular(const Mat3& rates) noexcept {
  const Mat3 rows = glm::transpose(rates);
  const double volume = std::abs(glm::determinant(rates));
  return volume > kLeastDeterminant * glm::length(rows[0]) * glm::length(rows[1]) * glm::length(rows[2]);
}

}  // namespace

bool DeltaGeometry::valid() const noexcept {
  constexpr double kLargest = 1.0;  // [m]
  const auto length = [](double x) { return std::isfinite(x) && x > 0.0 && x < kLargest; };
  const auto offset = [](double x) { return std::isfinite(x) && std::abs(x) < kLargest; };
  const auto angle = [](double x) { return std::isfinite(x); };
  return length(thigh) && length(shin) && offset(shin_ends) && shin_ends >= 0.0 && offset(platform_u) &&
         offset(platform_v) && offset(base_u) && offset(base_v) &&
         std::all_of(leg_direction.begin(), leg_direction.end(), angle);
}

DeltaArm::DeltaArm(const DeltaGeometry& geometry) noexcept : geometry_(geometry) {
  for (std::size_t i = 0; i < 3; ++i) {
    legs_[i] = {std::cos(geometry.leg_direction[i]), std::sin(geometry.leg_direction[i])};
  }
}

std::optional<DeltaPose> DeltaArm::at(const Vec3& position) const noexcept {
  if (!is_finite(position)) return std::nullopt;
  const DeltaGeometry& g = geometry_;
  DeltaPose pose;
  for (int i = 0; i < 3; ++i) {
    const Leg& leg = legs_[as_size(i)];
    const double u = leg.cosine * position.x + leg.sine * position.y - g.base_u;
    const double v = -leg.sine * position.x + leg.cosine * position.y - g.base_v;
    const double w = position.z;

    // The shin swings out of its plane by as much as v asks for: cos(theta_3).
    const double swing = (v + g.platform_v) / g.shin;
    if (!(std::abs(swing) < 1.0)) return std::nullopt;
    const double sine3 = std::sqrt((1.0 - swing) * (1.0 + swing));
    const double length = g.shin_ends + g.shin * sine3;

    // Thigh and shin reach the platform's joint in the plane of u and w: with t = tan(theta_1 / 2),
    // q2 t^2 + q1 t + q0 = 0, of which the smaller root is the thigh that points outwards.
    const double across = u + g.platform_u;
    const double q0 = w * w + (across - g.thigh - length) * (across - g.thigh + length);
    const double q1 = -4.0 * g.thigh * w;
    const double q2 = w * w + (across + g.thigh - length) * (across + g.thigh + length);
    const double discriminant = q1 * q1 - 4.0 * q0 * q2;
    if (!(discriminant >= 0.0)) return std::nullopt;
    // As an angle of the two numbers the root is defined where q2 vanishes, too.
    const double angle = 2.0 * std::atan2(-q1 - std::sqrt(discriminant), 2.0 * q2);

    // (1): the shin's direction is what is left.
    const double cosine1 = std::cos(angle), sine1 = std::sin(angle);
    const double cosine2 = (across - g.thigh * cosine1) / length;
    const double sine2 = (w - g.thigh * sine1) / length;
    const double between = sine2 * cosine1 - cosine2 * sine1;  // sin(theta_2 - theta_1)
    if (!(std::abs(between) > kLeastSine) || !(sine3 > kLeastSine)) return std::nullopt;
    pose.angles[i] = angle > M_PI ? angle - 2.0 * M_PI : angle < -M_PI ? angle + 2.0 * M_PI : angle;

    // (2), with u and v turned back into the frame of the device.
    const Vec3 k = Vec3{cosine2 * sine3, swing, sine2 * sine3} / (g.thigh * sine3 * between);
    pose.rates[0][i] = leg.cosine * k.x - leg.sine * k.y;
    pose.rates[1][i] = leg.sine * k.x + leg.cosine * k.y;
    pose.rates[2][i] = k.z;
  }
  if (!regular(pose.rates)) return std::nullopt;
  return pose;
}

DeltaForward DeltaArm::forward(const Vec3& angles, const Vec3& seed) const noexcept {
  DeltaForward out{.position = is_finite(seed) ? seed : Vec3{0.0}};
  if (!is_finite(angles)) return out;
  Vec3 step{0.0};
  for (out.iterations = 0; out.iterations <= kMostIterations; ++out.iterations) {
    std::optional<DeltaPose> pose = at(out.position + step);
    // A step out of the workspace is halved until it stays inside: the way to the solution leads through it.
    for (int halved = 0; !pose && halved < kMostIterations; ++halved) {
      step *= 0.5;
      pose = at(out.position + step);
    }
    if (!pose) return out;
    out.position += step;
    out.rates = pose->rates;
    const Vec3 missing = angles - pose->angles;
    out.residual = largest(missing);
    if (out.residual <= kTolerance) {
      out.converged = true;
      return out;
    }
    step = glm::inverse(pose->rates) * missing;
    if (const double length = glm::length(step); length > kLongestStep) step *= kLongestStep / length;
  }
  out.iterations = kMostIterations;
  return out;
}

Vec3 delta_torques(const Mat3& rates, const Vec3& force) noexcept {
  return glm::inverse(glm::transpose(rates)) * force;
}

}  // namespace palpate
