// Distortion of a tracker: against a made workbench whose metal obeys magnetostatics, and against laws.

#include "common/calibration/tracker_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/calibration/metal_fit.h"
#include "common/calibration/synthetic.h"
#include "common/calibration/tracker_checks.h"

namespace palpate::test {
namespace {

double mean_of(const FitReport& report, const std::string& method, const std::string& quantity) {
  const ErrorRow* row = report.find(method, quantity, true);
  return row ? row->errors.mean : NAN;
}

// Without metal the made tracker tells the truth: its inversion shares nothing with the field but Raab's
// formula.
TEST(SyntheticTracker, TellsTheTruthWithoutMetal) {
  std::mt19937_64 random{1};
  const SyntheticTracker clean;
  for (int i = 0; i < 100; ++i) {
    const double t = 0.1 * i;
    const TrackerPose actual{{std::cos(t), 0.3 + std::sin(t), 0.5 * std::sin(3.0 * t)},
                             random_rotation(random)};
    const TrackerPose read = clean.reading(actual);
    EXPECT_LT(glm::distance(read.position, actual.position), 1e-12);
    EXPECT_LT(angle_of(read.orientation * glm::conjugate(actual.orientation)), 1e-7);
  }
}

// The printed result on real hardware (Ikits 2006, table 4.1): 88.6 % and 80.3 % with degree 4.
TEST(TrackerFit, ReachesTheReductionOfTable41AndTheCombinedMethodMore) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const MeasurementTable<TrackerMeasurement> table{
        "made", synthetic_tracker_measurements(synthetic_tracker(seed), seed)};
    const FitReport report = calibrate_tracker(table, {.table_nodes = 24}).report;
    // Of 120 random poses: the mean of errors that scatter by 30 mm is good to 3 mm.
    EXPECT_NEAR(mean_of(report, "before", "position"), 42.3, 6.0);
    EXPECT_NEAR(mean_of(report, "before", "orientation"), 4.72, 0.6);
    for (const char* quantity : {"position", "orientation"}) {
      const double before = mean_of(report, "before", quantity);
      const double least = quantity[0] == 'p' ? 0.88 : 0.80;
      EXPECT_LE(mean_of(report, "polynomial", quantity), (1.0 - least) * before) << quantity;
      EXPECT_LT(mean_of(report, "combined", quantity), 0.75 * mean_of(report, "polynomial", quantity))
          << quantity;
    }
    EXPECT_LT(report.condition_number, kReliableCondition);
    EXPECT_FALSE(report.work_precision.empty());
  }
}

// The made bench's metal is found by its principle: its error of the places and strengths is none of a fit's own.
TEST(TrackerFit, AModelOfTheMetalBeatsThePolynomial) {
  for (const std::uint64_t seed : {1U, 2U}) {
    SCOPED_TRACE(seed);
    const std::vector<TrackerMeasurement> rows =
        synthetic_tracker_measurements(synthetic_tracker(seed), seed);
    std::vector<TrackerMeasurement> fit, judged;
    for (const TrackerMeasurement& row : rows) (row.validation ? judged : fit).push_back(row);
    const auto mean_left = [&](TrackerMethod method) {
      const TrackerCorrection correction = fit_tracker(fit, {.method = method});
      Left sum;
      for (const TrackerMeasurement& row : judged) {
        const Left left = left_by(correction, row);
        sum.position += left.position / static_cast<double>(judged.size());
        sum.orientation += left.orientation / static_cast<double>(judged.size());
      }
      return sum;
    };
    const Left polynomial = mean_left(TrackerMethod::kPolynomial),
               combined = mean_left(TrackerMethod::kCombined);
    for (const TrackerMethod method : {TrackerMethod::kDipoles, TrackerMethod::kCombinedDipoles}) {
      const Left left = mean_left(method);
      std::printf("  %s: %.2f mm, %.3f deg; polynomial %.2f, %.3f; combined %.2f, %.3f\n",
                  name_of(method).c_str(), 1e3 * left.position, left.orientation / kDegree,
                  1e3 * polynomial.position, polynomial.orientation / kDegree, 1e3 * combined.position,
                  combined.orientation / kDegree);
      EXPECT_LT(left.position, 0.6 * polynomial.position);
      EXPECT_LT(left.orientation, 0.6 * polynomial.orientation);
    }
  }
}

