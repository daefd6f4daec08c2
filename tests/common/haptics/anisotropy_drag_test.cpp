// Anisotropy drag: lines, planes, isotropic places, and sweeps from one to the other.
#include "common/haptics/constraint/anisotropy_drag.h"

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/peak_field.h"
#include "tests/support/allocation_guard.h"

namespace palpate {
namespace {

constexpr double kTau = 0.004;  // [m] at full anisotropy
constexpr double kStretch = 0.02;

HapticTransferFunction ramp() {
  HapticTransferFunction tau;
  EXPECT_FALSE(HapticTransferFunction::read("0:0,1:0.004", tau));
  return tau;
}

Mat3 turned(const Vec3& axis, double angle) {
  const Vec3 n = glm::normalize(axis);
  const double c = std::cos(angle), s = std::sin(angle);
  const Mat3 cross{Vec3{0, n.z, -n.y}, Vec3{-n.z, 0, n.x}, Vec3{n.y, -n.x, 0}};
  return c * Mat3{1.0} + (1.0 - c) * glm::outerProduct(n, n) + s * cross;
}

Mat3 with_values(const Mat3& axes, const Vec3& values) {
  return axes * Mat3{Vec3{values.x, 0, 0}, Vec3{0, values.y, 0}, Vec3{0, 0, values.z}} * glm::transpose(axes);
}

/// An image of 0.4 m along each edge, one metre a data unit.
std::shared_ptr<const TensorField> field_of(const std::function<Mat3(const Vec3&)>& tensor, int points = 9) {
  const double step = 0.4 / (points - 1);
  std::vector<double> values;
  for (int k = 0; k < points; ++k) {
    for (int j = 0; j < points; ++j) {
      for (int i = 0; i < points; ++i) {
        const Mat3 d = tensor(Vec3{-0.2} + step * Vec3(i, j, k));
        values.insert(values.end(), {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]});
      }
    }
  }
  DataSet image;
  image.topology = UniformTopology{Index3{points}, Vec3{-0.2}, Mat3{step}};
  image.arrays.push_back(make_array("D", Association::kPoint, 6, std::span<const double>(values)));
  return make_tensor_field(image, {.array = "D"}, "made");
}

class Hand {
 public:
  Hand(const std::shared_ptr<const TensorField>& field, IsotropicPlaces isotropic)
      : drag_(field, Workspace(1.0, field->frame()), isotropic) {
    ChainSettings settings;
    settings.anisotropy.tau = ramp();
    drag_.apply(settings);
  }
  const LinkUpdate& at(const Vec3& probe) {
    link_ = {};
    drag_.update(probe, UpdateBudget{}, link_);
    return link_;
  }

 private:
  AnisotropyDrag drag_;
  LinkUpdate link_;
};

// Eqs. 8.6 to 8.8 on tensors that are the same everywhere: how far the proxy stays behind in each direction.
TEST(AnisotropyDrag, HoldsToALineWhereDiffusionIsLinear) {
  const Mat3 axes = turned({1, 2, 3}, 0.8);
  for (const Vec3 values : {Vec3{1, 0, 0}, Vec3{1.5, 0.4, 0.4}}) {
    const double linear = (values.x - values.y) / (values.x + values.y + values.z);
    const auto field = field_of([&](const Vec3&) { return with_values(axes, values); });
    Hand along(field, IsotropicPlaces::kFree);
    along.at(Vec3{0.0});
    EXPECT_LT(glm::distance(along.at(kStretch * axes[0]).proxy, kStretch * axes[0]), 1e-12);
    for (const Vec3& across : {axes[1], axes[2], glm::normalize(axes[1] + axes[2])}) {
      Hand hand(field, IsotropicPlaces::kFree);
      hand.at(Vec3{0.0});
      EXPECT_NEAR(glm::distance(hand.at(kStretch * across).proxy, kStretch * across), kTau * linear, 1e-9);
    }
  }
}

TEST(AnisotropyDrag, HoldsToAPlaneWhereDiffusionIsPlanar) {
  const Mat3 axes = turned({3, -1, 2}, 1.3);
  const auto field = field_of([&](const Vec3&) { return with_values(axes, {1, 1, 0}); });
  for (const auto isotropic : {IsotropicPlaces::kFree, IsotropicPlaces::kPoint}) {
    for (int i = 0; i < 8; ++i) {
      const Vec3 within = std::cos(0.8 * i) * axes[0] + std::sin(0.8 * i) * axes[1];
      Hand hand(field, isotropic);
      hand.at(Vec3{0.0});
      EXPECT_LT(glm::distance(hand.at(kStretch * within).proxy, kStretch * within), 1e-9);
    }
    Hand hand(field, isotropic);
    hand.at(Vec3{0.0});
    EXPECT_NEAR(glm::distance(hand.at(kStretch * axes[2]).proxy, kStretch * axes[2]), kTau, 1e-9);
  }
}

// The axes are arbitrary there: the hold must be the same in every direction.
TEST(AnisotropyDrag, IsotropicPlacesAreFreeOrHoldToAPointWhateverTheAxes) {
  const auto field = field_of([](const Vec3&) { return Mat3{0.7}; });
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 40; ++i) {
    const Vec3 d = glm::normalize(Vec3{normal(random), normal(random), normal(random)});
    Hand free(field, IsotropicPlaces::kFree), point(field, IsotropicPlaces::kPoint);
    free.at(Vec3{0.0});
    point.at(Vec3{0.0});
    EXPECT_LT(glm::distance(free.at(kStretch * d).proxy, kStretch * d), 1e-12);
    EXPECT_NEAR(glm::distance(point.at(kStretch * d).proxy, kStretch * d), kTau, 1e-12);
  }
}

