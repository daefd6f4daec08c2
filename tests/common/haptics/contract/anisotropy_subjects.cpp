// Anisotropy drag under the contract: lines, planes and isotropic places, on ways through the places where
// the axes of the tensor are undefined or change their order.

#include <cmath>
#include <vector>

#include "common/field/tensor/diffusion_measures.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/math/symmetric3.h"
#include "tests/common/haptics/contract/constraint_contract.h"
#include "tests/common/haptics/contract/moved_fields.h"

namespace palpate::test {
namespace {

constexpr double kTau = 0.02;  // [m] where all is anisotropic

/// D(x) = at_zero + x slope: interpolation of its components is exact on any grid.
struct AffineTensor {
  Mat3 at_zero{1.0};
  Mat3 slope{0.0};  // along x

  [[nodiscard]] Mat3 operator()(const Vec3& x) const { return at_zero + x.x * slope; }
};

Mat3 diagonal(double a, double b, double c) { return {{a, 0.0, 0.0}, {0.0, b, 0.0}, {0.0, 0.0, c}}; }

/// Turned out of the grid's axes.
Mat3 oblique(const Mat3& tensor) {
  const Mat3 axes{Vec3{2, 1, 2} / 3.0, Vec3{-2, 2, 1} / 3.0, Vec3{-1, -2, 2} / 3.0};
  return axes * tensor * glm::transpose(axes);
}

/// R D(R^T (x - shift)) R^T on an image of kMovedBounds. Diffusivities are scaled by another power than
/// lengths, which no rule may notice.
std::shared_ptr<const TensorField> moved_tensors(const AffineTensor& tensor, const Placement& at) {
  constexpr int kPoints = 9;
  const double unit = power_of_two(at.exponent);
  const double step = kMovedBounds.size().x / (kPoints - 1);
  std::vector<double> values;
  for (int k = 0; k < kPoints; ++k) {
    for (int j = 0; j < kPoints; ++j) {
      for (int i = 0; i < kPoints; ++i) {
        const Vec3 x = kMovedBounds.lower + step * Vec3{i, j, k};
        const Mat3 d =
            unit * unit * (at.rotation * tensor((x - at.shift) * at.rotation) * glm::transpose(at.rotation));
        values.insert(values.end(), {d[0][0], d[0][1], d[0][2], d[1][1], d[1][2], d[2][2]});
      }
    }
  }
  DataSet image;
  image.topology = UniformTopology{Index3{kPoints}, unit * kMovedBounds.lower, Mat3{unit * step}};
  image.arrays.push_back(make_array("D", Association::kPoint, 6, std::span<const double>(values)));
  return make_tensor_field(image, {.array = "D"}, "made");
}

/// How far the stretch r lies outside the ellipsoid sum_a (r_a / tau_a)^2 <= 1 that eqs. 8.6 to 8.11 make at
/// the proxy; axes of no threshold allow no stretch.
double outside_ellipsoid(const AffineTensor& tensor, IsotropicPlaces isotropic, const Vec3& probe,
                         const LinkUpdate& link) {
  const SymmetricEigen eigen = symmetric_eigen(tensor(link.proxy));
  const Anisotropy parts = anisotropy(eigen.values);
  const Vec3 tau =
      kTau * (isotropic == IsotropicPlaces::kFree ? Vec3{0.0, parts.linear, parts.linear + parts.planar}
                                                  : Vec3{parts.spherical, 1.0 - parts.planar, 1.0});
  const Vec3 r = (probe - link.proxy) * eigen.vectors;
  double sum = 0.0;
  double free = 0.0;
  for (int a = 0; a < 3; ++a) {
    if (tau[a] > 1e-9) {
      sum += (r[a] / tau[a]) * (r[a] / tau[a]);
    } else {
      free = std::max(free, std::abs(r[a]));
    }
  }
  return std::max(free, (std::sqrt(sum) - 1.0) * glm::length(r));
}

/// Wandering about the origin, some 0.2 m to each side and across the plane x = 0.
Vec3 wander(double s) {
  return {0.2 * std::sin(9.0 * s), 0.2 * std::cos(14.0 * s), 0.2 * std::sin(11.0 * s + 1.0)};
}

ContractSubject dragged(const char* name, const AffineTensor& tensor, IsotropicPlaces isotropic) {
  ContractSubject subject;
  subject.name = name;
  subject.make = [tensor, isotropic](const Placement& at) {
    const auto field = moved_tensors(tensor, at);
    auto drag = std::make_shared<AnisotropyDrag>(field, Workspace{power_of_two(-at.exponent), field->frame()},
                                                 isotropic);
    ChainSettings settings;
    settings.anisotropy.tau = HapticTransferFunction({0.0, 0.0}, {1.0, kTau});
    drag->apply(settings);
    return drag;
  };
  subject.path = wander;
  subject.off_feature = [tensor, isotropic](const Vec3& probe, const LinkUpdate& link) {
    return outside_ellipsoid(tensor, isotropic, probe, link);
  };
  subject.feature_error = 1e-8;
  subject.slope = 2.0;
  subject.moved_error = 1e-6;  // rounding leaves axes that are equal a threshold, too small to be met
  return subject;
}

const AffineTensor kLinear{oblique(diagonal(1.7, 0.3, 0.3))};
const AffineTensor kPlanar{oblique(diagonal(1.0, 1.0, 0.3))};
const AffineTensor kIsotropic{Mat3{0.7}};
// e_1 and e_2 change places at x = 0; e_2 and e_3; and all three are equal there.
const AffineTensor kMajorCross{diagonal(1.0, 1.0, 0.3), diagonal(1.0, -1.0, 0.0)};
const AffineTensor kMinorCross{diagonal(1.0, 0.5, 0.5), diagonal(0.0, 1.0, -1.0)};
const AffineTensor kThroughIsotropic{Mat3{0.6}, oblique(diagonal(1.0, 0.0, -1.0))};

INSTANTIATE_TEST_SUITE_P(
    Anisotropy, ConstraintContract,
    ::testing::Values(dragged("AnisotropyLinearFree", kLinear, IsotropicPlaces::kFree),
                      dragged("AnisotropyPlanarFree", kPlanar, IsotropicPlaces::kFree),
                      dragged("AnisotropyIsotropicPoint", kIsotropic, IsotropicPlaces::kPoint),
                      dragged("AnisotropyMajorCrossFree", kMajorCross, IsotropicPlaces::kFree),
                      dragged("AnisotropyMinorCrossPoint", kMinorCross, IsotropicPlaces::kPoint),
                      dragged("AnisotropyThroughIsotropicFree", kThroughIsotropic, IsotropicPlaces::kFree),
                      dragged("AnisotropyThroughIsotropicPoint", kThroughIsotropic, IsotropicPlaces::kPoint)),
    subject_name);

}  // namespace
}  // namespace palpate::test
