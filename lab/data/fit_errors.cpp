#include "lab/data/fit_errors.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <string>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/quantile.h"
#include "common/base/text.h"
#include "common/field/tensor/tensor_fit.h"
#include "common/field/tensor/tensor_source.h"
#include "common/math/counter_random.h"
#include "common/math/symmetric3.h"
#include "common/math/units.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kAlong = 1.7e-3, kAcross = 0.3e-3;  ///< white matter's [mm^2/s] (Pierpaoli and Basser 1996)
constexpr double kGoldenAngle = std::numbers::pi * (3.0 - 2.2360679774997896964);
constexpr double kNoiseless = 1000.0;  ///< an SNR at which theory's proportionality must show
constexpr int kRuns = 3;               ///< of which the fastest is told: others share the machine

/// Two numbers of mean 0 and standard deviation 1 (Box and Muller 1958).
Vec2 normal_pair(std::uint64_t index) {
  const double length = std::sqrt(-2.0 * std::log1p(-uniform_at(2 * index)));
  const double angle = 2.0 * std::numbers::pi * uniform_at(2 * index + 1);
  return {length * std::cos(angle), length * std::sin(angle)};
}

/// Direction n of `count` that cover the half sphere evenly.
Vec3 spread_direction(int n, int count) {
  const double z = 1.0 - (n + 0.5) / count, r = std::sqrt(1.0 - z * z), phi = n * kGoldenAngle;
  return {r * std::cos(phi), r * std::sin(phi), z};
}

FitErrorRow measure(const GradientTable& table, double weighting, double snr, int tensors, int threads) {
  GradientTable scaled = table;
  for (double& b : scaled.weightings) b *= weighting / table.largest_weighting();
  const std::size_t volumes = scaled.weightings.size();
  std::vector<float> signals;
  signals.reserve(volumes * as_size(tensors));
  for (int n = 0; n < tensors; ++n) {
    const Vec3 e = spread_direction(n, tensors);
    for (std::size_t i = 0; i < volumes; ++i) {
      const double along = glm::dot(scaled.directions[i], e);
      const double square = glm::dot(scaled.directions[i], scaled.directions[i]);
      const double s =
          std::exp(-scaled.weightings[i] * (kAcross * square + (kAlong - kAcross) * along * along));
      // The same noise at every setting: curves are smooth, and differences those of the setting.
      const Vec2 noise = normal_pair(signals.size()) / snr;
      signals.push_back(static_cast<float>(std::hypot(s + noise.x, noise.y)));
    }
  }
  const DataArray image = make_array(kSignalArray, Association::kPoint, static_cast<int>(volumes),
                                     std::span<const float>(signals));
  TensorFit fit;
  FitErrorRow row{.weighting = weighting, .snr = snr, .seconds = HUGE_VAL};
  for (int repeat = 0; repeat < kRuns; ++repeat) {
    const Stopwatch watch;
    fit = fit_tensors(image, scaled, {}, {.threads = threads});
    row.seconds = std::min(row.seconds, watch.seconds() / tensors);
  }
  std::vector<double> angles;
  for (int n = 0; n < tensors; ++n) {
    const float* const d = &fit.tensors[6 * as_size(n)];
    const Mat3 tensor{Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}};
    const Vec3 found = symmetric_eigen(tensor / kAlong).vectors[0];
    const Vec3 e = spread_direction(n, tensors);
    const double angle = std::atan2(glm::length(glm::cross(found, e)), std::abs(glm::dot(found, e)));
    angles.push_back(std::isfinite(angle) ? kDegreesARadian * angle : 90.0);  // no tensor: no direction
  }
  row.median = quantile(angles, 0.5);
  row.p95 = quantile(angles, 0.95);
  return row;
}

std::string snr_name(double snr) { return "SNR " + short_number(snr); }

}  // namespace

GradientTable spread_gradients(int count) {
  GradientTable table{.weightings = {0.0}, .directions = {Vec3{0.0}}};
  for (int n = 0; n < count; ++n) {
    table.weightings.push_back(1000.0);
    table.directions.push_back(spread_direction(n, count));
  }
  return table;
}

