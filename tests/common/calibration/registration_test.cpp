// Registration of instruments with unknown markers, coregistration, and poses from markers.

#include "common/calibration/registration.h"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/synthetic.h"

namespace palpate::test {
namespace {

constexpr RegistrationNoise kNoise;  // as the options' own

double angle_between(const Quat& a, const Quat& b) { return angle_of(a * glm::conjugate(b)); }

TEST(Apparatus, FindsInstrumentAndMarkersFromAnyStart) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto made = synthetic_apparatus(seed, kNoise);
    const Registration found =
        calibrate_registration({"made", made.rows}, RegistrationKind::kApparatus, {.noise = kNoise});
    EXPECT_LT(angle_between(found.instrument_from_pose.rotation, made.truth.instrument_from_pose.rotation),
              0.01);
    ASSERT_EQ(found.markers.size(), made.truth.markers.size());
    for (std::size_t m = 0; m < found.markers.size(); ++m)
      EXPECT_LT(glm::distance(found.markers[m], made.truth.markers[m]), 3e-3);
    EXPECT_LT(found.report.condition_number, kReliableCondition);
    ASSERT_NE(found.report.find("fitted", "distance", true), nullptr);
  }
}

// The noise is what was assumed, so chi-square must be what its degrees of freedom say: over many seeds the
// mean is the degrees of freedom, and the truth lies within its stated deviations as often as it should.
TEST(Apparatus, StatesItsUncertaintyHonestly) {
  double chi_square = 0.0, degrees = 0.0, squared = 0.0, count = 0.0;
  for (std::uint64_t seed = 11; seed <= 25; ++seed) {
    const auto made = synthetic_apparatus(seed, kNoise);
    const Registration found = calibrate_registration({"made", made.rows}, RegistrationKind::kApparatus,
                                                      {.noise = kNoise, .folds = 1000});
    chi_square += *found.report.chi_square;
    degrees += static_cast<double>(found.report.degrees_of_freedom);
    for (const FittedParameter& p : found.report.parameters) {
      if (p.name[0] != 'r') continue;
      const auto marker = static_cast<std::size_t>(p.name[1] - '1');
      const double off = p.value - made.truth.markers[marker][p.name[3] - 'x'];
      squared += off * off / (p.deviation * p.deviation);
      count += 1.0;
    }
  }
  // Deviations of a chi-square of k degrees are sqrt(2 k): 15 runs of about 200 degrees scatter by 2.6 %.
  EXPECT_NEAR(chi_square / degrees, 1.0, 0.08);
  EXPECT_NEAR(squared / count, 1.0, 0.35);
}

TEST(Apparatus, RefusesPosesThatDoNotTurn) {
  auto made = synthetic_apparatus(1, kNoise);
  for (MarkerMeasurement& row : made.rows) row.pose.orientation = identity_rotation();
  for (MarkerMeasurement& row : made.rows) {
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (row.markers[m])
        row.markers[m] = made.truth.instrument_from_pose * (row.pose.position + made.truth.markers[m]);
    }
  }
  try {
    (void)calibrate_registration({"fixed.csv", made.rows}, RegistrationKind::kApparatus, {.noise = kNoise});
    FAIL() << "orientations that never change leave p0 and the markers open";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    EXPECT_NE(std::string(error.what()).find("turn about two axes"), std::string::npos) << error.what();
  }
}

// Ikits 2006, sec. 4.4: 1.5 mm between the devices.
TEST(Coregistration, AgreesWithin1500Micrometres) {
  const RegistrationNoise noise{.pose_position = 0.4e-3, .pose_orientation = 1.5e-3, .marker = 0.5e-3};
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    const auto made = synthetic_coregistration(seed, noise);
    const Registration found =
        calibrate_registration({"made", made.rows}, RegistrationKind::kCoregistration, {.noise = noise});
    EXPECT_EQ(found.report.parameters.size(), 10U);  // nine, the rotation written as four
    const ErrorRow* left_out = found.report.find("fitted", "distance", true);
    ASSERT_NE(left_out, nullptr);
    EXPECT_LT(left_out->errors.mean, 1.5);
    // Places where nothing was measured, against the truth.
    for (const double x : {-0.1, 0.3, 0.8}) {
      const Vec3 p{x, 0.2, 0.1};
      EXPECT_LT(glm::distance(found.instrument_from_pose * p, made.truth.instrument_from_pose * p), 1.5e-3);
    }
    EXPECT_LT(glm::distance(found.markers[0], made.truth.markers[0]), 1.5e-3);
  }
}