// Through places where eigenvalues cross and where the tensor turns isotropic: the stretch, which is what is
// felt, changes by no more than the hand moves and thresholds change; and it rests where the hand rests.
TEST(AnisotropyDrag, NeitherJumpsNorChattersWhereEigenvaluesCross) {
  const std::vector<std::function<Mat3(const Vec3&)>> tensors{
      [](const Vec3& x) {
        return with_values(Mat3{1.0}, {1.0 + 2.0 * x.x, 1.0 - 2.0 * x.x, 0.4});
      },
      [](const Vec3& x) {
        return with_values(Mat3{1.0}, {1.0, 0.5 + x.x, 0.5 - x.x});
      },
      [](const Vec3& x) {
        return with_values(turned({1, 1, 0}, 0.5), {1.0 + std::abs(x.x), 1.0, 1.0 - x.x});
      },
      [](const Vec3& x) { return with_values(Mat3{1.0}, Vec3{0.5 + x.x}); }};
  for (std::size_t which = 0; which < tensors.size(); ++which) {
    const auto field = field_of(tensors[which], 21);
    for (const auto isotropic : {IsotropicPlaces::kFree, IsotropicPlaces::kPoint}) {
      Hand hand(field, isotropic);
      const auto path = [](double t) {
        return Vec3{t, 0.03 * std::sin(17.0 * t), 0.02 * std::cos(23.0 * t)};
      };
      constexpr double kStep = 2e-5;
      Vec3 before = path(-0.15), felt{0.0};
      hand.at(before);
      double largest = 0.0;
      for (int n = 0; n < 15'000; ++n) {
        const double t = -0.15 + n * kStep;
        const Vec3 x = path(t);
        const Vec3 stretch = hand.at(x).proxy - x;
        if (t > -0.14) largest = std::max(largest, glm::distance(stretch, felt) / glm::distance(x, before));
        felt = stretch;
        before = x;
        constexpr int kOften = 50;
        if (n % kOften != 0) continue;
        const Vec3 held = hand.at(x).proxy;
        ASSERT_LT(glm::distance(hand.at(x).proxy, held), 2e-9) << "tensor " << which << " at " << t;
        ASSERT_LT(glm::distance(held, x + stretch), 2e-9) << "tensor " << which << " at " << t;
      }
      EXPECT_LT(largest, 2.0) << "tensor " << which;
      const Vec3 rest = hand.at(before).proxy;
      for (int i = 0; i < 20; ++i) EXPECT_LT(glm::distance(hand.at(before).proxy, rest), 2e-9);
    }
  }
}

// A bundle that turns: the proxy follows it when the hand leads roughly along it.
TEST(AnisotropyDrag, FollowsABundleThatTurns) {
  const auto field = field_of(
      [](const Vec3& x) {
        const Vec3 tangent = glm::normalize(Vec3{-(x.y + 0.25), x.x, 0.0} + Vec3{1e-9, 0, 0});
        return 0.1 * Mat3{1.0} + 0.9 * glm::outerProduct(tangent, tangent);
      },
      41);
  Hand hand(field, IsotropicPlaces::kFree);
  const Vec3 centre{0.0, -0.25, 0.0};
  constexpr double kRadius = 0.3;
  const auto circle = [&](double angle, double radius) {
    return centre + radius * Vec3{std::sin(angle), std::cos(angle), 0.0};
  };
  hand.at(circle(-0.5, kRadius));
  double farthest = 0.0;
  for (int n = 0; n < 10'000; ++n) {
    const double angle = -0.5 + n * 1e-4;
    // The hand strays by less than what drags it along.
    const Vec3 probe = circle(angle, kRadius + 0.002 * std::sin(30.0 * angle));
    farthest = std::max(farthest, std::abs(glm::distance(hand.at(probe).proxy, centre) - kRadius));
  }
  EXPECT_LT(farthest, 0.0008);
}

