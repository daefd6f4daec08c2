// The numbers of the tensor report beside theory: orders of convergence, proportion to noise.

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "lab/data/fit_errors.h"
#include "lab/data/tract_errors.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

const std::vector<TractErrors>& tracts() {
  static const std::vector<TractErrors> errors = run_tract_errors(Effort::kQuick, nullptr);
  return errors;
}

const FitErrors& fit() {
  static const FitErrors errors = run_fit_errors(spread_gradients(12), Effort::kQuick, 1, nullptr);
  return errors;
}

double end_error(const TractErrors& bundle, const std::string& method, double setting) {
  const auto row = std::ranges::find_if(
      bundle.rows, [&](const TractErrorRow& r) { return r.method == method && r.setting == setting; });
  return row == bundle.rows.end() ? std::nan("") : row->end;
}

TEST(TractErrors, FallWithTheOrderOfTheMethod) {
  for (const TractErrors& bundle : tracts()) {
    EXPECT_GE(bundle.lines, 8U) << bundle.bundle;
    EXPECT_NEAR(observed_order(bundle, "euler", 1e-4), 1.0, 0.2) << bundle.bundle;
    // Kinks at the faces of cells cost rk4 its order, but not its lead.
    EXPECT_GT(observed_order(bundle, "rk4", 2e-5), 1.3) << bundle.bundle;
    EXPECT_LT(end_error(bundle, "rk4", 0.5), 0.1 * end_error(bundle, "euler", 0.5)) << bundle.bundle;
    // dp54 keeps what it was asked for.
    EXPECT_LT(end_error(bundle, "dp54", 1e-4), 10.0 * 1e-4 * bundle.length) << bundle.bundle;
    EXPECT_LT(end_error(bundle, "dp54", 1e-6), 0.2 * end_error(bundle, "dp54", 1e-3)) << bundle.bundle;
    // The image is worth tracing: its own error is below its voxel.
    EXPECT_GT(bundle.image_end, 0.0);
    EXPECT_LT(bundle.image_end, bundle.voxel) << bundle.bundle;
    for (const TractErrorRow& row : bundle.rows) EXPECT_GT(row.seconds, 0.0);
  }
}

TEST(TractErrors, HaveAPeerOnTheSameCurvesOrSayWhyNot) {
  const std::string page = section_html(tract_errors_section(tracts()));
  for (const TractErrors& bundle : tracts()) {
    if (!bundle.why_no_peer.empty()) {
      EXPECT_NE(page.find(bundle.why_no_peer), std::string::npos);
      continue;
    }
    std::map<std::string, double> at;  // distance from the formula's end
    for (const TractPeerRow& row : bundle.peers) {
      EXPECT_GE(row.lines, 3U) << row.method;
      at[row.method + " " + row.setting] = row.end;
    }
    // Euler's error falls with the step, and is that of the curve's bend: much the same for both programs.
    const double coarse = at["tckgen Tensor_Det step=1"], fine = at["tckgen Tensor_Det step=0.2"];
    EXPECT_GT(coarse, 2.0 * fine) << bundle.bundle;
    EXPECT_LT(coarse, 5.0) << bundle.bundle << ": on the same bundle";
    EXPECT_GT(fine, 0.2 * at["euler step=0.2"]) << bundle.bundle;
    EXPECT_LT(fine, 5.0 * at["euler step=0.2"]) << bundle.bundle;
  }
}

TEST(FitErrors, AreInProportionToLittleNoise) {
  for (const StabilityCase& c : fit_error_cases(fit())) EXPECT_TRUE(c.row.holds) << c.row.measured;
  // More noise turns further at every weighting.
  for (std::size_t i = 0; i + 1 < fit().rows.size(); ++i) {
    for (std::size_t j = i + 1; j < fit().rows.size(); ++j) {
      const FitErrorRow &a = fit().rows[i], &b = fit().rows[j];
      if (a.weighting != b.weighting) continue;
      EXPECT_GT(a.median, b.median) << a.snr << " " << b.snr;
    }
  }
}

TEST(FitErrors, AreThoseOfTheGradientsGiven) {
  // Twice the directions halve the variance of an unbiased estimate: the angle falls by a root of two.
  const FitErrors more = run_fit_errors(spread_gradients(24), Effort::kQuick, 1, nullptr);
  for (std::size_t i = 0; i < fit().rows.size(); ++i) {
    // Strong weighting leaves so few of them with a signal that it matters which.
    if (fit().rows[i].snr < 500.0 || fit().rows[i].weighting > 2000.0) continue;
    EXPECT_NEAR(fit().rows[i].median / more.rows[i].median, std::sqrt(2.0), 0.25) << fit().rows[i].weighting;
  }
}

TEST(TensorReport, HasOnlyWhatConcernsTensors) {
  Report report;
  report.title = "dtmri: example helix";
  report.machine = this_machine();
  report.sections = {fit_errors_section(fit()), tract_errors_section(tracts())};
  report.stability = fit_error_cases(fit());
  for (StabilityCase& c : tract_error_cases(tracts())) {
    EXPECT_TRUE(c.row.holds) << c.row.name << " " << c.row.measured;
    report.stability.push_back(c);
  }
  const std::string page = report_page(report), json = report_json(report);
  for (const char* file : {"fit_angle.svg", "tract_end_helix.svg", "tract_end_kissing.svg",
                           "tract_direction_step.svg", "tract_direction_time.svg", "stability.csv"}) {
    EXPECT_NE(page.find(file), std::string::npos) << file;
  }
  EXPECT_NE(page.find(report.machine.processor), std::string::npos);
  for (const char* other :
       {"constraint.csv", "work_precision", "streamline", "Is the stated error honest?"}) {
    EXPECT_EQ(page.find(other), std::string::npos) << other;
  }
  EXPECT_EQ(json.find("\"reference\""), std::string::npos);
  EXPECT_NE(json.find("end point [mm], median"), std::string::npos);
  EXPECT_NE(json.find("median angle [degrees]"), std::string::npos);
}

}  // namespace
}  // namespace palpate