// The field does not pass a perfect conductor: across it is nothing, whichever coil is on and wherever on it.
TEST(MetalModel, NoFieldPassesAPerfectSheet) {
  const Vec3 foot{0.3, -0.2, -0.9}, n = glm::normalize(foot);
  const MetalModel sheet{{{MetalSource::Kind::kSheet, foot, 1.0}}};
  for (int i = 0; i < 20; ++i) {
    const Vec3 any{std::sin(3.0 * i), std::cos(2.0 * i), std::sin(i + 1.0)};
    const Vec3 on = foot + any - glm::dot(any, n) * n;
    EXPECT_LT(glm::length(n * sheet.field_at(on)), 1e-12);
    // What is read where the sensor is leads back to there.
    const Vec3 above = 0.4 * n + 0.3 * any - 0.8 * n;
    if (glm::length(above) < 0.2) continue;
    const PoseError e = sheet.error_of(above);
    EXPECT_LT(glm::distance(sheet.error_at(above - e.position).position, e.position), 1e-9);
  }
}

/// Poses through a cube whose errors are `error` of the place, exactly.
template <typename Error>
std::vector<TrackerMeasurement> exact_measurements(std::size_t count, const Vec3& size, const Error& error) {
  std::mt19937_64 random{9};
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<TrackerMeasurement> out;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = uniform(random), y = uniform(random), z = uniform(random);
    const TrackerPose reported{Vec3{x, y, z} * size, random_rotation(random)};
    const PoseError e = error(reported.position);
    out.push_back(
        {reported,
         {reported.position + e.position, rotation_with_vector_part(e.orientation) * reported.orientation},
         false});
  }
  return out;
}

PoseError cubic(const Vec3& p) {
  return {0.01 * Vec3{p.x * p.y * p.z, p.x * p.x - p.y, 1.0 + p.z * p.z * p.z},
          0.02 * Vec3{p.y, p.x * p.z, p.y * p.y * p.y}};
}

TEST(TrackerFit, ReproducesAPolynomialOfItsDegreeExactly) {
  const auto rows = exact_measurements(80, {1.0, 0.8, 0.6}, cubic);
  const TrackerCorrection fit = fit_tracker(rows, {.method = TrackerMethod::kPolynomial, .degree = 3});
  for (const TrackerMeasurement& row : exact_measurements(300, {0.9, 0.7, 0.5}, cubic)) {
    const TrackerPose pose = fit.corrected(row.reported);
    EXPECT_LT(glm::distance(pose.position, row.actual.position), 1e-12);
    EXPECT_LT(angle_of(pose.orientation * glm::conjugate(row.actual.orientation)), 1e-7);
  }
}

TEST(TrackerFit, SplineAndTableApproachASmoothField) {
  const auto rows = exact_measurements(400, {1.0, 0.8, 0.6}, cubic);
  for (const TrackerMethod method : {TrackerMethod::kSpline, TrackerMethod::kTable}) {
    const TrackerCorrection fit = fit_tracker(rows, {.method = method, .table_nodes = 20});
    double worst = 0.0;
    for (const TrackerMeasurement& row : exact_measurements(300, {0.8, 0.6, 0.4}, cubic))
      worst = std::max(worst, glm::distance(fit.corrected(row.reported).position, row.actual.position));
    EXPECT_LT(worst, 1.5e-3) << name_of(method);  // of errors up to 20 mm
  }
}

TEST(TrackerFit, HuberWithstandsGrossErrorsAndTheReportNamesThem) {
  auto rows = exact_measurements(200, {1.0, 0.8, 0.6}, cubic);
  std::mt19937 random{3};
  std::normal_distribution<double> normal(0.0, 5e-4);
  for (TrackerMeasurement& row : rows) row.actual.position += Vec3{normal(random), 0.0, 0.0};
  for (const std::size_t i : {10U, 90U, 150U}) rows[i].actual.position += Vec3{0.3, 0.0, -0.2};
  const TrackerFitOptions plain{.method = TrackerMethod::kPolynomial, .degree = 3};
  TrackerFitOptions robust = plain;
  robust.loss = Loss::kHuber;
  const auto error = [&](const TrackerFitOptions& options) {
    const TrackerCorrection fit = fit_tracker(rows, options);
    double sum = 0.0;
    for (const TrackerMeasurement& row : exact_measurements(100, {0.8, 0.6, 0.4}, cubic))
      sum += glm::distance(fit.corrected(row.reported).position, row.actual.position) / 100.0;
    return sum;
  };
  EXPECT_LT(error(robust), 0.1 * error(plain));
  const std::vector<std::size_t> named = calibrate_tracker({"made", rows}, robust).report.outliers;
  for (const std::size_t row : {11U, 91U, 151U})
    EXPECT_NE(std::find(named.begin(), named.end(), row), named.end()) << row;
  EXPECT_LE(named.size(), 8U);
}

