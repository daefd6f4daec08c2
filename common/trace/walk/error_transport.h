/// Carries the position error of a line along with it.
///
///   e' = J e                                                                                    (1)
///
/// is the linearised flow about the line (Hairer, Norsett, Wanner 1993, I.14). Where the flow is stiff a step does to an
/// error what it does to any neighbour, R(hJ) e with the method's stability function R, and contracts less than the flow:
/// the larger of both counts. Each step adds its own local error to the length of e, whatever its sign, in the
/// direction that e has by then, so contributions never cancel. What lies along the flow only shifts the point on its curve; time_shift.h says what that costs.
#pragma once

#include <cmath>

#include "common/math/vec.h"
#include "common/ode/explicit_step.h"
#include "common/ode/linear_step.h"
#include "common/trace/walk/time_shift.h"

namespace palpate {

/// Advances `e` by (1) over `h` with the Jacobian J held: two terms of its exponential, or all of it where J
/// is stiff. `apply(d)` is J d, `matrix()` is J, `stepped(J, e)` is R(hJ) e.
template <class Apply, class Matrix, class Stepped>
void carry_error(Vec3& e, const Apply& apply, const Matrix& matrix, const Stepped& stepped, double h) {
  const Vec3 first = h * apply(e);
  const double change = glm::dot(first, first), size = glm::dot(e, e);
  constexpr double kSmall = 0.01, kStiff = 0.25;  // squares of |h J e| / |e|
  if (change > kStiff * size) {
    const Mat3 jacobian = matrix();
    const Vec3 flown = linear_growth(jacobian, h) * e, kept = stepped(jacobian, e);
    const Vec3 moved = glm::dot(kept, kept) > glm::dot(flown, flown) ? kept : flown;
    constexpr double kFar = TimeShift::kFar;
    e = glm::dot(moved, moved) < kFar * kFar ? moved : e * (kFar / std::sqrt(size));
  } else if (change > kSmall * size) {
    e += first + (0.5 * h) * apply(first);
  } else {
    e += first;
  }
}

/// R(h j) e of an explicit method: its step of x' = j x from e.
template <class Tableau>
[[nodiscard]] Vec3 stability_step(const Mat3& j, const Vec3& e, double h) {
  ExplicitStep<Tableau, Vec3> step;
  step.run([&](double, const Vec3& x) { return j * x; }, 0.0, e, h);
  return step.end;
}

class ErrorTransport {
 public:
  /// @param direction unit tangent of the line at its seed.  @param rounding the error to begin with.
  void start(const Vec3& direction, double rounding) noexcept {
    // A direction oblique to every axis that a field may have, so that no growth is missed by symmetry.
    const Vec3 oblique{0.533, -0.717, 0.449};
    e_ = oblique - glm::dot(oblique, direction) * direction;
    const double length = glm::length(e_);
    e_ = length > 0.1 ? e_ * (rounding / length) : Vec3{rounding, 0.0, 0.0};
    shift_.start();
  }

  [[nodiscard]] const Vec3& vector() const noexcept { return e_; }
  void set(const Vec3& e) noexcept { e_ = e; }

  /// As carry_error().
  template <class Apply, class Matrix, class Stepped>
  void advance(const Apply& apply, const Matrix& matrix, const Stepped& stepped, double h) {
    carry_error(e_, apply, matrix, stepped, h);
  }

  /// Adds a local error of size `size`.
  void add(double size) noexcept {
    const double length = glm::length(e_);
    if (length > 0.0) {
      e_ *= 1.0 + size / length;
    } else {
      e_ = Vec3{size, 0.0, 0.0};
    }
  }

  /// From the curve. @param direction unit tangent.  @param rate |J direction|, in the unit of time of `speed`.
  [[nodiscard]] double distance(const Vec3& direction, double speed, double rate) noexcept {
    const double along = glm::dot(e_, direction);
    shift_.set(std::abs(along) / speed, rate);
    return glm::length(e_ - along * direction) + shift_.distance(speed);
  }

 private:
  Vec3 e_{0.0};
  TimeShift shift_;
};

/// The same across the flow alone: what comes to lie along it is taken out each step. So a local error is never added to
/// what counts for nothing, as it would be where the flow contracts all that lies across.
class ErrorAcross {
 public:
  void start(const Vec3& direction, double rounding) noexcept {
    e_.start(direction, rounding);
    along_ = 0.0;
    shift_.start();
  }

  template <class Apply, class Matrix, class Stepped>
  void advance(const Apply& apply, const Matrix& matrix, const Stepped& stepped, double h) {
    e_.advance(apply, matrix, stepped, h);
  }

  /// What `map`, linear, makes of an error.
  template <class Map>
  void carry(const Map& map) {
    e_.set(map(e_.vector()));
  }

  /// Adds a local error of size `size`. @param direction unit tangent.
  void add(double size, const Vec3& direction) noexcept {
    const double along = glm::dot(e_.vector(), direction);
    along_ += std::abs(along);
    const Vec3 across = e_.vector() - along * direction;
    const double length = glm::length(across);
    if (length > 0.0) {
      e_.set(across * (1.0 + size / length));
    } else {
      e_.start(direction, size);
    }
  }

  /// As ErrorTransport::distance(). @pre `direction` is that of the last add().
  [[nodiscard]] double distance(const Vec3& /*direction*/, double speed, double rate) noexcept {
    shift_.add(along_ / speed, rate);
    along_ = 0.0;
    return glm::length(e_.vector()) + shift_.distance(speed);
  }

 private:
  ErrorTransport e_;
  TimeShift shift_;
  double along_ = 0.0;  ///< taken out since the last distance()
};

}  // namespace palpate
