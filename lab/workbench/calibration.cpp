#include "lab/workbench/calibration.h"

#include <array>
#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/calibration/arm_fit.h"
#include "common/calibration/registration.h"
#include "common/calibration/sighting_fit.h"
#include "common/calibration/synthetic.h"
#include "common/calibration/tracker_fit.h"
#include "common/kinematics/workbench_file.h"
#include "common/kinematics/workbench_writer.h"
#include "common/math/quaternion.h"

namespace palpate {
namespace {

constexpr const char* kMade = "made measurements";

Loss loss_of(const CalibrationOptions& o) {
  constexpr std::array<std::string_view, 3> kLosses{"square", "huber", "cauchy"};
  return static_cast<Loss>(find_word(kLosses, o.loss, "loss"));
}

TrackerMethod method_of(const CalibrationOptions& o) {
  constexpr std::array kMethods{TrackerMethod::kPolynomial, TrackerMethod::kTable,
                                TrackerMethod::kSpline,     TrackerMethod::kCombined,
                                TrackerMethod::kDipoles,    TrackerMethod::kCombinedDipoles};
  for (const TrackerMethod method : kMethods) {
    if (name_of(method) == o.method) return method;
  }
  return TrackerMethod::kCombinedSpline;
}

RegistrationNoise noise_of(const CalibrationOptions& o) {
  if (!o.noise.empty()) {
    const char* const grammar =
        "--noise takes three numbers above zero: position [mm], orientation [degrees], markers [mm]";
    const std::vector<double> noise = parse_numbers(o.noise, 3, grammar);
    for (const double deviation : noise) {
      if (!(deviation > 0.0)) throw usage_error("--noise " + o.noise + ": " + grammar);
    }
    return {1e-3 * noise[0], noise[1] * kDegree, 1e-3 * noise[2]};
  }
  // The arm's and, near its transmitter, the tracker's.
  if (o.kind == "coregister") return {.pose_position = 0.4e-3, .pose_orientation = 1.5e-3, .marker = 0.5e-3};
  return {};
}

/// The made measurements of a kind.
auto made_tracker(std::uint64_t seed) {
  return MeasurementTable<TrackerMeasurement>{kMade,
                                              synthetic_tracker_measurements(synthetic_tracker(seed), seed)};
}
auto made_arm(std::uint64_t seed) {
  return MeasurementTable<ArmMeasurement>{kMade, synthetic_arm_measurements(synthetic_arm(seed), true, seed)};
}
auto made_pivot(std::uint64_t seed) {
  return MeasurementTable<PivotMeasurement>{kMade, synthetic_pivot(seed).rows};
}
auto made_sightings(std::uint64_t seed) {
  return MeasurementTable<SightingMeasurement>{kMade, synthetic_sightings(seed).rows};
}
auto made_registration(const CalibrationOptions& o, std::uint64_t seed) {
  const auto made = o.kind == "apparatus" ? synthetic_apparatus(seed, noise_of(o))
                                          : synthetic_coregistration(seed, noise_of(o));
  return MeasurementTable<MarkerMeasurement>{kMade, made.rows};
}

Calibrated tracker(const CalibrationOptions& o, std::uint64_t seed, bool pictured) {
  const auto table = o.made ? made_tracker(seed) : read_tracker_measurements(o.table.string());
  TrackerFit fit = calibrate_tracker(
      table, {.method = method_of(o), .degree = o.degree, .loss = loss_of(o), .table_nodes = o.nodes});
  std::string text = fit.correction.spline.centers.empty() ? section_text(fit.correction) : "";
  std::vector<DistortionPicture> pictures;
  if (pictured) {
    // A table alone has no polynomial to follow.
    const bool fitted = fit.correction.position.degree >= 0;
    const TrackerCorrection smooth =
        fitted ? fit.correction
               : fit_tracker(table.rows, {.method = TrackerMethod::kPolynomial, .degree = o.degree},
                             table.source);
    pictures.push_back(position_error_lines(table.rows, smooth.position, seed));
    pictures.push_back(orientation_error_icons(table.rows));
    pictures.push_back(field_distortion_icons(table.rows));
  }
  return {std::move(fit.report), "tracker", std::move(text), std::move(pictures)};
}

Calibrated arm(const CalibrationOptions& o, std::uint64_t seed) {
  DhhChain nominal = nominal_phantom_3();
  if (!o.nominal.empty()) {
    const WorkbenchGeometry geometry = read_workbench(o.nominal);
    if (!geometry.arm)
      throw input_error({o.nominal.string(), "", "no section [arm]", "the arm's nominal numbers", ""});
    nominal = *geometry.arm;
  }
  const auto table = o.made ? made_arm(seed) : read_arm_measurements(o.table.string(), nominal.joint_count);
  ArmFit fit = calibrate_arm(table, nominal, {.offsets_only = o.offsets_only, .loss = loss_of(o)});
  return {std::move(fit.report), "arm", section_text(fit.chain), {}};
}

Calibrated registration(const CalibrationOptions& o, std::uint64_t seed) {
  const auto table = o.made ? made_registration(o, seed) : read_marker_measurements(o.table.string());
  const bool apparatus = o.kind == "apparatus";
  const Registration fit = calibrate_registration(
      table, apparatus ? RegistrationKind::kApparatus : RegistrationKind::kCoregistration,
      {.noise = noise_of(o), .loss = loss_of(o)});
  if (!apparatus)
    return {fit.report,
            "coregistration",
            section_text(CoregistrationGeometry{fit.instrument_from_pose, fit.markers.at(0)}),
            {}};
  std::vector<Vec3> markers = fit.markers;
  for (std::size_t m = 0; m < markers.size(); ++m) {
    if (!fit.seen[m]) markers[m] = Vec3{NAN};
  }
  return {fit.report, "apparatus", section_text(ApparatusGeometry{fit.instrument_from_pose, markers}), {}};
}

}  // namespace

std::string section_of(const std::string& kind) {
  return kind == "pivot" ? "stylus" : kind == "coregister" ? "coregistration" : kind;
}

Calibrated calibrated(const CalibrationOptions& o, std::uint64_t seed, bool pictured) {
  if (o.kind == "tracker") return tracker(o, seed, pictured);
  if (o.kind == "arm") return arm(o, seed);
  if (o.kind == "pivot") {
    const auto table = o.made ? made_pivot(seed) : read_pivot_measurements(o.table.string());
    PivotFit fit = calibrate_pivot(table, {.loss = loss_of(o)});
    return {std::move(fit.report), "stylus", stylus_section_text(fit.tip), {}};
  }
  if (o.kind == "eyes") {
    const auto table = o.made ? made_sightings(seed) : read_sightings(o.table.string());
    EyeFit fit = calibrate_eyes(table, {.loss = loss_of(o)});
    return {std::move(fit.report), "eyes", section_text(EyesGeometry{fit.left, fit.right}), {}};
  }
  return registration(o, seed);
}

std::string made_table(const CalibrationOptions& o, std::uint64_t seed) {
  if (o.kind == "tracker") return csv(made_tracker(seed).rows);
  if (o.kind == "arm") return csv(made_arm(seed).rows);
  if (o.kind == "pivot") return csv(made_pivot(seed).rows);
  if (o.kind == "eyes") return csv(made_sightings(seed).rows);
  return csv(made_registration(o, seed).rows);
}

}  // namespace palpate
