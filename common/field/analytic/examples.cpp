#include "common/field/analytic/examples.h"

#include <array>
#include <numbers>

#include "common/base/error.h"
#include "common/math/dual.h"

namespace palpate {
namespace {

using std::cos;
using std::sin;
using std::sqrt;

/// A field whose formula is written once, as Formula::velocity over any number type: derivatives come from
/// dual numbers.
template <typename Formula>
class FormulaField final : public AnalyticField {
 public:
  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override {
    const std::array<double, 3> v = Formula::velocity(x.x, x.y, x.z);
    return {v[0], v[1], v[2]};
  }

  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    const auto v = Formula::velocity(Dual3(x.x, {1.0, 0.0, 0.0}), Dual3(x.y, {0.0, 1.0, 0.0}),
                                     Dual3(x.z, {0.0, 0.0, 1.0}));
    return glm::transpose(Mat3{v[0].gradient, v[1].gradient, v[2].gradient});
  }

  [[nodiscard]] Box bounds() const noexcept override { return Formula::kBounds; }
  [[nodiscard]] std::string name() const override { return Formula::kName; }
  [[nodiscard]] std::string description() const override { return Formula::kDescription; }
};

/// Swirl around a helical axis c(z), an updraft in its core and the inflow that feeds it. With xi, eta the
/// distances from the axis, s = xi^2 + eta^2 and q = R^2 / (s + R^2):
///   swirl     omega = G / (s + R^2), the angular rate of Scully's vortex
///   updraft   w = W(z) q^2, W = U z (2 - z): none at the ground, steady at the top
///   inflow    -(xi, eta) W'(z) q / 2
/// The last two are free of divergence since d(s q)/ds = q^2, and so is the whole when it is sheared along
/// the axis by adding w c'(z).
struct Tornado {
  static constexpr const char* kName = "tornado";
  static constexpr const char* kDescription =
      "tornado: swirl around a winding axis, updraft fed by inflow; divergence-free formula";
  static constexpr Box kBounds{{-0.5, -0.5, 0.0}, {0.5, 0.5, 1.0}};
  static constexpr double kCore = 0.08;     ///< R
  static constexpr double kSwirl = 0.12;    ///< G
  static constexpr double kUpdraft = 1.2;   ///< U
  static constexpr double kWinding = 0.08;  ///< radius of the axis's helix
  static constexpr double kTurns = 2.0 * std::numbers::pi * 0.9;

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    const T phase = z * T(kTurns);
    // The axis widens with height and stands still at the ground.
    const T radius = T(kWinding) * z;
    const T xi = x - radius * cos(phase);
    const T eta = y - radius * sin(phase);
    const T dx = T(kWinding) * cos(phase) - radius * T(kTurns) * sin(phase);
    const T dy = T(kWinding) * sin(phase) + radius * T(kTurns) * cos(phase);
    const T wide = xi * xi + eta * eta + T(kCore * kCore);
    const T q = T(kCore * kCore) / wide;
    const T omega = T(kSwirl) / wide;
    const T inflow = T(kUpdraft) * (T(1.0) - z) * q;
    const T w = T(kUpdraft) * z * (T(2.0) - z) * q * q;
    return {-omega * eta - inflow * xi + w * dx, omega * xi - inflow * eta + w * dy, w};
  }
};

/// Arnold-Beltrami-Childress flow, A = sqrt 3, B = sqrt 2, C = 1 (Dombre et al. 1986): curl v = v.
struct Abc {
  static constexpr const char* kName = "abc";
  static constexpr const char* kDescription =
      "ABC flow (Arnold 1965; Dombre et al. 1986): steady Euler flow with chaotic streamlines";
  static constexpr Box kBounds{{0.0, 0.0, 0.0},
                               {2.0 * std::numbers::pi, 2.0 * std::numbers::pi, 2.0 * std::numbers::pi}};

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    const T a(std::numbers::sqrt3);
    const T b(std::numbers::sqrt2);
    return {a * sin(z) + cos(y), b * sin(x) + a * cos(z), sin(y) + b * cos(x)};
  }
};

/// Hill's spherical vortex (Hill 1894) of radius 1 in the frame that moves with it, the stream coming along
/// +z with speed 1: psi = -3/4 r^2 (1 - R^2) inside and 1/2 r^2 (1 - R^-3) outside.
struct Hill {
  static constexpr const char* kName = "hill";
  static constexpr const char* kDescription =
      "Hill's spherical vortex (Hill 1894): closed streamlines in a sphere, potential flow around it";
  static constexpr Box kBounds{{-1.5, -1.5, -1.5}, {1.5, 1.5, 1.5}};

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    const T r2 = x * x + y * y;
    const T distance2 = r2 + z * z;
    if (distance2 < T(1.0)) {
      return {T(-1.5) * x * z, T(-1.5) * y * z, T(1.5) * (T(2.0) * r2 + z * z - T(1.0))};
    }
    const T inverse2 = T(1.0) / distance2;
    const T inverse3 = inverse2 / sqrt(distance2);
    const T inverse5 = inverse3 * inverse2;
    return {T(-1.5) * x * z * inverse5, T(-1.5) * y * z * inverse5,
            T(1.0) - inverse3 + T(1.5) * r2 * inverse5};
  }
};

