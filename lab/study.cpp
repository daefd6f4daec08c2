#include "lab/study.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/base/json.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/load/helper/serve.h"
#include "common/scene/open_input.h"
#include "common/scene/wall/remesh.h"

namespace palpate {

void Study::note(const std::string& line) const { send_news(encode(ReportNews{.note = line, .text = {}})); }

void Study::print(const std::string& text) const { send_news(encode(ReportNews{.note = {}, .text = text})); }

Input Study::open() const {
  Document with_mesher = document();
  if (with_mesher.input.kind == FieldKind::kFibre) with_mesher.input.remesher = remesher_of(with_mesher);
  Input input = open_input(with_mesher, progress_, [this](const std::string& line) { note(line); });
  note(input.choice_sentence());
  return input;
}

Report Study::begin(const Input& input) const {
  Report report;
  report.title = request_.program + ": " + input.title();
  report.command_line = request_.command_line;
  report.machine = this_machine();
  report.scene.push_back(input.choice_sentence());
  return report;
}

ReportAnswer Study::finish(const Report& report, const std::string& figures, std::size_t rows) const {
  const std::filesystem::path& folder = document().output.file;
  write_report(report, folder, document().common.force);
  ReportAnswer answer;
  answer.text = report.title + " -> " + (folder / "index.html").string() + "\n" + figures +
                cases_text(report.stability);
  const auto failed = std::ranges::count_if(report.stability, [](const auto& c) { return !c.row.holds; });
  answer.json = json_text({{"out", folder.string()},
                           {"work_precision_rows", rows},
                           {"stability_cases_failed", failed},
                           {"seconds", report.seconds},
                           {"version", version()}});
  return answer;
}

std::string cases_text(const std::vector<StabilityCase>& cases) {
  std::string text;
  for (const StabilityCase& c : cases) {
    text += std::string(c.row.holds ? "  holds  " : "  FAILS  ") + c.row.name + ": " +
            short_number(c.row.measured) + ", limit " + short_number(c.row.limit) + " " + c.unit + "\n";
  }
  return text;
}

void append(std::vector<StabilityCase> from, std::vector<StabilityCase>& to) {
  std::move(from.begin(), from.end(), std::back_inserter(to));
}

std::size_t work_precision_rows(const Report& report) {
  std::size_t rows = 0;
  for (const ReportSection& section : report.sections) rows += section.work_precision.size();
  return rows;
}

}  // namespace palpate
