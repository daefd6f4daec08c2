/// Proportional-integral step size control (Hairer and Wanner 1996, IV.2; Gustafsson 1991).
///
///   h_new = h  0.9  r_n^(-alpha)  r_(n-1)^beta,    alpha = 0.7 / p,  beta = 0.4 / p                   (1)
///
/// r is the error measure of a step over the allowed one, p the power of h that r falls with. A step with
/// r <= 1 is accepted. After a rejection the integral part is left out and the step does not grow.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

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
    const double r = rough_log2(std::max(ratio, kFloor));
    double factor = kSafety * rough_exp2(beta_ * previous_ - alpha_ * r);
    factor = std::clamp(factor, kSmallest, rejected_ ? 1.0 : kLargest);
    previous_ = r;
    rejected_ = false;
    return {true, factor};
  }

  static constexpr double kSafety = 0.9;
  static constexpr double kSmallest = 0.1;
  static constexpr double kLargest = 5.0;

 private:
  // A step need not be known to better than 1e-3: polynomials through Chebyshev points, which cost a tenth of
  // the library's functions and are the same wherever the program runs.

  /// Binary logarithm to 2e-4. @pre x is normal and positive.
  [[nodiscard]] static double rough_log2(double x) noexcept {
    const auto number = std::bit_cast<std::uint64_t>(x);
    const int exponent = static_cast<int>(number >> kMantissaBits) - kBias;
    const double f = std::bit_cast<double>((number & kMantissa) | kOne) - 1.0;
    const double low = 1.1457996e-4 + f * 1.43687490, high = -0.67088268 + f * 0.31226948;
    return exponent + (low + (f * f) * (high - (f * f) * 0.07844068));
  }
  /// Power of two to a relative 1e-4. @pre |x| < 1000.
  [[nodiscard]] static double rough_exp2(double x) noexcept {
    const double whole = std::floor(x), f = x - whole;
    const int biased = static_cast<int>(whole) + kBias;
    const auto exponent = static_cast<std::uint64_t>(biased);
    const double low = 0.99990029 + f * 0.69632477, high = 0.22469316 + f * 0.07896726;
    return std::bit_cast<double>(exponent << kMantissaBits) * (low + (f * f) * high);
  }
  static constexpr int kMantissaBits = 52, kBias = 1023;
  static constexpr std::uint64_t kOne = std::uint64_t{kBias} << kMantissaBits;
  static constexpr std::uint64_t kMantissa = (std::uint64_t{1} << kMantissaBits) - 1;

  static constexpr double kFloor = 1e-4;  ///< below it a step's error says nothing about the next one's
  double alpha_, beta_, plain_;
  double previous_ = 0.0;  ///< binary logarithm of the last accepted ratio
  bool rejected_ = false;
};

}  // namespace palpate
