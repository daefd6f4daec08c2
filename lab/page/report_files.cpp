#include <algorithm>
#include <array>
#include <cerrno>
#include <string_view>
#include <system_error>

#include <unistd.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/text.h"
#include "common/scene/report_request.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr auto kFiles = std::to_array<std::string_view>(
    {"index.html", "report.json", "work_precision.csv", "work_precision_lines.csv", "work_precision.svg",
     "stability.csv", "resampling.csv", "resampling.svg", "stated_error.svg", "constraint.csv",
     "constraint_force.svg", "constraint_distance.svg",
     // of sections
     "sections.csv", "chain_work.svg", "chain_rivals.svg", "chain_cue.svg", "linear_drift.svg",
     "linear_drift_rate.svg", "surface_depth_time.svg", "surface_depth_curvature.svg",
     "constraint_budget.svg", "stiffness_rate.svg", "stiffness_damping.svg", "stiffness_delay.svg",
     "stiffness_encoder.svg", "fit_angle.svg", "tract_end_helix.svg", "tract_end_kissing.svg",
     "tract_direction_step.svg", "tract_direction_time.svg", "volume_error.svg", "volume_error.csv",
     "tracker_position.svg", "tracker_orientation.svg", "head_errors.svg", "heart_errors.svg",
     "position_effects.svg", "position_errors.svg", "time_effects.svg", "completion_times.svg",
     "error_time_1.svg", "error_time_2.svg", "error_time_3.svg", "error_time_4.svg", "trials.csv",
     "trials.json", "participants.csv", "participants.json", "fibre_lines.svg", "distortion_lines.png",
     "orientation_icons.png", "field_icons.png"});

/// A folder made by write_report(), or an empty one.
bool holds_only_a_report(const fs::path& folder) {
  std::error_code error;
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
    const std::string name = entry->path().filename().string();
    if (std::find(kFiles.begin(), kFiles.end(), name) == kFiles.end()) return false;
  }
  return !error;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

fs::path without_trailing_slash(const fs::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

void write_file(const fs::path& path, const std::string& text) {
  OutputFile file(path, false);
  file.write(text);
  file.finish();
}

}  // namespace

bool in_folder(const Report& report, std::string_view file) {
  if (file.starts_with("work_precision") || file == "stated_error.svg") return !report.sweep.rows.empty();
  if (file.starts_with("constraint")) return !report.constraint.rows.empty();
  if (file == "stability.csv") return !report.stability.empty();
  if (file == "sections.csv")
    return std::ranges::any_of(report.sections, [](const ReportSection& section) {
      return !section.work_precision.empty() || !section.measurements.empty();
    });
  return file == "index.html" || file == "report.json";
}

std::string work_precision_csv(const Report& report) {
  std::string out =
      "subject,method,parameter,error_median,error_p95,error_max,error_stated,lines_within_stated,seconds,"
      "repeats,lines,points,"
      "judge,lines_judged,lines_compared,lines_ending_inside,lines_ended_elsewhere,lines_not_finished,"
      "lines_missing\n";
  for (const SweepRow& row : report.sweep.rows) {
    out += quoted(report.sweep.subject) + "," + row.method + "," + quoted(row.parameter) + "," +
           exact_number(row.error.median) + "," + exact_number(row.error.p95) + "," +
           exact_number(row.error.max) + "," + exact_number(row.error.stated) + "," +
           exact_number(row.error.covered) + "," + exact_number(row.seconds) + "," +
           std::to_string(row.repeats) + "," + std::to_string(row.lines) + "," + std::to_string(row.points) +
           "," + quoted(row.judge);
    for (const std::size_t count : {row.error.judged, row.error.compared, row.error.inside,
                                    row.error.elsewhere, row.error.unfinished, row.error.missing}) {
      out += "," + std::to_string(count);
    }
    out += "\n";
  }
  return out;
}

std::string work_precision_lines_csv(const Report& report) {
  std::string out = "method,parameter,judge,seed,direction,outcome,end,judge_end,error,error_stated\n";
  const auto add = [&](const std::string& method, const std::string& parameter, const std::string& judge,
                       const LineComparison& comparison) {
    for (const LineJudgement& line : comparison.lines) {
      const bool there = line.meeting != Meeting::kMissing;
      out += method + "," + quoted(parameter) + "," + quoted(judge) + "," + std::to_string(line.seed) + "," +
             (line.direction == TraceDirection::kForward ? "forward" : "backward") + "," +
             name_of(line.meeting) + "," + (there ? std::string(name_of(line.end)) : "") + "," +
             std::string(name_of(line.reference_end)) + "," + exact_number(line.error) + "," +
             exact_number(line.stated) + "\n";
    }
  };
  for (const SweepRow& row : report.sweep.rows) add(row.method, row.parameter, row.judge, row.error);
  add("second reference", report.sweep.second, report.sweep.reference, report.sweep.agreement);
  return out;
}

