#include "common/geometry/hermite.h"

#include <algorithm>
#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace palpate {
namespace {

/// A helix of radius 2 and rise 0.5 a radian, by its arc length.
struct Helix {
  double radius = 2.0, rise = 0.5;
  double rate = 1.0 / std::hypot(radius, rise);

  [[nodiscard]] Vec3 at(double s) const {
    return {radius * std::cos(rate * s), radius * std::sin(rate * s), rise * rate * s};
  }
  [[nodiscard]] Vec3 tangent(double s) const {
    return {-radius * rate * std::sin(rate * s), radius * rate * std::cos(rate * s), rise * rate};
  }
  [[nodiscard]] HermitePiece piece(double from, double length) const {
    return {at(from), tangent(from), at(from + length), tangent(from + length), length};
  }
};

TEST(Hermite, LeavesAHelixByTheFourthPowerOfItsLength) {
  const Helix helix;
  const auto gap = [&](double length) {
    const HermitePiece piece = helix.piece(0.3, length);
    double most = 0.0;
    for (int i = 0; i <= 64; ++i) {
      const double s = length * i / 64;
      most = std::max(most, glm::distance(piece.at(s), helix.at(0.3 + s)));
    }
    return most;
  };
  for (double length = 1.0; length > 0.1; length *= 0.5) {
    EXPECT_NEAR(gap(length) / gap(0.5 * length), 16.0, 0.3) << length;
  }
  // The remainder of cubic interpolation is |c''''| length^4 / 384 in the middle.
  const double fourth = helix.radius * std::pow(helix.rate, 4);
  EXPECT_NEAR(gap(0.25) / (fourth * std::pow(0.25, 4) / 384.0), 1.0, 0.01);
}

TEST(Hermite, HasItsEndsAndTangents) {
  std::mt19937 random{7};
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  const auto any = [&] { return Vec3{unit(random), unit(random), unit(random)}; };
  for (int i = 0; i < 100; ++i) {
    const HermitePiece piece{any(), glm::normalize(any()), any(), glm::normalize(any()), 1.5 + unit(random)};
    EXPECT_EQ(piece.at(0.0), piece.start);
    EXPECT_LE(glm::distance(piece.at(piece.length), piece.end), 4e-16);
    EXPECT_LE(glm::distance(piece.tangent(0.0), piece.start_tangent), 4e-15);
    EXPECT_LE(glm::distance(piece.tangent(piece.length), piece.end_tangent), 4e-15);
  }
}

TEST(Hermite, DerivativesAreThoseOfThePosition) {
  const HermitePiece piece = Helix{}.piece(-1.0, 1.7);
  constexpr double kStep = 1e-4;
  for (double s = 0.1; s < piece.length; s += 0.2) {
    const Vec3 before = piece.at(s - kStep), here = piece.at(s), after = piece.at(s + kStep);
    // A cubic has no fifth derivative: the error of both differences is rounding and kStep^2 / 6 c'''.
    EXPECT_LE(glm::distance(piece.tangent(s), (after - before) / (2.0 * kStep)), 1e-8) << s;
    EXPECT_LE(glm::distance(piece.bend(s), (after - 2.0 * here + before) / (kStep * kStep)), 1e-6) << s;
  }
}

TEST(Hermite, IsItselfWhereLengthsAreScaledByAPowerOfTwo) {
  const HermitePiece piece = Helix{}.piece(0.1, 0.9);
  HermitePiece large = piece;
  large.start *= 0x1p40;
  large.end *= 0x1p40;
  large.length *= 0x1p40;
  for (double s = 0.0; s <= piece.length; s += 0.09) {
    EXPECT_EQ(large.at(0x1p40 * s), 0x1p40 * piece.at(s));
    EXPECT_EQ(large.tangent(0x1p40 * s), piece.tangent(s));
    EXPECT_EQ(large.bend(0x1p40 * s), 0x1p-40 * piece.bend(s));
  }
}

}  // namespace
}  // namespace palpate
