#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/cli/verbs.h"

namespace palpate {
namespace {

/// @throws Error (usage) where no kind was named.
void check_kind(const Document& document, const std::string& verb) {
  if (document.calibration.kind.empty())
    throw usage_error(verb + " needs to know of what: tracker, apparatus, arm, coregister, pivot or eyes");
}

/// @param outputs those that are named.
ExitCode run(const std::string& subject, const Document& document, std::vector<std::filesystem::path> outputs,
             const VerbContext& context) {
  std::erase_if(outputs, [](const std::filesystem::path& output) { return output.empty(); });
  run_study(subject, document, outputs, context);
  return ExitCode::kDone;
}

ExitCode run_calibrate(const Document& document, const VerbContext& context) {
  check_kind(document, "calibrate");
  const CalibrationOptions& o = document.calibration;
  const DeviceOutputs& outputs = document.device_outputs;
  if (!outputs.pictures.empty() && o.kind != "tracker")
    throw usage_error("--pictures shows the distortion of a tracker: try calibrate tracker");
  if (o.made == !o.table.empty())
    throw usage_error("calibrate " + o.kind + " needs a table of measurements, or --example for made ones");
  if (!outputs.section.empty() && o.kind == "tracker" && o.method.ends_with("spline"))
    throw usage_error("a spline is for comparison; write --method table or combined to a workbench file");
  return run("calibration", document, {outputs.section, outputs.report}, context);
}

ExitCode run_example(const Document& document, const VerbContext& context) {
  check_kind(document, "example");
  if (document.output.file.empty()) throw usage_error("example needs a table to write: try --out table.csv");
  return run("made table", document, {document.output.file}, context);
}

ExitCode run_made_report(const Document& given, const VerbContext& context) {
  Document document = given;
  if (document.output.file.empty()) {
    document.output.file = "workbench-report";
    document.common.force = true;  // a report there gives way to this one
  }
  return run("made calibrations", document, {document.output.file}, context);
}

ExitCode run_screen(const Document& document, const VerbContext& context) {
  return run("head errors", document, {document.output.file}, context);
}

ExitCode run_stability(const Document& document, const VerbContext& context) {
  if (document.output.file.empty())
    throw usage_error("stability needs a folder for its report: try --out stability");
  return run("walls", document, {document.output.file}, context);
}

}  // namespace

Verb calibrate_verb(std::vector<UsageExample> examples) {
  return {
      .name = "calibrate",
      .summary = "fit a model to a table of measurements",
      .details =
          "Measurements (CSV with a header; metres, radians, unit quaternions):\n"
          "  tracker     tx,ty,tz,tqw,tqx,tqy,tqz (reported), mx,my,mz,mqw,mqx,mqy,mqz "
          "(measured)[,validation]\n"
          "  apparatus   px,py,pz,qw,qx,qy,qz (tracker), v1x,v1y,v1z,... (markers as the camera sees them; "
          "nan: not)\n"
          "  arm         x,y,z (where the tip was put), j1,...,jn (readings)[,grid]\n"
          "  coregister  px,py,pz,qw,qx,qy,qz (arm), v1x,v1y,v1z (the tracker's sensor)\n"
          "  pivot       px,py,pz,qw,qx,qy,qz (sensor; the tip rests)\n"
          "  eyes        px,py,pz,qw,qx,qy,qz (head), eye (0 left, 1 right), ax,ay,az,bx,by,bz (points seen "
          "in line)",
      .groups = {Group::kCalibrate},
      .examples = std::move(examples),
      .run = run_calibrate};
}

Verb example_verb(std::vector<UsageExample> examples) {
  return {.name = "example",
          .summary = "write a made table of measurements",
          .groups = {Group::kMade, Group::kOut},
          .examples = std::move(examples),
          .run = run_example};
}

Verb made_report_verb(std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = "made calibrations of every kind, and head tracking",
          .details = "Without --out in workbench-report, in place of a report that is there.",
          .groups = {Group::kReport},
          .examples = std::move(examples),
          .run = run_made_report};
}

Verb screen_verb(std::vector<UsageExample> examples) {
  return {.name = "screen",
          .summary = "what errors of head tracking do before your screen",
          .details = "With --out a report with figures 4.14 and 4.15 of Ikits 2006 for this screen.",
          .groups = {Group::kHeadErrors, Group::kReport},
          .examples = std::move(examples),
          .run = run_screen};
}

Verb stability_verb(std::vector<UsageExample> examples) {
  return {.name = "stability",
          .summary = "how stiff walls may be, by rate, damping, delay, encoder",
          .groups = {Group::kWalls, Group::kReport},
          .examples = std::move(examples),
          .run = run_stability};
}

}  // namespace palpate
