#include "common/cli/report_output.h"

#include <algorithm>
#include <iterator>

#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/verbs.h"

namespace palpate {

Report begin_report(const Input& input, const VerbContext& context) {
  Report report;
  report.title = context.explorer.name + ": " + input.title();
  report.command_line = context.command_line;
  report.machine = this_machine();
  report.scene.push_back(input.choice_sentence());
  return report;
}

void append(std::vector<StabilityCase> from, std::vector<StabilityCase>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

std::size_t work_precision_rows(const Report& report) {
  std::size_t rows = 0;
  for (const ReportSection& section : report.sections) rows += section.work_precision.size();
  return rows;
}

void finish_report(const Report& report, const std::string& figures, std::size_t rows,
                   const std::vector<MeasuredCost>& costs, const Options& options,
                   const VerbContext& context) {
  Console& console = context.console;
  context.interrupt.unfinished(unfinished_report_folder(options.out));
  write_report(report, options.out, options.common.force);
  context.interrupt.keep(options.out);
  std::string text = report.title + " -> " + (options.out / "index.html").string() + "\n" + figures;
  for (const StabilityCase& c : report.stability) {
    text += std::string(c.row.holds ? "  holds  " : "  FAILS  ") + c.row.name + ": " +
            short_number(c.row.measured) + ", limit " + short_number(c.row.limit) + " " + c.unit + "\n";
  }
  console.print(text);
  if (options.common.explain) console.print(measured_text(costs));
  const auto failed = std::ranges::count_if(report.stability, [](const auto& c) { return !c.row.holds; });
  console.print_json(
      report_summary_json(options.out.string(), rows, static_cast<std::size_t>(failed), report.seconds));
}

}  // namespace palpate
