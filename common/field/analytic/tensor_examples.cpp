#include "common/field/analytic/tensor_examples.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/math/counter_random.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// The `index`-th number of mean 0 and standard deviation 1: twelve uniform ones less their mean, so that the
/// bits do not depend on libm.
double normal_at(std::uint64_t index) noexcept {
  constexpr std::uint64_t kTerms = 12;
  double sum = -0.5 * static_cast<double>(kTerms);
  for (std::uint64_t term = 0; term < kTerms; ++term) sum += uniform_at(kTerms * index + term);
  return sum;
}

constexpr double kAlong = 1.7e-3;   ///< diffusivity along a bundle [mm^2/s]
constexpr double kAcross = 0.3e-3;  ///< across it
constexpr double kAround = (kAlong + 2.0 * kAcross) / 3.0;
constexpr double kRadius = 5.0;  ///< of bundles [mm]
constexpr double kNoise = 0.01;  ///< as AnalyticTensor::noise()
constexpr double kHalf = 40.0;   ///< half the side of the cube that is shown [mm]

/// Two equal eigenvalues across the unit vector `e`.
Mat3 uniaxial(double along, double across, const Vec3& e) noexcept {
  return across * Mat3{1.0} + (along - across) * glm::outerProduct(e, e);
}

/// How far a place is inside a bundle, in [0, 1]: 1 on the centre line, 1/e at kRadius from it, flat on both
/// sides of the border.
double inside(double distance) noexcept {
  const double part = distance / kRadius;
  return std::exp(-part * part * part * part);
}

struct Fibre {
  double inside = 0.0;
  Vec3 direction{1.0, 0.0, 0.0};  ///< unit
};

/// Bundles in their surroundings: the mean of their tensors where they overlap.
template <std::size_t N>
Mat3 blend(const std::array<Fibre, N>& fibres) noexcept {
  double outside = 1.0;
  for (const Fibre& fibre : fibres) outside *= 1.0 - fibre.inside;
  Mat3 sum = Mat3{kAround} * outside;
  double weights = outside;
  for (const Fibre& fibre : fibres) {
    sum += fibre.inside * uniaxial(kAlong, kAcross, fibre.direction);
    weights += fibre.inside;
  }
  return sum / weights;
}

/// The straight line from a to b.
CenterLine segment(const Vec3& a, const Vec3& b) {
  const Vec3 direction = glm::normalize(b - a);
  return {[a, b](double u) { return a + u * (b - a); }, [direction](double) { return direction; }};
}

/// Distance of x from the line through the origin along the unit vector e.
double distance_from_axis(const Vec3& x, const Vec3& e) noexcept {
  return glm::length(x - glm::dot(x, e) * e);
}

/// Around the z axis. A place belongs to the coaxial helix of the same pitch through it, whose tangent is the
/// direction there; how far it is inside is measured on the cylinder that is unrolled there.
struct Helix {
  static constexpr const char* kName = "helix";
  static constexpr const char* kDescription =
      "helix: one bundle winding around the z axis with a radius of 20 mm and a pitch of 24 mm, with noise";
  static constexpr double kNoise = palpate::kNoise;
  static constexpr double kWinding = 20.0;                          ///< [mm]
  static constexpr double kRise = 24.0 / (2.0 * std::numbers::pi);  ///< dz/dphi [mm]
  static constexpr double kPhase = 0.9 * (kHalf / kRise);           ///< ends at -kPhase and kPhase

