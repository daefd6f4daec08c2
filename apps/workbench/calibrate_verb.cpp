#include "apps/workbench/fit_text.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/output_file.h"
#include "common/calibration/arm_fit.h"
#include "common/calibration/sighting_fit.h"
#include "common/calibration/synthetic_arm.h"
#include "common/calibration/synthetic_poses.h"
#include "common/calibration/synthetic_tracker.h"
#include "common/kinematics/workbench_file.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

/// The made measurements of a kind.
auto made_tracker(std::uint64_t seed) {
  return MeasurementTable<TrackerMeasurement>{"made measurements",
                                              synthetic_tracker_measurements(synthetic_tracker(seed), seed)};
}
auto made_arm(std::uint64_t seed) {
  return MeasurementTable<ArmMeasurement>{"made measurements",
                                          synthetic_arm_measurements(synthetic_arm(seed), true, seed)};
}
auto made_registration(const WorkbenchOptions& o) {
  const auto made = o.kind == "apparatus" ? synthetic_apparatus(o.seed, o.noise)
                                          : synthetic_coregistration(o.seed, o.noise);
  return MeasurementTable<MarkerMeasurement>{"made measurements", made.rows};
}

Calibrated tracker(const WorkbenchOptions& o) {
  if (!o.out.empty() && (o.method == TrackerMethod::kSpline || o.method == TrackerMethod::kCombinedSpline))
    throw usage_error("a spline is for comparison; write --method table or combined to a workbench.toml");
  const auto table = o.example ? made_tracker(o.seed) : read_tracker_measurements(o.file.string());
  TrackerFit fit = calibrate_tracker(
      table, {.method = o.method, .degree = o.degree, .loss = o.loss, .table_nodes = o.nodes});
  std::string text = fit.correction.spline.centers.empty() ? section_text(fit.correction) : "";
  std::vector<DistortionPicture> pictures;
  if (!o.pictures.empty() || !o.report.empty() || o.verb == "report") {
    // A table alone has no polynomial to follow.
    const bool fitted = fit.correction.position.degree >= 0;
    const TrackerCorrection smooth =
        fitted ? fit.correction
               : fit_tracker(table.rows, {.method = TrackerMethod::kPolynomial, .degree = o.degree},
                             table.source);
    pictures.push_back(position_error_lines(table.rows, smooth.position, o.seed));
    pictures.push_back(orientation_error_icons(table.rows));
    pictures.push_back(field_distortion_icons(table.rows));
  }
  return {std::move(fit.report), "tracker", std::move(text), std::move(pictures)};
}

Calibrated arm(const WorkbenchOptions& o) {
  DhhChain nominal = nominal_phantom_3();
  if (!o.nominal.empty()) {
    const WorkbenchGeometry geometry = read_workbench(o.nominal);
    if (!geometry.arm)
      throw input_error({o.nominal.string(), "", "no section [arm]", "the arm's nominal numbers", ""});
    nominal = *geometry.arm;
  }
  const auto table =
      o.example ? made_arm(o.seed) : read_arm_measurements(o.file.string(), nominal.joint_count);
  ArmFit fit = calibrate_arm(table, nominal, {.offsets_only = o.offsets_only, .loss = o.loss});
  return {std::move(fit.report), "arm", section_text(fit.chain), {}};
}

