// The check of axes has nothing against right images whose fibres say nothing of their axes.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/orientation_check.h"

namespace palpate::test {
namespace {

struct Made {
  UniformTopology topology;
  std::vector<float> tensors;
};

/// Voxels of a uniform tensor along `main`, in a box of 12 x 10 x 8 or another size.
Made uniform(const Vec3& main, const Vec3& step, const Index3& points = {12, 10, 8}) {
  Made made{{points, Vec3{0.0}, Mat3{Vec3{step.x, 0.0, 0.0}, Vec3{0.0, step.y, 0.0}, Vec3{0.0, 0.0, step.z}}},
            {}};
  const Vec3 d = glm::normalize(main);
  for (int p = 0; p < points.x * points.y * points.z; ++p) {
    const Mat3 t = Mat3{0.3} + 1.4 * glm::outerProduct(d, d);
    for (const double value : {t[0][0], t[1][0], t[2][0], t[1][1], t[2][1], t[2][2]})
      made.tensors.push_back(static_cast<float>(value));
  }
  return made;
}

TEST(UniformFibres, AreRightInVoxelsOfAnyShape) {
  for (const Vec3& step :
       {Vec3{2.0}, Vec3{2.0, 2.0, 3.0}, Vec3{3.0, 2.0, 2.0}, Vec3{1.0, 1.0, 5.0}, Vec3{0.8, 2.5, 1.2}}) {
    for (const Vec3& main : {Vec3{1, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 1}, Vec3{1, 2, 3}, Vec3{1, 1, 0}}) {
      for (const Index3& points : {Index3{12, 10, 8}, Index3{30, 20, 1}}) {
        const Made made = uniform(main, step, points);
        const OrientationVerdict verdict =
            check_orientation(DirectionMap(made.tensors, made.topology, 1), made.topology, {}, 1);
        EXPECT_FALSE(verdict.suspicious) << verdict.advice << " gain " << verdict.gain;
        EXPECT_NEAR(verdict.gain, 1.0, 1e-5);
        EXPECT_FALSE(verdict.judged) << "one direction lies as well along any axes";
      }
    }
  }
}

// Two uniform halves that touch in a plane which both run along; and fibres with noise in their directions.
TEST(UniformFibres, AreRightInCrossingLayersAndWithNoise) {
  for (const Vec3& step : {Vec3{2.0}, Vec3{2.0, 2.0, 3.0}, Vec3{2.0, 3.0, 2.0}, Vec3{3.0, 2.0, 2.0}}) {
    Made layers = uniform({1, 0, 0}, step), noisy = layers;
    const Made other = uniform({0, 1, 0}, step);
    const std::size_t half = layers.tensors.size() / 2;  // k < 4
    std::copy(other.tensors.begin(), other.tensors.begin() + static_cast<std::ptrdiff_t>(half),
              layers.tensors.begin());
    unsigned random = 7;
    for (std::size_t v = 0; v < noisy.tensors.size(); v += 6) {
      Vec3 d{1.0, 0.0, 0.0};
      for (int c = 1; c < 3; ++c) {
        random = random * 1664525U + 1013904223U;
        d[c] = 0.4 * (static_cast<double>(random >> 8U) / 16777216.0 - 0.5);
      }
      const Made one = uniform(d, step, {1, 1, 1});
      std::copy(one.tensors.begin(), one.tensors.end(),
                noisy.tensors.begin() + static_cast<std::ptrdiff_t>(v));
    }
    for (const Made& made : {layers, noisy}) {
      const OrientationVerdict verdict =
          check_orientation(DirectionMap(made.tensors, made.topology, 1), made.topology, {}, 1);
      EXPECT_FALSE(verdict.suspicious) << verdict.advice << " gain " << verdict.gain;
    }
  }
}

// Smooth directions that know nothing of the lines along which they change: one turn or another lines up a little
// better by chance, and nothing speaks against any.
TEST(SmoothFibres, AreRightWhereNoTurnLinesUp) {
  const double c = std::cos(0.35), s = std::sin(0.35);
  for (int phase = 0; phase < 8; ++phase) {
    Made made = uniform({1, 0, 0}, {2.0, 2.2, 2.5}, {14, 12, 10});
    made.topology.axes = Mat3{Vec3{-c, -s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1.0}} * made.topology.axes;
    std::size_t at = 0;
    for (int k = 0; k < 10; ++k) {
      for (int j = 0; j < 12; ++j) {
        for (int i = 0; i < 14; ++i) {
          const double t = 0.8 * phase;
          const Vec3 d{1.0 + 0.3 * std::sin(0.31 * j + t), 0.9 * std::sin(0.23 * i + 0.19 * k + t),
                       0.9 * std::cos(0.27 * j - 0.21 * k + 2.0 * t)};
          const Made one = uniform(d, Vec3{1.0}, {1, 1, 1});
          std::copy(one.tensors.begin(), one.tensors.end(),
                    made.tensors.begin() + static_cast<std::ptrdiff_t>(at));
          at += 6;
        }
      }
    }
    const OrientationVerdict verdict =
        check_orientation(DirectionMap(made.tensors, made.topology, 1), made.topology, {}, 1);
    EXPECT_FALSE(verdict.suspicious) << phase << ": " << verdict.advice << " gain " << verdict.gain;
  }
}

}  // namespace
}  // namespace palpate::test