  static Mat3 tensor(const Vec3& x) noexcept {
    const double r = std::hypot(x.x, x.y);
    const double turn = (x.z - kRise * std::atan2(x.y, x.x)) / (2.0 * std::numbers::pi * kRise);
    const double above = (turn - std::round(turn)) * (2.0 * std::numbers::pi * kRise);
    const double steepness = kWinding / std::hypot(kWinding, kRise);
    const Vec3 direction = glm::normalize(Vec3{-x.y, x.x, kRise});
    return blend<1>({{{inside(std::hypot(r - kWinding, above * steepness)), direction}}});
  }
  static std::vector<CenterLine> center_lines() {
    const auto phase = [](double u) { return kPhase * (2.0 * u - 1.0); };
    return {{[phase](double u) {
               const double phi = phase(u);
               return Vec3{kWinding * std::cos(phi), kWinding * std::sin(phi), kRise * phi};
             },
             [phase](double u) {
               const double phi = phase(u);
               return Vec3{-kWinding * std::sin(phi), kWinding * std::cos(phi), kRise} /
                      std::hypot(kWinding, kRise);
             }}};
  }
};

/// Along a direction that is not the grid's.
struct Straight {
  static constexpr const char* kName = "straight";
  static constexpr const char* kDescription = "straight: one bundle, oblique to the axes, with noise";
  static constexpr double kNoise = palpate::kNoise;
  static Vec3 axis() noexcept { return Vec3{2.0, 1.0, 2.0} / 3.0; }

  static Mat3 tensor(const Vec3& x) noexcept {
    return blend<1>({{{inside(distance_from_axis(x, axis())), axis()}}});
  }
  static std::vector<CenterLine> center_lines() {
    return {segment(-1.35 * kHalf * axis(), 1.35 * kHalf * axis())};
  }
};

/// At a right angle, so that diffusion is planar where they cross and no direction is the main one there.
struct Crossing {
  static constexpr const char* kName = "crossing";
  static constexpr const char* kDescription =
      "crossing: two bundles at a right angle, planar where they cross, with noise";
  static constexpr double kNoise = palpate::kNoise;
  static Vec3 first() noexcept { return {0.8, 0.6, 0.0}; }
  static Vec3 second() noexcept { return {-0.6, 0.8, 0.0}; }

  static Mat3 tensor(const Vec3& x) noexcept {
    return blend<2>({{{inside(distance_from_axis(x, first())), first()},
                      {inside(distance_from_axis(x, second())), second()}}});
  }
  static std::vector<CenterLine> center_lines() {
    constexpr double kReach = 1.2 * kHalf;
    return {segment(-kReach * first(), kReach * first()), segment(-kReach * second(), kReach * second())};
  }
};

/// Two arcs of circles in the plane z = 0, closest at the origin, where they run side by side.
struct Kissing {
  static constexpr const char* kName = "kissing";
  static constexpr const char* kDescription =
      "kissing: two arcs that touch in the middle and part again, with noise";
  static constexpr double kNoise = palpate::kNoise;
  static constexpr double kArc = 40.0;     ///< radius of the arcs [mm]
  static constexpr double kGap = 5.0;      ///< of either arc from the plane y = 0 [mm]
  static constexpr double kOpening = 1.2;  ///< half the angle of a centre line

  /// @param side 1 or -1: the arc with y of that sign.
  static Fibre fibre(const Vec3& x, double side) noexcept {
    const Vec3 away{x.x, x.y - side * (kGap + kArc), 0.0};
    const double r = std::hypot(away.x, away.y);
    if (!(r > 0.0)) return {};
    return {inside(std::hypot(r - kArc, x.z)), Vec3{-away.y, away.x, 0.0} / r};
  }
  static Mat3 tensor(const Vec3& x) noexcept { return blend<2>({{fibre(x, 1.0), fibre(x, -1.0)}}); }
  static std::vector<CenterLine> center_lines() {
    std::vector<CenterLine> lines;
    for (const double side : {1.0, -1.0}) {
      const auto angle = [](double u) { return kOpening * (2.0 * u - 1.0); };
      lines.push_back({[angle, side](double u) {
                         const double a = angle(u);
                         return Vec3{kArc * std::sin(a), side * (kGap + kArc - kArc * std::cos(a)), 0.0};
                       },
                       [angle, side](double u) {
                         const double a = angle(u);
                         return Vec3{std::cos(a), side * std::sin(a), 0.0};
                       }});
    }
    return lines;
  }
};