Calibrated registration(const WorkbenchOptions& o) {
  const auto table = o.example ? made_registration(o) : read_marker_measurements(o.file.string());
  const bool apparatus = o.kind == "apparatus";
  const Registration fit = calibrate_registration(
      table, apparatus ? RegistrationKind::kApparatus : RegistrationKind::kCoregistration,
      {.noise = o.noise, .loss = o.loss});
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

Calibrated calibrated(const WorkbenchOptions& o) {
  if (o.kind == "tracker") return tracker(o);
  if (o.kind == "arm") return arm(o);
  if (o.kind == "pivot") {
    const auto table =
        o.example ? MeasurementTable<PivotMeasurement>{"made measurements", synthetic_pivot(o.seed).rows}
                  : read_pivot_measurements(o.file.string());
    PivotFit fit = calibrate_pivot(table, {.loss = o.loss});
    return {std::move(fit.report), "stylus", stylus_section_text(fit.tip), {}};
  }
  if (o.kind == "eyes") {
    const auto table = o.example ? MeasurementTable<SightingMeasurement>{"made measurements",
                                                                         synthetic_sightings(o.seed).rows}
                                 : read_sightings(o.file.string());
    EyeFit fit = calibrate_eyes(table, {.loss = o.loss});
    return {std::move(fit.report), "eyes", section_text(EyesGeometry{fit.left, fit.right}), {}};
  }
  return registration(o);
}

std::vector<ReportSection> sections_of(const Calibrated& done, const WorkbenchContext& context,
                                       std::vector<ReportPlot> drawn) {
  std::vector<ReportSection> sections{calibration_section(done.report)};
  if (done.pictures.empty()) return sections;
  std::string trouble;
  try {
    if (drawn.empty()) drawn = drawn_pictures(done.pictures, context.command_line);
  } catch (const Error& error) {
    // A machine without OpenGL calibrates all the same.
    if (error.code() != ExitCode::kWorkFailed) throw;
    trouble = error.what();
  }
  sections.push_back(distortion_section(std::move(drawn), trouble));
  return sections;
}

void run_calibrate(const WorkbenchOptions& options, const WorkbenchContext& context) {
  const Stopwatch watch;
  // Refuse before the work what cannot be written after it.
  if (!options.out.empty()) {
    const std::string section = options.kind == "pivot"        ? "stylus"
                                : options.kind == "coregister" ? "coregistration"
                                                               : options.kind;
    check_output(options.out, true);
    if (!options.force && has_section(options.out, section))
      throw usage_error(options.out.string() + " has a section [" + section +
                        "] already; use --force to replace it");
  }
  if (!options.report.empty()) check_report_folder(options.report, options.force);
  context.progress.begin("fitting", 0);
  const Calibrated done = calibrated(options);
  context.progress.check();
  if (!options.out.empty()) write_section(options.out, done.section, done.text, options.force);
  std::vector<ReportPlot> drawn;
  if (!options.pictures.empty()) {
    context.progress.begin("drawing", 0);
    drawn = drawn_pictures(done.pictures, context.command_line);
    write_pictures(drawn, options.pictures, options.force);
  }
  if (!options.report.empty())
    write_sections(options, context, options.report, "workbench: " + done.report.kind,
                   sections_of(done, context, drawn), {}, watch.seconds());
  std::string text = fit_text(done.report);
  if (!options.out.empty()) text += "  -> [" + done.section + "] of " + options.out.string() + "\n";
  if (!options.report.empty()) text += "  -> " + (options.report / "index.html").string() + "\n";
  for (const ReportPlot& picture : drawn) text += "  -> " + (options.pictures / picture.file).string() + "\n";
  context.console.print(text);
  context.console.print_json(fit_json(done.report, options.out.string()));
}

void run_example(const WorkbenchOptions& o, const WorkbenchContext& context) {
  OutputFile file(o.out, o.force);
  if (o.kind == "tracker") file.write(csv(made_tracker(o.seed).rows));
  if (o.kind == "arm") file.write(csv(made_arm(o.seed).rows));
  if (o.kind == "pivot") file.write(csv(synthetic_pivot(o.seed).rows));
  if (o.kind == "eyes") file.write(csv(synthetic_sightings(o.seed).rows));
  if (o.kind == "apparatus" || o.kind == "coregister") file.write(csv(made_registration(o).rows));
  file.finish();
  context.console.print("made measurements of kind " + o.kind + " -> " + o.out.string() + "\n");
  context.console.print_json("{\"out\": \"" + o.out.filename().string() + "\"}");
}

}  // namespace palpate
