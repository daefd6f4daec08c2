// Borders say of made spinal cords which table is wrong, and nothing against a right one.

#include "common/field/tensor/border_check.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/orientation_check.h"
#include "tests/support/samples.h"

namespace palpate::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

struct Made {
  UniformTopology topology;
  std::vector<float> tensors;
  std::vector<Vec3> fibres;  ///< of the middle of the cord, for each point in it
};

/// How a cord lies and how it was measured.
struct Cord {
  unsigned seed = 1;
  double bend = 15.0;      ///< degrees that it leaves its mean direction by, forwards and back
  double tilt = 0.0;       ///< degrees to the right
  double distorted = 0.0;  ///< mm that its image is bent by, forwards and back, three times as often
  double noise = 0.1;      ///< of each number of a tensor, 1 being a usual MD
  Vec3 step{1.0, 1.0, 4.0};
  Index3 points{28, 32, 20};
  bool masked = false;               ///< no tensors but in the cord and the fluid beside it
  std::array<int, 3> axes{0, 1, 2};  ///< of the body (right, forwards, up) along those of the image
};

void add(const Mat3& t, std::vector<float>& tensors) {
  for (const double value : {t[0][0], t[1][0], t[2][0], t[1][1], t[2][1], t[2][2]})
    tensors.push_back(static_cast<float>(value));
}

/// A cord with grey matter within, in fluid, in tissue that has no direction; right axes.
Made made(const Cord& cord) {
  std::mt19937 random(cord.seed);
  std::normal_distribution<double> normal;
  const Mat3 axes{Vec3{cord.step.x, 0.0, 0.0}, Vec3{0.0, cord.step.y, 0.0}, Vec3{0.0, 0.0, cord.step.z}};
  Made out{{cord.points, Vec3{0.0}, axes}, {}, {}};
  const double phase = 0.7 * cord.seed, length = 110.0;
  const double wave = 2.0 * std::numbers::pi / length, bend = std::tan(cord.bend * kDegree);
  for (int k = 0; k < cord.points.z; ++k) {
    for (int j = 0; j < cord.points.y; ++j) {
      for (int i = 0; i < cord.points.x; ++i) {
        const Vec3 image = cord.step * (Vec3(i, j, k) - 0.5 * Vec3(cord.points - 1));
        Vec3 body{0.0};
        for (int a = 0; a < 3; ++a) body[cord.axes[as_size(a)]] = image[a];
        const double height = body.z;
        const double middle = bend / wave * (std::sin(wave * height + phase) - std::sin(phase)) +
                              cord.distorted * std::sin(3.3 * wave * height + 2.0 * phase);
        const double slope = bend * std::cos(wave * height + phase);
        const double u = body.x - std::tan(cord.tilt * kDegree) * height, v = body.y - middle;
        const Vec3 along = glm::normalize(Vec3{std::tan(cord.tilt * kDegree), slope, 1.0});
        Vec3 fibre{0.0};
        for (int a = 0; a < 3; ++a) fibre[a] = along[cord.axes[as_size(a)]];
        const double r = std::hypot(u / 6.5, v / 4.5), canal = std::hypot(u / 10.0, v / 8.0);
        const bool grey = std::pow((std::abs(u) - 1.6) / 1.2, 2) + std::pow(v / 2.7, 2) < 1.0;
        const double in = 1.0 / (1.0 + std::exp(std::clamp((r - 1.0) / 0.06, -30.0, 30.0)));
        const Mat3 dyad = glm::outerProduct(fibre, fibre);
        const Mat3 white = Mat3{0.45} + 1.7 * dyad, inner = Mat3{0.7} + 0.7 * dyad;
        Mat3 t = in * (grey ? inner : white) + (1.0 - in) * Mat3{canal < 1.0 ? 3.2 : 0.9};
        for (int c = 0; c < 3; ++c) {
          for (int row = c; row < 3; ++row) {
            t[c][row] += cord.noise * normal(random);
            t[row][c] = t[c][row];
          }
        }
        if (cord.masked && canal >= 1.0) {
          out.tensors.insert(out.tensors.end(), 6, kNone);
        } else {
          add(t, out.tensors);
        }
        if (r < 0.8) out.fibres.push_back(fibre);
      }
    }
  }
  return out;
}