/// v = curl (-B, A, 0) up to signs, with the polynomials
///   A = 256 X(x) Z(z) Y(y),  X = x^2 (1-x)^2,  Z = z^2 (z-1),  Y = y^2 (1-y)^2
///   B = c X(x) y^2 (1-y)^2 (1-2y) z^2 (1-z)^2
/// A drives the roll under a lid that moves along +x with the speed 256 X Y (1 in its middle), B the slow
/// drift along y. Both vanish with their normal derivatives on the five resting walls.
struct Cavity {
  static constexpr const char* kName = "cavity";
  static constexpr const char* kDescription =
      "lid-driven cavity: divergence-free no-slip polynomial that looks like one; not a Navier-Stokes "
      "solution";
  static constexpr Box kBounds{{0.0, 0.0, 0.0}, {1.0, 1.0, 1.0}};
  static constexpr double kDrift = 60.0;

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    const T one(1.0);
    const T two(2.0);
    const T fx = T(16.0) * x * x * (one - x) * (one - x);
    const T dfx = T(32.0) * x * (one - x) * (one - two * x);
    const T fy = T(16.0) * y * y * (one - y) * (one - y);
    const T fz = z * z * (z - one);
    const T dfz = z * (T(3.0) * z - two);
    const T drift(kDrift / 16.0);
    const T bx = fx;
    const T by = y * y * (one - y) * (one - y) * (one - two * y);
    const T dby =
        two * y * (one - y) * (one - two * y) * (one - two * y) - two * y * y * (one - y) * (one - y);
    const T bz = z * z * (one - z) * (one - z);
    const T dbz = two * z * (one - z) * (one - two * z);
    // u = dA/dz is +1 in the middle of the lid; w = -dA/dx and the drift's dB/dz, -dB/dy.
    return {fx * fy * dfz, drift * bx * by * dbz, -dfx * fy * fz - drift * bx * dby * bz};
  }
};

/// Linear saddle with eigenvalues 1, 1/2 and -3/2 along axes that are not the grid's.
struct Saddle {
  static constexpr const char* kName = "saddle";
  static constexpr const char* kDescription =
      "saddle: linear field with eigenvalues 1, 0.5 and -1.5 about a stagnation point";
  static constexpr Box kBounds{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}};

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    // Q diag(1, 1/2, -3/2) Q^T with the orthonormal columns of Q (2,1,2)/3, (1,2,-2)/3, (2,-2,-1)/3.
    const T a = (T(2.0) * x + y + T(2.0) * z) / T(9.0);
    const T b = (x + T(2.0) * y - T(2.0) * z) / T(18.0);
    const T c = (T(2.0) * x - T(2.0) * y - z) / T(-6.0);
    return {T(2.0) * a + b + T(2.0) * c, a + T(2.0) * b - T(2.0) * c, T(2.0) * a - T(2.0) * b - c};
  }
};

/// Flow that is pulled onto the surface z = g(x, y) at the rate Lambda and drifts along it at about unit
/// speed: v = (1, 0.3 cos 2x, g_x v_x + g_y v_y - Lambda (z - g)). The Jacobian has the eigenvalue -Lambda
/// beside others of order one.
struct BoundaryLayer {
  static constexpr const char* kName = "boundary-layer";
  static constexpr const char* kDescription =
      "stiff boundary layer: drawn to a wavy surface 1e6 times faster than it flows along it";
  static constexpr Box kBounds{{0.0, 0.0, -0.5}, {4.0, 2.0, 0.5}};
  static constexpr double kRate = 1e6;  ///< Lambda

  template <typename T>
  static std::array<T, 3> velocity(const T& x, const T& y, const T& z) noexcept {
    const T amplitude(0.15);
    const T g = amplitude * sin(x) * cos(y);
    const T gx = amplitude * cos(x) * cos(y);
    const T gy = -amplitude * sin(x) * sin(y);
    const T vy = T(0.3) * cos(T(2.0) * x);
    return {T(1.0), vy, gx + gy * vy - T(kRate) * (z - g)};
  }
};

template <typename Formula>
std::shared_ptr<const AnalyticField> make() {
  return std::make_shared<FormulaField<Formula>>();
}

using Maker = std::shared_ptr<const AnalyticField> (*)();
constexpr std::array<Maker, 6> kMakers{make<Tornado>, make<Abc>,    make<Hill>,
                                       make<Cavity>,  make<Saddle>, make<BoundaryLayer>};

}  // namespace

std::vector<ExampleInfo> examples() {
  std::vector<ExampleInfo> out;
  for (const Maker maker : kMakers) {
    const auto field = maker();
    out.push_back({field->name(), field->description()});
  }
  return out;
}

std::shared_ptr<const AnalyticField> example(std::string_view name) {
  std::string known;
  for (const Maker maker : kMakers) {
    auto field = maker();
    if (field->name() == name) return field;
    known += (known.empty() ? "" : ", ") + field->name();
  }
  throw usage_error("no example '" + std::string(name) + "'; the known ones are: " + known);
}

}  // namespace palpate