/// Straight lines that come from a line parallel to z outside the cube and spread in the plane across it.
struct Fanning {
  static constexpr const char* kName = "fanning";
  static constexpr const char* kDescription =
      "fanning: a bundle that spreads from 14 mm to 70 mm, with noise";
  static constexpr double kNoise = palpate::kNoise;
  static constexpr double kSource = -60.0;  ///< x of that line [mm]
  static constexpr double kSpread = 0.34;   ///< angle at which `inside` is 1/e

  static Mat3 tensor(const Vec3& x) noexcept {
    const Vec3 away{x.x - kSource, x.y, 0.0};
    const double r = glm::length(away);
    if (!(r > 0.0)) return Mat3{kAround};
    const double angle = std::atan2(away.y, away.x) / kSpread;
    const double part = inside(std::abs(x.z)) * inside(kRadius * std::abs(angle));
    return blend<1>({{{part, away / r}}});
  }
  static std::vector<CenterLine> center_lines() {
    std::vector<CenterLine> lines;
    const Vec3 source{kSource, 0.0, 0.0};
    for (const double angle : {-0.2, 0.0, 0.2}) {
      const Vec3 e{std::cos(angle), std::sin(angle), 0.0};
      lines.push_back(segment(source + 22.0 / e.x * e, source + 98.0 / e.x * e));
    }
    return lines;
  }
};

struct Isotropic {
  static constexpr const char* kName = "isotropic";
  static constexpr const char* kDescription = "isotropic: the same everywhere and in every direction";
  static constexpr double kNoise = 0.0;
  static Mat3 tensor(const Vec3& /*x*/) noexcept { return Mat3{kAround}; }
  static std::vector<CenterLine> center_lines() { return {}; }
};

/// Free within nested cylinders about an axis along y outside the cube, slow across them.
struct Planar {
  static constexpr const char* kName = "planar";
  static constexpr const char* kDescription =
      "planar: bent sheets, in which diffusion has no main direction; without noise";
  static constexpr double kNoise = 0.0;
  static constexpr double kAxis = -80.0;  ///< z of that axis [mm]
  static Mat3 tensor(const Vec3& x) noexcept {
    const Vec3 away{x.x, 0.0, x.z - kAxis};
    const double r = glm::length(away);
    if (!(r > 0.0)) return Mat3{kAround};
    return uniaxial(kAcross, 0.5 * (kAlong + kAcross), away / r);
  }
  static std::vector<CenterLine> center_lines() { return {}; }
};

/// Axes that stay, a and b at 45 degrees to x and y. Along x the two larger eigenvalues change places in the
/// plane x = 0, where diffusion is planar; along y it goes over from isotropic to that.
struct EigenvalueCrossing {
  static constexpr const char* kName = "eigenvalue-crossing";
  static constexpr const char* kDescription =
      "eigenvalue-crossing: the main direction jumps by a right angle at x = 0, isotropic at y = -40; "
      "without noise";
  static constexpr double kNoise = 0.0;
  static Mat3 tensor(const Vec3& x) noexcept {
    const double s = std::clamp(x.x / kHalf, -1.0, 1.0);
    const double strength = std::clamp(0.5 + 0.5 * x.y / kHalf, 0.0, 1.0);
    const Vec3 a{std::numbers::sqrt2 / 2.0, std::numbers::sqrt2 / 2.0, 0.0};
    const Vec3 b{-a.x, a.y, 0.0};
    constexpr double kMiddle = 0.5 * (kAlong + kAcross);
    constexpr double kSwing = 0.5 * (kAlong - kAcross);
    const Mat3 full = (kMiddle + kSwing * s) * glm::outerProduct(a, a) +
                      (kMiddle - kSwing * s) * glm::outerProduct(b, b) +
                      kAcross * glm::outerProduct(Vec3{0.0, 0.0, 1.0}, Vec3{0.0, 0.0, 1.0});
    return strength * full + Mat3{(1.0 - strength) * kAround};
  }
  static std::vector<CenterLine> center_lines() { return {}; }
};

