#include <nlohmann/json.hpp>

#include "apps/workbench/device_file.h"
#include "apps/workbench/fit_text.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/clock.h"
#include "common/base/text.h"
#include "common/math/quaternion.h"
#include "lab/hand/wall/stability_sweep.h"
#include "lab/page/html.h"
#include "lab/page/report.h"

namespace palpate {

void write_sections(const WorkbenchOptions& options, const WorkbenchContext& context,
                    const std::filesystem::path& folder, const std::string& title,
                    std::vector<ReportSection> sections, std::vector<StabilityCase> cases, double seconds) {
  Report report;
  report.title = title;
  report.command_line = context.command_line;
  report.machine = this_machine();
  report.sections = std::move(sections);
  report.stability = std::move(cases);
  report.seconds = seconds;
  write_report(report, folder, options.force);
}

namespace {

std::string folder_json(const std::filesystem::path& folder, double seconds) {
  return nlohmann::ordered_json{{"out", folder.string()}, {"seconds", seconds}}.dump(
      2, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace

void run_workbench_report(const WorkbenchOptions& options, const WorkbenchContext& context) {
  const Stopwatch watch;
  check_report_folder(options.out, options.force);
  std::vector<ReportSection> sections;
  std::string text;
  const std::vector<std::string> kinds{"tracker", "apparatus", "arm", "coregister", "pivot", "eyes"};
  context.progress.begin("calibrating made workbenches", kinds.size());
  for (const std::string& kind : kinds) {
    WorkbenchOptions one = options;
    one.kind = kind;
    one.example = true;
    one.out.clear();
    if (kind == "coregister")
      one.noise = {.pose_position = 0.4e-3, .pose_orientation = 1.5e-3, .marker = 0.5e-3};
    const Calibrated done = calibrated(one);
    for (ReportSection& section : sections_of(done, context)) sections.push_back(std::move(section));
    for (const ErrorRow& row : done.report.errors) {
      if (row.quantity == "orientation") continue;
      text += "  " + done.report.kind + ", " + row.method + (row.left_out ? ", left out: " : ": ") +
              short_number(row.errors.mean) + " " + row.unit + "\n";
    }
    context.progress.advance();
    context.progress.check();
  }
  // Larger errors than a calibrated tracker's, so that they are seen in the picture.
  HeadErrorSetup screen = options.screen;
  screen.position_error = {0.06, 0.06};
  screen.orientation_error = 8.0 * kDegree;
  sections.push_back(head_error_section(screen));
  write_sections(options, context, options.out, "workbench: made calibrations", std::move(sections), {},
                 watch.seconds());
  context.console.print("made calibrations -> " + (options.out / "index.html").string() + "\n" + text);
  context.console.print_json(folder_json(options.out, watch.seconds()));
}

void run_stability_verb(const WorkbenchOptions& options, const WorkbenchContext& context) {
  const Stopwatch watch;
  check_report_folder(options.out, options.force);
  const auto device = described_device(options.model);
  const WallStability wall = run_wall_stability(options.threads, &context.progress, device->profile);
  write_sections(options, context, options.out, "workbench: stability", wall_sections(wall), wall.cases,
                 watch.seconds());
  std::string text = "stability of walls on " + std::string(wall.swept.title) + " -> " +
                     (options.out / "index.html").string() + "\n";
  for (const StabilityCase& c : wall.cases)
    text += std::string(c.row.holds ? "  holds  " : "  FAILS  ") + c.row.name + ": " +
            short_number(c.row.measured) + ", limit " + short_number(c.row.limit) + " " + c.unit + "\n";
  for (const DeviceRow& row : wall.devices)
    text += "  " + std::string(row.device.title) + ": passive up to " + three_digits(row.stiffness.bound) +
            " N/m, swings unheld from " + three_digits(row.stiffness.unheld) + ", in a relaxed hand from " +
            three_digits(row.stiffness.relaxed) + " N/m\n";
  context.console.print(text);
  context.console.print_json(folder_json(options.out, watch.seconds()));
}

}  // namespace palpate