OrientationVerdict judged(const Made& image, const Mat3& turn) {
  std::vector<float> tensors;
  for (std::size_t at = 0; at < image.tensors.size(); at += 6) {
    const float* const d = image.tensors.data() + at;
    add(turn * Mat3{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}} *
            glm::transpose(turn),
        tensors);
  }
  return check_orientation(DirectionMap(tensors, image.topology, 1), image.topology, {}, 1);
}

/// How far a turn leaves the fibres from where they are, in the median [degrees].
double left_by(const Made& image, const Mat3& turn) {
  std::vector<double> angles;
  for (const Vec3& fibre : image.fibres)
    angles.push_back(std::acos(std::min(1.0, std::abs(glm::dot(fibre, turn * fibre)))) / kDegree);
  const auto middle = angles.begin() + static_cast<std::ptrdiff_t>(angles.size() / 2);
  std::ranges::nth_element(angles, middle);
  return *middle;
}

/// Tables that are met: a sign, two rows, all rows.
const std::vector<AxisTurn> kWrong{{{0, 1, 2}, {true, false, false}},  {{0, 1, 2}, {false, true, false}},
                                   {{0, 1, 2}, {false, false, true}},  {{1, 0, 2}, {false, false, false}},
                                   {{0, 2, 1}, {false, false, false}}, {{2, 0, 1}, {false, false, false}},
                                   {{2, 1, 0}, {false, false, false}}};

/// The cords of a row of hospitals: bent or straight, tilted, distorted, in slices of any kind.
std::vector<Cord> cords() {
  const std::array<std::pair<Vec3, Index3>, 4> lattices{{{Vec3{1.0, 1.0, 4.0}, Index3{28, 32, 20}},
                                                         {Vec3{0.9, 0.9, 5.0}, Index3{30, 36, 14}},
                                                         {Vec3{1.5}, Index3{22, 26, 46}},
                                                         {Vec3{2.0}, Index3{16, 20, 40}}}};
  std::vector<Cord> all;
  for (unsigned n = 0; n < 24; ++n) {
    Cord cord{.seed = n + 1,
              .bend = std::array{0.0, 5.0, 10.0, 18.0}[n % 4],
              .tilt = std::array{0.0, 2.0, -3.0}[n % 3],
              .distorted = std::array{0.0, 0.5, 1.0, 1.5}[n / 4 % 4],
              .noise = std::array{0.05, 0.1, 0.2, 0.3}[n / 3 % 4],
              .step = lattices[n / 2 % 4].first,
              .points = lattices[n / 2 % 4].second,
              .masked = n % 5 == 4};
    if (n % 6 == 5) {  // slices from left to right
      cord.axes = {2, 1, 0};
      cord.step = {1.0, 1.0, 2.5};
      cord.points = {64, 32, 11};
    }
    all.push_back(cord);
  }
  return all;
}

TEST(SpinalCords, ThatAreRightGetNoAdviceAndWrongOnesNoneThatLeavesThemWrong) {
  const std::vector<Cord> all = cords();
  std::size_t across = 0, told = 0, leant = 0;
  for (std::size_t n = 0; n < samples_of(all.size()); ++n) {
    const Made image = made(all[n]);
    const OrientationVerdict right = judged(image, Mat3{1.0});
    EXPECT_FALSE(right.suspicious) << n << ": " << right.advice << " B " << right.across;
    EXPECT_TRUE(right.judged) << n;
    for (const AxisTurn& wrong : kWrong) {
      const OrientationVerdict verdict = judged(image, wrong.matrix());
      const double off = left_by(image, wrong.matrix());
      constexpr double kAcross = 45.0, kNear = 10.0;  // degrees
      across += off > kAcross ? 1 : 0;
      EXPECT_TRUE(verdict.suspicious || off < kAcross) << n << " " << wrong.text() << " B " << verdict.across;
      if (!verdict.suspicious || verdict.rotated) continue;
      told += off > kAcross ? 1 : 0;
      leant += off < kAcross && verdict.by_borders ? 1 : 0;
      EXPECT_LT(left_by(image, verdict.best.turn.matrix() * wrong.matrix()), kNear)
          << n << " " << wrong.text() << ": " << verdict.advice << " B " << verdict.across << " "
          << verdict.across_best;
    }
  }
  EXPECT_EQ(told, across);
  EXPECT_GT(across, 0U);
  EXPECT_GT(leant, 0U) << "flips of cords that bend";
}