std::string constraint_csv(const Report& report) {
  std::string out =
      "path,iterations,cells,swept,force_error_median_n,force_error_p99_n,force_error_max_n,lag_p99,lag_max,"
      "distance_p99,distance_max,us_mean,us_p50,us_p99,us_max,steps,steps_compared,releases,fallbacks\n";
  for (const ConstraintRow& row : report.constraint.rows) {
    out += std::string(name_of(row.path)) + "," + std::to_string(row.budget.iterations) + "," +
           std::to_string(row.budget.cells) + "," + (row.cells_swept ? "cells" : "iterations");
    for (const double value :
         {row.force_error.median, row.force_error.p99, row.force_error.max, row.lag.p99, row.lag.max,
          row.residual.p99, row.residual.max, row.us_mean, row.us_p50, row.us_p99, row.us_max}) {
      out += "," + exact_number(value);
    }
    for (const std::size_t count : {row.steps, row.compared, row.releases, row.fallbacks}) {
      out += "," + std::to_string(count);
    }
    out += "\n";
  }
  return out;
}

std::string sections_csv(const Report& report) {
  std::string out = "section,subject,method,parameter,quantity,value,seconds\n";
  for (const ReportSection& section : report.sections) {
    const auto add = [&](const auto& row, const std::string& quantity, double value,
                         const std::string& seconds) {
      out += quoted(section.title) + "," + quoted(row.subject) + "," + quoted(row.method) + "," +
             quoted(row.parameter) + "," + quoted(quantity) + "," + exact_number(value) + "," + seconds +
             "\n";
    };
    for (const WorkPrecision& row : section.work_precision)
      add(row, row.error_kind, row.error, exact_number(row.seconds));
    for (const Measurement& m : section.measurements) add(m, m.quantity, m.value, "");
  }
  return out;
}

std::string stability_csv(const Report& report) {
  std::string out = "case,measured,limit,holds,unit,meaning\n";
  for (const StabilityCase& c : report.stability) {
    out += quoted(c.row.name) + "," + exact_number(c.row.measured) + "," + exact_number(c.row.limit) + "," +
           (c.row.holds ? "true" : "false") + "," + quoted(c.unit) + "," + quoted(c.meaning) + "\n";
  }
  return out;
}

void check_report_folder(const fs::path& given, bool replace) {
  const fs::path folder = without_trailing_slash(given);
  std::error_code error;
  if (fs::exists(fs::symlink_status(folder, error))) {
    const bool is_folder = fs::is_directory(folder, error);
    if (!replace) throw usage_error(given.string() + ": exists already; use --force to replace it");
    if (!is_folder || !holds_only_a_report(folder)) {
      throw usage_error(
          given.string() +
          ": is not a report; --force replaces only a folder that holds a report and nothing else");
    }
  }
  const fs::path parent = fs::absolute(folder).parent_path();
  if (!fs::is_directory(parent, error))
    throw work_error(given.string() + ": there is no folder " + parent.string());
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw work_error(given.string() + ": cannot be made in " + parent.string() + " (" +
                     std::generic_category().message(errno) + ")");
  }
}

void write_report(const Report& report, const fs::path& given, bool replace) {
  check_report_folder(given, replace);
  const fs::path folder = without_trailing_slash(given);
  const fs::path temporary = unfinished_output(given, getpid());
  const auto refuse = [&](const std::error_code& error) {
    std::error_code ignored;
    fs::remove_all(temporary, ignored);
    throw work_error(given.string() + ": cannot be written (" + error.message() + ")");
  };
  std::error_code error;
  if (!fs::create_directory(temporary, error) || error) refuse(error);
  try {
    write_file(temporary / "index.html", report_page(report));
    write_file(temporary / "report.json", report_json(report));
    const auto write_part = [&](const char* name, std::string (*made)(const Report&)) {
      if (in_folder(report, name)) write_file(temporary / name, made(report));
    };
    write_part("work_precision.csv", work_precision_csv);
    write_part("work_precision_lines.csv", work_precision_lines_csv);
    write_part("stability.csv", stability_csv);
    write_part("sections.csv", sections_csv);
    write_part("work_precision.svg", work_precision_plot);
    write_part("stated_error.svg", honesty_plot);
    write_part("constraint.csv", constraint_csv);
    write_part("constraint_force.svg", constraint_force_plot);
    write_part("constraint_distance.svg", constraint_distance_plot);
    const auto write_named = [&](const std::string& name, const std::string& content) {
      PALPATE_CHECK(std::find(kFiles.begin(), kFiles.end(), name) != kFiles.end());
      write_file(temporary / name, content);
    };
    for (const ReportSection& section : report.sections) {
      for (const ReportPlot& plot : section.plots) write_named(plot.file, plot.content);
      if (!section.csv.file.empty()) write_named(section.csv.file, section.csv.content);
      if (!section.csv.dictionary.empty())
        write_named(fs::path(section.csv.file).replace_extension("json").string(), section.csv.dictionary);
    }
  } catch (const Error&) {
    fs::remove_all(temporary, error);
    throw;
  }
  // The old report steps aside and comes back if the new one cannot take its place.
  const fs::path old = temporary.string() + ".old";
  const bool had_old = fs::exists(folder, error);
  if (had_old) {
    fs::rename(folder, old, error);
    if (error) refuse(error);
  }
  fs::rename(temporary, folder, error);
  if (error) {
    std::error_code ignored;
    if (had_old) fs::rename(old, folder, ignored);
    refuse(error);
  }
  if (had_old) fs::remove_all(old, error);
}

}  // namespace palpate
