/// Carries the position error of a line along with it as an ellipse across the flow.
///
///   e' = J e                                                                                    (1)
///
/// is the linearised flow about the line (Hairer, Norsett, Wanner 1993, I.14). One vector e would follow the
/// direction that grew most so far and miss what grows in the other one from here on. So all e within an
/// ellipse of semi-axes a and b are carried: both obey (1), and each step lengthens both by its own local
/// error, whatever its direction and sign, so contributions never cancel. What lies along the flow is taken out
/// each step: it only shifts the point on its curve, and time_shift.h says what that costs.
#pragma once

#include <algorithm>
#include <cmath>

#include "common/math/vec.h"
#include "common/trace/walk/error_transport.h"

namespace palpate {

class ErrorEllipse {
 public:
  /// @param direction unit tangent of the line at its seed.  @param radius the error to begin with.
  void start(const Vec3& direction, double radius) noexcept {
    circle(direction, radius);
    along_ = 0.0;
    shift_.start();
  }

  /// As carry_error() of error_transport.h.
  template <class Apply, class Matrix, class Stepped>
  void advance(const Apply& apply, const Matrix& matrix, const Stepped& stepped, double h) {
    carry_error(a_, apply, matrix, stepped, h);
    carry_error(b_, apply, matrix, stepped, h);
  }

  /// What `map`, linear, makes of every error.
  template <class Map>
  void carry(const Map& map) {
    a_ = within(map(a_), a_);
    b_ = within(map(b_), b_);
  }

  /// Adds a local error of length `size` in any direction across the flow. @param direction unit tangent.
  void add(double size, const Vec3& direction) noexcept {
    const double a_along = glm::dot(a_, direction), b_along = glm::dot(b_, direction);
    along_ += std::sqrt(a_along * a_along + b_along * b_along);
    a_ -= a_along * direction;
    b_ -= b_along * direction;
    double aa = glm::dot(a_, a_), bb = glm::dot(b_, b_);
    const double ab = glm::dot(a_, b_);
    constexpr double kAskew = 0.01;  // square of the cosine between them: half of it is neglected
    if (ab * ab > kAskew * aa * bb) {
      turn_to_axes(aa, bb, ab);
      aa = glm::dot(a_, a_);
      bb = glm::dot(b_, b_);
    }
    if (!(aa > 0.0 && bb > 0.0)) {  // shrunk to nothing
      circle(direction, std::sqrt(std::max(aa, bb)) + size);
      return;
    }
    const double a = std::sqrt(aa), b = std::sqrt(bb);
    a_ *= 1.0 + size / a;
    b_ *= 1.0 + size / b;
    largest_ = std::max(a, b) + size;
  }

  /// The largest from the curve, as ErrorTransport::distance(). @pre `direction` is that of the last add().
  [[nodiscard]] double distance(const Vec3& /*direction*/, double speed, double rate) noexcept {
    shift_.add(along_ / speed, rate);
    along_ = 0.0;
    return largest_ + shift_.distance(speed);
  }

 private:
  /// `moved`, or TimeShift::kFar along what it was where it is farther or no number.
  [[nodiscard]] static Vec3 within(const Vec3& moved, const Vec3& before) noexcept {
    constexpr double kFar = TimeShift::kFar;
    return glm::dot(moved, moved) < kFar * kFar ? moved : before * (kFar / glm::length(before));
  }

  void circle(const Vec3& direction, double radius) noexcept {
    const Vec3 oblique{0.533, -0.717, 0.449};  // to every axis that a field may have
    const Vec3 u = oblique - glm::dot(oblique, direction) * direction;
    const double length = glm::length(u);
    a_ = length > 0.1 ? u * (radius / length) : Vec3{radius, 0.0, 0.0};
    b_ = glm::cross(direction, a_);
    largest_ = radius;
  }

  /// a cos t + b sin t is the same ellipse for any two conjugate semi-diameters; makes them perpendicular,
  /// by the rotation of a 2 x 2 Jacobi sweep.
  void turn_to_axes(double aa, double bb, double ab) noexcept {
    const double theta = (bb - aa) / (2.0 * ab);
    const double tangent = std::copysign(1.0, theta) / (std::abs(theta) + std::sqrt(1.0 + theta * theta));
    const double cosine = 1.0 / std::sqrt(1.0 + tangent * tangent);
    const Vec3 a = a_;
    a_ = cosine * (a - tangent * b_);
    b_ = cosine * (b_ + tangent * a);
  }

  Vec3 a_{0.0};
  Vec3 b_{0.0};
  double largest_ = 0.0;  ///< the longer semi-axis
  double along_ = 0.0;    ///< taken out since the last distance()
  TimeShift shift_;
};

}  // namespace palpate
