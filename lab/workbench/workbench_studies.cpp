#include "lab/workbench/workbench_studies.h"

#include <algorithm>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/figures.h"
#include "common/base/files/output_file.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/kinematics/workbench_file.h"
#include "common/kinematics/workbench_writer.h"
#include "common/math/quaternion.h"
#include "lab/extremes/extreme.h"
#include "lab/hand/wall/stability_sweep.h"
#include "lab/workbench/calibration.h"
#include "lab/workbench/described_device.h"
#include "lab/workbench/fit_text.h"
#include "lab/workbench/head_errors.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Writes index.html, report.json and pictures.
void write_sections(const Study& study, const fs::path& folder, const std::string& title,
                    std::vector<ReportSection> sections, std::vector<StabilityCase> cases, double seconds) {
  Report report;
  report.title = study.request().program + ": " + title;
  report.command_line = study.request().command_line;
  report.machine = this_machine();
  report.sections = std::move(sections);
  report.stability = std::move(cases);
  report.seconds = seconds;
  write_report(report, folder, study.document().common.force);
}

std::vector<ReportPlot> draw(const Study& study, const Calibrated& done) {
  return drawn_pictures(done.pictures, study.request().program, study.request().command_line);
}

/// What a report says of it: of a tracker with its pictures, `drawn` or, where that is empty, drawn here.
std::vector<ReportSection> sections_of(const Study& study, const Calibrated& done,
                                       std::vector<ReportPlot> drawn = {}) {
  std::vector<ReportSection> sections{calibration_section(done.report)};
  if (done.pictures.empty()) return sections;
  std::string trouble;
  try {
    if (drawn.empty()) drawn = draw(study, done);
  } catch (const Error& error) {
    // A machine without OpenGL calibrates all the same.
    if (error.code() != ExitCode::kWorkFailed) throw;
    trouble = error.what();
  }
  sections.push_back(distortion_section(std::move(drawn), trouble));
  return sections;
}

std::string column(const std::string& text) {
  constexpr std::size_t kWidth = 16;
  return std::string(text.size() < kWidth ? kWidth - text.size() : 1, ' ') + text;
}

}  // namespace

ReportAnswer study_calibration(const Study& study) {
  const CalibrationOptions& o = study.document().calibration;
  const auto& [out, report, pictures, picture] = study.document().device_outputs;
  (void)picture;
  const bool force = study.document().common.force;
  const Stopwatch watch;
  // Refuse before the work what cannot be written after it.
  if (!out.empty()) {
    check_output(out, true);
    const std::string section = section_of(o.kind);
    if (!force && has_section(out, section))
      throw usage_error(out.string() + " has a section [" + section + "] already; use --force to replace it");
  }
  if (!report.empty()) check_report_folder(report, force);
  study.progress()->begin("fitting", 0);
  const Calibrated done = calibrated(o, study.document().common.seed, !pictures.empty() || !report.empty());
  if (!out.empty()) write_section(out, done.section, done.text, force);
  std::vector<ReportPlot> drawn;
  if (!pictures.empty()) {
    study.progress()->begin("drawing", 0);
    drawn = draw(study, done);
    write_pictures(drawn, pictures, force);
  }
  if (!report.empty())
    write_sections(study, report, done.report.kind, sections_of(study, done, drawn), {}, watch.seconds());
  std::string text = fit_text(done.report);
  if (!out.empty()) text += "  -> [" + done.section + "] of " + out.string() + "\n";
  if (!report.empty()) text += "  -> " + (report / "index.html").string() + "\n";
  for (const ReportPlot& plot : drawn) text += "  -> " + (pictures / plot.file).string() + "\n";
  return {.text = std::move(text), .json = fit_json(done.report, out.string())};
}

ReportAnswer study_made_table(const Study& study) {
  const fs::path& out = study.document().output.file;
  const CalibrationOptions& o = study.document().calibration;
  OutputFile file(out, study.document().common.force);
  file.write(made_table(o, study.document().common.seed));
  file.finish();
  return {.text = "made measurements of kind " + o.kind + " -> " + out.string() + "\n",
          .json = json_text({{"out", out.filename().string()}})};
}

