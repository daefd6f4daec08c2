#include "common/field/analytic/scalar_examples.h"

#include <cmath>
#include <numbers>

namespace palpate {
namespace {

using std::cos;
using std::sin;
using std::sqrt;

struct Sphere {
  static constexpr const char* kName = "sphere";
  static constexpr const char* kDescription = "sphere: squared distance from the origin";
  static constexpr Box kBounds{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};

  template <typename T>
  static T value(const T& x, const T& y, const T& z) noexcept {
    return x * x + y * y + z * z;
  }
};

struct MarschnerLobb {
  static constexpr const char* kName = "marschner-lobb";
  static constexpr const char* kDescription =
      "Marschner-Lobb signal (Marschner and Lobb 1994): rings at the limit of what a 41^3 grid can hold";
  static constexpr Box kBounds{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};
  static constexpr double kFrequency = 6.0;
  static constexpr double kAlpha = 0.25;

  template <typename T>
  static T value(const T& x, const T& y, const T& z) noexcept {
    const T half_pi(0.5 * std::numbers::pi);
    const T r = sqrt(x * x + y * y + T(0x1p-100));  // its derivatives are finite on the axis, too
    const T rho = cos(T(2.0 * std::numbers::pi * kFrequency) * cos(half_pi * r));
    return (T(1.0) - sin(half_pi * z) + T(kAlpha) * (T(1.0) + rho)) / T(2.0 * (1.0 + kAlpha));
  }
};

}  // namespace

std::shared_ptr<const AnalyticScalar> sphere_scalar() { return std::make_shared<FormulaScalar<Sphere>>(); }
std::shared_ptr<const AnalyticScalar> marschner_lobb_scalar() {
  return std::make_shared<FormulaScalar<MarschnerLobb>>();
}

}  // namespace palpate
