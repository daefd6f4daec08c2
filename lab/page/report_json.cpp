#include <cmath>
#include <utility>
#include <vector>

#include "common/base/json.h"
#include "lab/page/json_number.h"
#include "lab/page/report.h"

namespace palpate {
namespace {

Json comparison(const LineComparison& c) {
  return {{"median", number_or_null(c.median)},
          {"p95", number_or_null(c.p95)},
          {"max", number_or_null(c.max)},
          {"lines_judged", c.judged},
          {"lines_compared", c.compared},
          {"lines_ending_inside", c.inside},
          {"lines_ended_elsewhere", c.elsewhere},
          {"lines_not_finished", c.unfinished},
          {"lines_missing", c.missing}};
}

}  // namespace

std::string report_json(const Report& report) {
  Json rows = Json::array(), measurements = Json::array();
  std::vector<WorkPrecision> measured = work_precision_rows(report.sweep);
  for (WorkPrecision& row : work_precision_rows(report.constraint)) measured.push_back(std::move(row));
  for (const ReportSection& section : report.sections) {
    measured.insert(measured.end(), section.work_precision.begin(), section.work_precision.end());
    for (const Measurement& m : section.measurements) {
      measurements.push_back({{"subject", m.subject},
                              {"method", m.method},
                              {"parameter", m.parameter},
                              {"quantity", m.quantity},
                              {"value", number_or_null(m.value)}});
    }
  }
  for (const WorkPrecision& row : measured) {
    rows.push_back({{"subject", row.subject},
                    {"method", row.method},
                    {"parameter", row.parameter},
                    {"error", number_or_null(row.error)},
                    {"error_kind", row.error_kind},
                    {"seconds", row.seconds}});
  }
  Json cases = Json::array();
  for (const StabilityCase& c : report.stability) {
    cases.push_back({{"case", c.row.name},
                     {"measured", number_or_null(c.row.measured)},
                     {"limit", c.row.limit},
                     {"holds", c.row.holds},
                     {"unit", c.unit},
                     {"meaning", c.meaning}});
  }
  const Machine& machine = report.machine;
  Json root{{"machine",
             {{"processor", machine.processor},
              {"cores", machine.cores},
              {"memory_bytes", machine.memory_bytes},
              {"system", machine.system},
              {"build", machine.build},
              {"version", machine.version}}},
            {"command_line", report.command_line},
            {"scene", report.scene}};
  if (const Sweep& sweep = report.sweep; !sweep.rows.empty()) {
    root["reference"] = {{"method", sweep.reference},
                         {"independent_method", sweep.second},
                         {"agreement", comparison(sweep.agreement)},
                         {"lines_disputed", sweep.disputed}};
    if (!sweep.peer_missing.empty()) root["peer_missing"] = sweep.peer_missing;
    root["threads"] = sweep.threads;
    root["seeds"] = sweep.seeds;
    root["seeds_outside"] = sweep.seeds_outside;
    root["lines_compared"] = sweep.reference_lines.size();
    root["lines_ending_inside"] = sweep.lines_inside;
    root["max_length"] = sweep.max_length;
  }
  root["work_precision"] = rows;
  root["measurements"] = measurements;
  root["stability"] = cases;
  root["seconds"] = report.seconds;
  return json_text(root) + "\n";
}

}  // namespace palpate