// A seventh of the poses grossly wrong: every method finds the field as if they were not there, Cauchy's loss
// nearer than Huber's, which never lets go of them.
TEST(TrackerFit, EveryMethodIsRobust) {
  auto rows = exact_measurements(300, {1.0, 0.8, 0.6}, cubic);
  for (std::size_t i = 3; i < rows.size(); i += 7)
    rows[i].actual.position += Vec3{0.2, i % 2 == 0 ? 0.3 : 0.1, -0.2};
  const auto error = [&](TrackerMethod method, Loss loss) {
    const TrackerCorrection fit =
        fit_tracker(rows, {.method = method, .degree = 3, .loss = loss, .table_nodes = 20});
    double sum = 0.0;
    for (const TrackerMeasurement& row : exact_measurements(100, {0.8, 0.6, 0.4}, cubic))
      sum += glm::distance(fit.corrected(row.reported).position, row.actual.position) / 100.0;
    return sum;
  };
  for (const TrackerMethod method :
       {TrackerMethod::kPolynomial, TrackerMethod::kTable, TrackerMethod::kSpline, TrackerMethod::kCombined,
        TrackerMethod::kCombinedSpline}) {
    const double plain = error(method, Loss::kSquare);
    EXPECT_GT(plain, 5e-3) << name_of(method);
    for (const Loss loss : {Loss::kHuber, Loss::kCauchy})
      EXPECT_LT(error(method, loss), 2e-3)
          << name_of(method) << (loss == Loss::kHuber ? " huber" : " cauchy");
  }
  EXPECT_LT(error(TrackerMethod::kPolynomial, Loss::kCauchy),
            0.5 * error(TrackerMethod::kPolynomial, Loss::kHuber) + 1e-9);
}

TEST(TrackerFit, NamesSlipsOfUnitsAndConventions) {
  using Change = void (*)(TrackerMeasurement&);
  // Of x, y, z, w the first is read as w.
  const std::array<std::pair<Change, const char*>, 7> slips{{
      {[](TrackerMeasurement& row) { row.reported.position *= 1e3; },
       "reported positions look like millimetres"},
      {[](TrackerMeasurement& row) { row.actual.position *= 1e3; }, "actual positions look like millimetres"},
      {[](TrackerMeasurement& row) {
         row.actual.position *= 1e3;
         row.reported.position *= 1e3;
       },
       "all positions look like millimetres"},
      {[](TrackerMeasurement& row) { row.reported.position /= 0.0254; },
       "reported positions look like inches"},
      {[](TrackerMeasurement& row) {
         const Quat q = row.reported.orientation;
         row.reported.orientation = Quat{q.x, q.y, q.z, q.w};
       },
       "reported quaternions look like x, y, z, w"},
      {[](TrackerMeasurement& row) {
         const Quat q = row.actual.orientation;
         row.actual.orientation = Quat{q.x, q.y, q.z, q.w};
       },
       "actual quaternions look like x, y, z, w"},
      {[](TrackerMeasurement& row) { row.reported.orientation = glm::conjugate(row.reported.orientation); },
       "conjugates"},
  }};
  for (const auto& [slip, words] : slips) {
    auto rows = exact_measurements(120, {1.0, 0.8, 0.6}, cubic);
    for (TrackerMeasurement& row : rows) slip(row);
    std::string line = "accepted";
    try {
      (void)calibrate_tracker({"poses.csv", rows}, {.degree = 2});
    } catch (const Error& error) {
      line = error.what();
    }
    EXPECT_NE(line.find(words), std::string::npos) << line;
  }
}

TEST(TrackerFit, FailsWhereItLeavesAsMuchAsThereWas) {
  // Errors that have nothing to do with the place.
  auto rows = exact_measurements(200, {1.0, 0.8, 0.6}, cubic);
  std::mt19937 random{5};
  std::normal_distribution<double> normal(0.0, 0.03);
  for (TrackerMeasurement& row : rows)
    row.actual.position = row.reported.position + Vec3{normal(random), normal(random), normal(random)};
  std::string line = "accepted";
  try {
    (void)calibrate_tracker({"poses.csv", rows}, {.method = TrackerMethod::kPolynomial, .degree = 3});
  } catch (const Error& error) {
    line = error.what();
  }
  EXPECT_NE(line.find("leaves"), std::string::npos) << line;
}

std::string refusal(const std::vector<TrackerMeasurement>& rows, int degree) {
  try {
    (void)fit_tracker(rows, {.degree = degree}, "poses.csv");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kBadInput);
    return error.what();
  }
  return "";
}

TEST(TrackerFit, RefusesTooFewAndFlatMeasurementsAndSaysWhatToMeasure) {
  EXPECT_NE(refusal(exact_measurements(30, {1.0, 1.0, 1.0}, cubic), 4).find("degree 3 at most"),
            std::string::npos);
  const std::string flat = refusal(exact_measurements(200, {1.0, 1.0, 1e-4}, cubic), 2);
  EXPECT_NE(flat.find("near a plane"), std::string::npos) << flat;
  EXPECT_NE(flat.find("poses.csv"), std::string::npos) << flat;
  EXPECT_NE(refusal({}, 1).find("10 at least"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