// Two bundles that cross everywhere, of which another is the longer from voxel to voxel: the hand stays in the one
// that it begins in, the longer one there, however it strays, and begins in whichever is longer after it was let go.
TEST(AnisotropyDrag, StaysInOneOfTwoBundlesThatCross) {
  constexpr int kPoints = 9;
  for (const double degrees : {60.0, 90.0}) {
    const double angle = degrees * M_PI / 180.0;
    const std::array<Vec3, 2> ways{Vec3{1.0, 0.0, 0.0}, Vec3{std::cos(angle), std::sin(angle), 0.0}};
    std::mt19937 random(7);
    std::vector<float> tensors, peaks;
    for (int p = 0; p < kPoints * kPoints * kPoints; ++p) {
      const bool first = (random() & 1U) != 0, swap = (random() & 1U) != 0;
      const Mat3 d = fibre_tensor(ways[first ? 0 : 1], 0.8);
      for (const double x : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]})
        tensors.push_back(static_cast<float>(x));
      std::array<Vec3, 2> both{(first ? 0.8 : 0.7) * ways[0], (first ? -0.7 : -0.8) * ways[1]};
      if (swap) std::swap(both[0], both[1]);
      for (const Vec3& peak : both) {
        for (int axis = 0; axis < 3; ++axis) peaks.push_back(static_cast<float>(peak[axis]));
      }
    }
    DataSet image;
    image.topology = UniformTopology{Index3{kPoints}, Vec3{-0.2}, Mat3{0.05}};
    image.arrays = {make_array("D", Association::kPoint, 6, std::span<const float>(tensors)),
                    make_array("P", Association::kPoint, 6, std::span<const float>(peaks))};
    const auto field = make_tensor_field(image, {.array = "D", .peaks = "P"}, "made");
    Hand hand(field, IsotropicPlaces::kFree);
    std::array<int, 2> begun{};
    for (const double height : {-0.1, -0.05, 0.0, 0.05, 0.1}) {
      const Vec3 start{0.0, 0.0, height};
      const Vec3 way = glm::normalize(field->peaks()->longest(start)),
                 aside = glm::cross(way, Vec3{0.0, 0.0, 1.0});
      ++begun[std::abs(way.y) > 1e-3 ? 1 : 0];
      hand.at(Vec3{1.0});  // outside
      hand.at(start);
      double farthest = 0.0, reached = 0.0;
      for (int n = 0; n < 1500; ++n) {
        const double along = n * 1e-4;
        const Vec3 proxy =
            hand.at(start + along * way + 0.001 * std::sin(40.0 * along) * aside).proxy - start;
        reached = glm::dot(proxy, way);
        farthest = std::max(farthest, glm::length(proxy - reached * way));
      }
      EXPECT_LT(farthest, 1e-6) << degrees << " degrees, height " << height;
      EXPECT_GT(reached, 0.145);
    }
    EXPECT_GT(begun[0], 0);
    EXPECT_GT(begun[1], 0);
  }
}