template <typename Formula>
class FormulaTensor final : public AnalyticTensor {
 public:
  [[nodiscard]] Mat3 tensor(const Vec3& x) const noexcept override { return Formula::tensor(x); }
  [[nodiscard]] Box bounds() const noexcept override { return {Vec3{-kHalf}, Vec3{kHalf}}; }
  [[nodiscard]] std::vector<CenterLine> center_lines() const override { return Formula::center_lines(); }
  [[nodiscard]] std::string name() const override { return Formula::kName; }
  [[nodiscard]] std::string description() const override { return Formula::kDescription; }
  [[nodiscard]] double noise() const noexcept override { return Formula::kNoise; }
};

template <typename Formula>
std::shared_ptr<const AnalyticTensor> make_tensor() {
  return std::make_shared<FormulaTensor<Formula>>();
}

using TensorMaker = std::shared_ptr<const AnalyticTensor> (*)();
constexpr std::array<TensorMaker, 8> kTensorMakers{
    make_tensor<Helix>,   make_tensor<Straight>,  make_tensor<Crossing>, make_tensor<Kissing>,
    make_tensor<Fanning>, make_tensor<Isotropic>, make_tensor<Planar>,   make_tensor<EigenvalueCrossing>};

}  // namespace

DataSet sample_tensors(const AnalyticTensor& formula, const Index3& points, double noise) {
  PALPATE_CHECK(points.x >= 2 && points.y >= 2 && points.z >= 2 && noise >= 0.0);
  constexpr std::size_t kComponents = 6;
  const Box box = formula.bounds();
  const Vec3 spacing = box.size() / Vec3(points - 1);
  std::vector<float> values;
  values.reserve(kComponents * count_of(points));
  const auto add = [&values, noise](double value, double part) {
    const auto index = static_cast<std::uint64_t>(values.size());
    values.push_back(static_cast<float>(noise > 0.0 ? value + noise * part * normal_at(index) : value));
  };
  constexpr double kOff = 1.0 / std::numbers::sqrt2;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        const Mat3 d = formula.tensor(box.lower + spacing * Vec3{i, j, k});
        add(d[0][0], 1.0);
        add(d[0][1], kOff);
        add(d[0][2], kOff);
        add(d[1][1], 1.0);
        add(d[1][2], kOff);
        add(d[2][2], 1.0);
      }
    }
  }
  UniformTopology topology;
  topology.points = points;
  topology.origin = box.lower;
  for (int axis = 0; axis < 3; ++axis) {
    topology.axes[axis] = Vec3{0.0};
    topology.axes[axis][axis] = spacing[axis];
  }
  DataSet image;
  image.name = formula.name();
  image.topology = topology;
  image.arrays.push_back(
      make_array(kTensorArray, Association::kPoint, kComponents, std::span<const float>(values)));
  return image;
}

std::vector<ExampleInfo> tensor_examples() {
  std::vector<ExampleInfo> list;
  for (const TensorMaker maker : kTensorMakers) {
    const auto formula = maker();
    list.push_back({formula->name(), formula->description()});
  }
  return list;
}

std::shared_ptr<const AnalyticTensor> tensor_formula(std::string_view name) {
  std::string known;
  for (const TensorMaker maker : kTensorMakers) {
    auto formula = maker();
    if (formula->name() == name) return formula;
    known += (known.empty() ? "" : ", ") + formula->name();
  }
  throw usage_error("no example '" + std::string(name) + "'; the known ones are: " + known);
}

DataSet tensor_example(std::string_view name) {
  constexpr int kPoints = 41;  // voxels of 2 mm
  const auto formula = tensor_formula(name);
  return sample_tensors(*formula, Index3{kPoints}, formula->noise() * kAlong);
}

}  // namespace palpate