FitErrors run_fit_errors(const GradientTable& table, Effort effort, int threads, Progress* progress) {
  FitErrors errors{.gradients = table.weightings.size(),
                   .unweighted = table.unweighted_count(),
                   .own_weighting = table.largest_weighting()};
  const int tensors = effort == Effort::kQuick ? 200 : effort == Effort::kNormal ? 1000 : 5000;
  errors.tensors = as_size(tensors);
  const std::vector<double> snrs{10.0, 20.0, 40.0, 80.0, kNoiseless, 2.0 * kNoiseless};
  std::vector<double> weightings{250.0, 500.0, 750.0, 1000.0, 1500.0, 2000.0, 3000.0, 4000.0};
  if (effort == Effort::kQuick) weightings = {500.0, 1000.0, 2000.0, 4000.0};
  if (progress != nullptr) progress->begin("fitting simulated signals", snrs.size());
  for (const double snr : snrs) {
    for (const double b : weightings) errors.rows.push_back(measure(table, b, snr, tensors, threads));
    if (progress != nullptr) progress->check();
    if (progress != nullptr) progress->advance(1);
  }
  return errors;
}

ReportSection fit_errors_section(const FitErrors& errors) {
  ReportSection section;
  section.title = "Direction of fitted tensors against weighting and noise";
  std::vector<PlotSeries> series;
  section.columns = {"SNR", "b [s/mm2]", "median [degrees]", "95 % [degrees]", "us a voxel"};
  const std::string subject =
      "tensor fit, " + std::to_string(errors.gradients) + " volumes" + (errors.made_up ? ", made up" : "");
  for (const FitErrorRow& row : errors.rows) {
    if (row.snr >= kNoiseless) continue;  // of the stability table
    if (series.empty() || series.back().name != snr_name(row.snr)) series.push_back({snr_name(row.snr), {}});
    series.back().points.push_back({row.weighting, row.median});
    section.table.push_back({short_number(row.snr), short_number(row.weighting), three_digits(row.median),
                             three_digits(row.p95), three_digits(1e6 * row.seconds)});
    const std::string parameter = "b=" + short_number(row.weighting) + " SNR=" + short_number(row.snr);
    section.work_precision.push_back(
        {subject, "weighted least squares", parameter, row.median, "median angle [degrees]", row.seconds});
  }
  section.plots.push_back({"fit_angle.svg", "angle against b for several SNR, log-log",
                           svg({.title = "How far noise turns the main direction",
                                .x_label = "largest diffusion weighting b [s/mm2]",
                                .y_label = "angle from the true direction, median [degrees]",
                                .series = std::move(series)})});
  section.paragraphs = {
      (errors.made_up ? std::string("The data have no gradients of their own; taken are ")
                      : std::string("At the gradients of this file: ")) +
          counted(errors.gradients, "volume") + ", " + std::to_string(errors.unweighted) +
          " of them without weighting, b up to " + short_number(errors.own_weighting) +
          " s/mm2. The weightings are scaled together; signals of " + counted(errors.tensors, "tensor") +
          " of diffusivities 1.7, 0.3, 0.3 10^-3 mm2/s, turned every way, get Rician noise and are fitted as "
          "the image is. SNR is the signal without weighting over the noise.",
      "Little weighting leaves little contrast, too much of it leaves no signal above the noise: the lowest "
      "point of a curve is the weighting that shows directions best."};
  return section;
}

std::vector<StabilityCase> fit_error_cases(const FitErrors& errors) {
  // d log(angle) / d log(noise) between the last two SNR, at the weighting where it differs most from 1.
  double worst = 0.0;
  for (const FitErrorRow& a : errors.rows) {
    if (a.snr != kNoiseless) continue;
    for (const FitErrorRow& b : errors.rows) {
      if (b.snr != 2.0 * kNoiseless || b.weighting != a.weighting) continue;
      worst = std::max(worst, std::abs(std::log2(a.median / b.median) - 1.0));
    }
  }
  constexpr double kLimit = 0.1;
  StabilityCase c;
  c.row = {"angle of the fit in proportion to little noise", worst, kLimit, worst <= kLimit};
  c.unit = "off order 1";
  c.meaning = "SNR 1000 against 2000, over all weightings";
  return {c};
}

}  // namespace palpate