// Markers that a camera took for others, by centimetres: the motion is found as if they were not there, and
// the rows are named.
TEST(Apparatus, RobustLossesWithstandMarkersThatWereTakenForOthers) {
  auto made = synthetic_apparatus(2, kNoise);
  for (const std::size_t row : {3U, 11U}) {
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (!made.rows[row].markers[m]) continue;
      *made.rows[row].markers[m] += Vec3{0.03, -0.04, 0.05};
      break;
    }
  }
  const auto fit = [&](Loss loss) {
    return calibrate_registration({"made", made.rows}, RegistrationKind::kApparatus,
                                  {.noise = kNoise, .loss = loss, .folds = 1000});
  };
  const auto off = [&](const Registration& found) {
    double worst = 0.0;
    for (std::size_t m = 0; m < found.markers.size(); ++m)
      worst = std::max(worst, glm::distance(found.markers[m], made.truth.markers[m]));
    return worst;
  };
  const Registration plain = fit(Loss::kSquare);
  EXPECT_GT(off(plain), 5e-3);
  ASSERT_FALSE(plain.report.advice.empty());
  EXPECT_NE(plain.report.advice[0].find("chi-square is too large"), std::string::npos);
  for (const Loss loss : {Loss::kHuber, Loss::kCauchy}) {
    const Registration robust = fit(loss);
    EXPECT_LT(off(robust), 3e-3);
    EXPECT_LT(angle_between(robust.instrument_from_pose.rotation, made.truth.instrument_from_pose.rotation),
              0.01);
    EXPECT_EQ(robust.report.outliers, (std::vector<std::size_t>{4, 12}));
  }
}

TEST(Coregistration, RobustLossesWithstandASensorThatJumped) {
  const RegistrationNoise noise{.pose_position = 0.4e-3, .pose_orientation = 1.5e-3, .marker = 0.5e-3};
  auto made = synthetic_coregistration(3, noise);
  for (const std::size_t row : {2U, 9U, 20U}) *made.rows[row].markers[0] += Vec3{-0.06, 0.03, 0.05};
  const auto off = [&](Loss loss) {
    const Registration found = calibrate_registration({"made", made.rows}, RegistrationKind::kCoregistration,
                                                      {.noise = noise, .loss = loss, .folds = 1000});
    if (loss != Loss::kSquare) {
      EXPECT_EQ(found.report.outliers, (std::vector<std::size_t>{3, 10, 21}));
    }
    double worst = 0.0;
    for (const double x : {-0.1, 0.3, 0.8}) {
      const Vec3 p{x, 0.2, 0.1};
      worst =
          std::max(worst, glm::distance(found.instrument_from_pose * p, made.truth.instrument_from_pose * p));
    }
    return worst;
  };
  EXPECT_GT(off(Loss::kSquare), 4e-3);
  EXPECT_LT(off(Loss::kHuber), 1.5e-3);
  EXPECT_LT(off(Loss::kCauchy), 1.5e-3);
}

TEST(AlignPoints, IsExactForThreePointsAndRefusesALine) {
  std::mt19937_64 random{4};
  const auto made = synthetic_apparatus(3, {});
  for (int i = 0; i < 100; ++i) {
    const Rigid pose{random_rotation(random), {0.1 * i, -0.3, 0.7}};
    std::vector<Vec3> model, measured;
    for (int k = 0; k < 3; ++k) {
      // Any three that are not two opposite ones and another in line: here never collinear.
      const auto m = static_cast<std::size_t>((i + 2 * k + k / 2) % 6);
      model.push_back(made.truth.markers[m]);
      measured.push_back(pose * model.back());
    }
    const auto found = align_points(model, measured);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::distance(found->to_from_from.translation, pose.translation), 1e-12);
    EXPECT_LT(angle_between(found->to_from_from.rotation, pose.rotation), 1e-7);
  }
  const std::vector<Vec3> line{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}};
  EXPECT_FALSE(align_points(line, line));
  EXPECT_FALSE(align_points(std::span(line).first(2), std::span(line).first(2)));
}

}  // namespace
}  // namespace palpate::test