// A neck bends enough for flips of its plane; a flip across that leaves its fibres where they are, and is named as alike.
TEST(SpinalCords, ThatAreBentTellFlipsInTheirPlane) {
  const Made image = made({.seed = 3, .bend = 18.0, .noise = 0.2, .points = {28, 48, 27}});
  for (const std::size_t axis : {1U, 2U}) {
    AxisTurn flip;
    flip.flipped[axis] = true;
    const OrientationVerdict verdict = judged(image, flip.matrix());
    EXPECT_TRUE(verdict.suspicious) << flip.text();
    EXPECT_FALSE(verdict.rotated) << flip.text() << ": " << verdict.advice << ", borders "
                                  << verdict.by_borders;
    EXPECT_LT(left_by(image, verdict.best.turn.matrix() * flip.matrix()), 1.0) << verdict.advice;
  }
  EXPECT_EQ(std::ranges::count(judged(image, Mat3{1.0}).alike, "--flip i"), 1);
}

/// Uniform fibres with noise, in voxels that are long along the third axis.
Made noisy(const Vec3& main, const Index3& points, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 0.1);
  Made out{{points, Vec3{0.0}, Mat3{Vec3{0.9, 0.0, 0.0}, Vec3{0.0, 0.9, 0.0}, Vec3{0.0, 0.0, 5.0}}}, {}, {}};
  for (int p = 0; p < points.x * points.y * points.z; ++p) {
    Mat3 t = Mat3{0.45} + 1.7 * glm::outerProduct(main, main);
    for (int c = 0; c < 3; ++c) {
      for (int row = c; row < 3; ++row) {
        t[c][row] += normal(random);
        t[row][c] = t[c][row];
      }
    }
    add(t, out.tensors);
  }
  return out;
}

// Their noise has steep gradients across short sides of voxels: a structure tensor of one estimate would take them for
// borders along the long side.
TEST(BorderCheck, TakesNoNoiseForBorders) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const OrientationVerdict verdict = judged(noisy({1.0, 0.0, 0.0}, {20, 18, 12}, seed), Mat3{1.0});
    EXPECT_FALSE(verdict.by_borders) << seed << ": " << verdict.advice << " B " << verdict.across;
    EXPECT_FALSE(verdict.suspicious) << seed;
  }
}

// A rod that a mask cut out of fibres that run across it: its sides are no borders.
TEST(BorderCheck, TakesNoMaskForABorder) {
  Made rod = noisy({1.0, 0.0, 0.0}, {24, 24, 24}, 5);
  for (std::size_t p = 0; p < rod.tensors.size() / 6; ++p) {
    const double u = static_cast<double>(p % 24) - 11.5, v = static_cast<double>(p / 24 % 24) - 11.5;
    if (std::hypot(u, v) > 7.0)
      std::fill_n(rod.tensors.begin() + static_cast<std::ptrdiff_t>(6 * p), 6, kNone);
  }
  const OrientationVerdict verdict = judged(rod, Mat3{1.0});
  EXPECT_FALSE(verdict.by_borders) << verdict.advice << " B " << verdict.across;
  EXPECT_FALSE(verdict.suspicious);
}

}  // namespace
}  // namespace palpate::test