// Round a bundle that closes on itself, whose eigenvectors the solver gives with any sign: all three axes
// that the spring is given turn with the bundle, and come back as they were.
TEST(AnisotropyDrag, CarriesItsFrameAlongThePathWithoutFlips) {
  constexpr double kRadius = 0.12, kTurn = 2e-3;
  const auto along = [](double angle) { return Vec3{std::cos(angle), -std::sin(angle), 0.0}; };
  const auto field = field_of(
      [&](const Vec3& x) {
        const Vec3 out = Vec3{x.x, x.y, 0.0} + Vec3{1e-9, 0, 0};
        const Vec3 radial = glm::normalize(out), tangent{radial.y, -radial.x, 0.0};
        return 0.1 * Mat3{1.0} + 0.3 * glm::outerProduct(radial, radial) +
               0.9 * glm::outerProduct(tangent, tangent);
      },
      81);
  for (const auto isotropic : {IsotropicPlaces::kFree, IsotropicPlaces::kPoint}) {
    Hand hand(field, isotropic);
    const auto at = [&](double angle) { return kRadius * Vec3{std::sin(angle), std::cos(angle), 0.0}; };
    const Mat3 first = hand.at(at(0.0)).frame;
    ASSERT_GT(std::abs(glm::dot(first[0], along(0.0))), 0.99);
    Mat3 before = first;
    for (int n = 1; n * kTurn < 4.0 * 3.14159265358979; ++n) {
      const Mat3 frame = hand.at(at(n * kTurn)).frame;
      for (int axis = 0; axis < 3; ++axis)
        ASSERT_GT(glm::dot(frame[axis], before[axis]), 0.99) << "axis " << axis << " at " << n * kTurn;
      ASSERT_GT(glm::dot(glm::cross(frame[0], frame[1]), frame[2]), 0.99);
      before = frame;
    }
    for (int axis = 0; axis < 3; ++axis) EXPECT_GT(glm::dot(before[axis], first[axis]), 0.95);
  }
}

// Through voxels without a tensor, without diffusion, with eigenvalues below zero and with NaN.
TEST(AnisotropyDrag, StaysFiniteAndLetsGoWithoutAJumpWhereTensorsAreBad) {
  const Mat3 good = with_values(turned({1, 1, 0}, 0.5), {1.7, 0.3, 0.3});
  const std::vector<Mat3> bad{Mat3{0.0}, Mat3{NAN}, with_values(Mat3{1.0}, {0.5, -0.1, -0.7}), Mat3{-1.0}};
  for (std::size_t which = 0; which < bad.size(); ++which) {
    const auto field = field_of([&](const Vec3& x) { return std::abs(x.x) < 0.05 ? bad[which] : good; }, 7);
    for (const auto isotropic : {IsotropicPlaces::kFree, IsotropicPlaces::kPoint}) {
      Hand hand(field, isotropic);
      const auto path = [](double t) { return Vec3{t, 0.003 * std::sin(40.0 * t), 0.05 * t}; };
      constexpr double kStep = 2e-5;
      Vec3 before = path(-0.19);
      Vec3 felt{0.0};
      hand.at(before);
      double largest = 0.0;
      for (int n = 0; n < 19'000; ++n) {
        const double t = -0.19 + n * kStep;
        const Vec3 x = path(t);
        const LinkUpdate& link = hand.at(x);
        ASSERT_TRUE(is_finite(link.proxy) && is_finite(link.kappa)) << which << " at " << t;
        const Vec3 stretch = link.frame * (link.kappa * ((link.proxy - x) * link.frame));
        if (t > -0.18) largest = std::max(largest, glm::distance(stretch, felt) / glm::distance(x, before));
        felt = stretch;
        before = x;
      }
      // The hold opens and closes over the fade distance of 2 mm, and grows over a voxel of 67 mm.
      EXPECT_LT(largest, 2.0 + kTau / 0.002) << "tensor " << which;
    }
  }
}

TEST(AnisotropyDrag, UpdatesDoNotAllocate) {
  const auto field = field_of([](const Vec3& x) { return with_values(Mat3{1.0}, {1.0, 0.5 + x.x, 0.2}); });
  Hand hand(field, IsotropicPlaces::kPoint);
  const test::AllocationGuard guard;
  for (int i = 0; i < 100; ++i) hand.at(Vec3{0.001 * i, 0.0005 * i, 0.0});
  EXPECT_EQ(guard.count(), 0U);
}

TEST(AnisotropyDrag, ThresholdsThatMakeNoSenseAreNotValid) {
  const auto valid = [](const char* text) {
    AnisotropySettings settings;
    EXPECT_FALSE(HapticTransferFunction::read(text, settings.tau)) << text;
    return settings.valid();
  };
  EXPECT_TRUE(AnisotropySettings{}.valid());
  for (const char* good : {"0", "0:0,1:0.004", "0.2:0,0.5:0.004,smooth", "0:0,0.5:0.001,0.6:0.001"})
    EXPECT_TRUE(valid(good)) << good;
  for (const char* bad : {"0.004", "-1", "0:0.001,1:0.004", "0:0,0.5:0.004,1:0.003", "-1:-1,0:0,1:1"})
    EXPECT_FALSE(valid(bad)) << bad;
  AnisotropySettings settings;
  settings.tau = NAN;
  EXPECT_FALSE(settings.valid());
}

}  // namespace
}  // namespace palpate