ReportAnswer study_made_calibrations(const Study& study) {
  const Stopwatch watch;
  const fs::path& folder = study.document().output.file;
  check_report_folder(folder, study.document().common.force);
  std::vector<ReportSection> sections;
  std::string text = "made calibrations -> " + (folder / "index.html").string() + "\n";
  const std::vector<std::string> kinds{"tracker", "apparatus", "arm", "coregister", "pivot", "eyes"};
  study.progress()->begin("calibrating made workbenches", kinds.size());
  for (const std::string& kind : kinds) {
    const Calibrated done =
        calibrated({.kind = kind, .made = true}, study.document().common.seed, /*pictured=*/true);
    for (ReportSection& section : sections_of(study, done)) sections.push_back(std::move(section));
    for (const ErrorRow& row : done.report.errors) {
      if (row.quantity == "orientation") continue;
      text += "  " + done.report.kind + ", " + row.method + (row.left_out ? ", left out: " : ": ") +
              short_number(row.errors.mean) + " " + row.unit + "\n";
    }
    study.progress()->advance();
  }
  // Larger errors than a calibrated tracker's, so that they are seen in the picture.
  sections.push_back(
      head_error_section(head_error_setup({.position_error = "60,60", .orientation_error = 8.0})));
  const std::vector<StabilityCase> cases =
      run_extremes({ExtremeKind::kWall, ExtremeKind::kDevice}, study.progress());
  text += cases_text(cases);
  const auto failed = std::ranges::count_if(cases, [](const StabilityCase& c) { return !c.row.holds; });
  write_sections(study, folder, "made calibrations", std::move(sections), cases, watch.seconds());
  return {.text = std::move(text),
          .json = json_text(
              {{"out", folder.string()}, {"stability_cases_failed", failed}, {"seconds", watch.seconds()}})};
}

ReportAnswer study_head_errors(const Study& study) {
  const Stopwatch watch;
  const fs::path& folder = study.document().output.file;
  if (!folder.empty()) check_report_folder(folder, study.document().common.force);
  const HeadErrorSetup setup = head_error_setup(study.document().head_errors);
  const std::vector<HeadErrorRow> rows = head_error_rows(setup);
  std::string text = "Displacement of what is seen, in millimetres, by each error alone:\n";
  for (const char* heading : {"x", "z", "by position", "at most", "by turn, x", "by turn, z", "on screen"})
    text += column(heading);
  text += setup.pixel > 0.0 ? column("pixels") + "\n" : "\n";
  Json points = Json::array();
  for (const HeadErrorRow& row : rows) {
    for (const double value : {row.point.x, row.point.y, row.position, row.bound, row.orientation.x,
                               row.orientation.y, row.on_screen})
      text += column(three_digits(1e3 * value + 0.0));
    text += setup.pixel > 0.0 ? column(three_digits(row.on_screen / setup.pixel)) + "\n" : "\n";
    points.push_back({{"x_m", row.point.x},
                      {"z_m", row.point.y},
                      {"position_m", row.position},
                      {"position_bound_m", row.bound},
                      {"orientation_x_m", row.orientation.x},
                      {"orientation_z_m", row.orientation.y},
                      {"on_screen_m", row.on_screen}});
  }
  text +=
      "x runs along the screen from its middle, z from the screen towards the eyes. On the screen: both "
      "errors together.\n";
  Json json{{"eye_distance_m", setup.eye_distance}, {"separation_m", setup.separation}, {"points", points}};
  if (!folder.empty()) {
    write_sections(study, folder, "screen", {head_error_section(setup)}, {}, watch.seconds());
    text += "-> " + (folder / "index.html").string() + "\n";
    json["out"] = folder.string();
  }
  return {.text = std::move(text), .json = json_text(json)};
}

ReportAnswer study_walls(const Study& study) {
  const Stopwatch watch;
  const fs::path& folder = study.document().output.file;
  check_report_folder(folder, study.document().common.force);
  const auto device = described_device(study.document().trial.model);
  WallStability wall = run_wall_stability(study.threads(), study.progress(), device->profile);
  append(run_extremes({ExtremeKind::kWall, ExtremeKind::kDevice}, study.progress()), wall.cases);
  write_sections(study, folder, "stability", wall_sections(wall), wall.cases, watch.seconds());
  std::string text = "stability of walls on " + std::string(wall.swept.title) + " -> " +
                     (folder / "index.html").string() + "\n" + cases_text(wall.cases);
  for (const DeviceRow& row : wall.devices)
    text += "  " + std::string(row.device.title) + ": passive up to " + three_digits(row.stiffness.bound) +
            " N/m, swings unheld from " + three_digits(row.stiffness.unheld) + ", in a relaxed hand from " +
            three_digits(row.stiffness.relaxed) + " N/m\n";
  Json devices = Json::array(), cases = Json::array();
  for (const DeviceRow& row : wall.devices) {
    devices.push_back({{"device", row.device.name},
                       {"passive_n_per_m", row.stiffness.bound},
                       {"swings_unheld_n_per_m", row.stiffness.unheld},
                       {"swings_relaxed_n_per_m", row.stiffness.relaxed}});
  }
  for (const StabilityCase& c : wall.cases) {
    cases.push_back({{"case", c.row.name},
                     {"measured", c.row.measured},
                     {"limit", c.row.limit},
                     {"unit", c.unit},
                     {"holds", c.row.holds}});
  }
  return {.text = std::move(text),
          .json = json_text({{"device", wall.swept.name},
                             {"devices", devices},
                             {"cases", cases},
                             {"out", folder.string()},
                             {"seconds", watch.seconds()}})};
}

}  // namespace palpate
