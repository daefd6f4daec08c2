/// Proportional-integral step size control (Hairer and Wanner 1996, IV.2; Gustafsson 1991).
///
///   h_new = h  0.9  r_n^(-alpha)  r_(n-1)^beta,    alpha = 0.7 / p,  beta = 0.4 / p                   (1)
///
/// r is the error measure of a step over the allowed one, p the power of h that r falls with. A step with
/// r <= 1 is accepted. After a rejection the integral part is left out and the step does not grow.
#pragma once

#include <algorithm>
#include <cmath>

namespace palpate {

class StepControl {
 public:
  /// @param power p: the order of the error measure. For an error per unit step it is the embedded order.
  explicit StepControl(double power) noexcept
      : alpha_(0.7 / power), beta_(0.4 / power), plain_(1.0 / power) {}

  struct Verdict {
    bool accepted = false;
    double factor = 1.0;  ///< next step over this one, within [kSmallest, kLargest]
  };

  /// Judges a step; a ratio that is NaN or infinite is rejected.
  [[nodiscard]] Verdict judge(double ratio) noexcept {
    if (!(ratio <= 1.0)) {
      const double factor = std::isfinite(ratio) ? kSafety * std::pow(ratio, -plain_) : kSmallest;
      rejected_ = true;
      return {false, std::clamp(factor, kSmallest, kSafety)};
    }
    const double r = std::log(std::max(ratio, kFloor));
    double factor = kSafety * std::exp(beta_ * previous_ - alpha_ * r);
    factor = std::clamp(factor, kSmallest, rejected_ ? 1.0 : kLargest);
    previous_ = r;
    rejected_ = false;
    return {true, factor};
  }

  static constexpr double kSafety = 0.9;
  static constexpr double kSmallest = 0.1;
  static constexpr double kLargest = 5.0;

 private:
  static constexpr double kFloor = 1e-4;  ///< below it a step's error says nothing about the next one's
  double alpha_, beta_, plain_;
  double previous_ = 0.0;  ///< logarithm of the last accepted ratio
  bool rejected_ = false;
};

}  // namespace palpate
