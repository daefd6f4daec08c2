
#include <optional>
#include <system_error>
#include <utility>

#include "common/base/files/find_helper.h"
#include "common/base/ledger.h"
#include "common/cli/verbs.h"
#include "common/load/helper/helper_process.h"
#include "common/load/helper/protocol.h"
#include "common/scene/report_request.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

/// Takes back what process `pid` was writing: it was ended in the middle of its work. A folder that had
/// stepped aside for it comes back.
void take_back(const std::vector<fs::path>& outputs, pid_t pid) {
  std::error_code ignored;
  for (const fs::path& output : outputs) {
    const fs::path unfinished = unfinished_output(output, pid);
    fs::remove_all(unfinished, ignored);
    const fs::path old = unfinished.string() + ".old";
    if (fs::exists(old, ignored) && !fs::exists(output, ignored)) fs::rename(old, output, ignored);
  }
}

}  // namespace

void run_study(const std::string& subject, const Document& document, const std::vector<fs::path>& outputs,
               const VerbContext& context) {
  const fs::path program = find_helper(kStudyProgram);
  if (program.empty())
    throw work_error(std::string("the program of studies, ") + kStudyProgram + ", is not installed");
  const Work work(std::string("helper ") + kStudyProgram, "measures");
  std::optional<HelperProcess> helper(std::in_place, program, kUnlimited);
  const pid_t pid = helper->pid();
  for (const fs::path& output : outputs) context.interrupt.unfinished(unfinished_output(output, pid));
  Console& console = context.console;
  const auto show = [&console](std::string_view json) {
    const ReportNews news = decode_report_news(json);
    if (!news.note.empty()) console.note(news.note);
    console.print(news.text);
  };
  std::optional<HelperProcess::Reply> reply;
  try {
    MemoryFile none;
    const ReportRequest request{.subject = subject,
                                .program = context.explorer.name,
                                .command_line = context.command_line,
                                .document = document};
    reply = helper->ask(none, encode(request), &context.progress, "starting", show);
    if (!reply) throw work_error("the program of studies " + helper->failure().what);
  } catch (const Error&) {
    helper.reset();  // it has ended before what it was writing is removed
    take_back(outputs, pid);
    throw;
  }
  try {
    const ReportAnswer answer = decode_report_answer(reply->json);
    for (const fs::path& output : outputs) context.interrupt.keep(output);
    Ledger::add(answer.ledger);
    console.print(answer.text);
    console.print_json(answer.json);
  } catch (const ProtocolError& error) {
    throw work_error(std::string("the program of studies gave an answer that makes no sense: ") +
                     error.what());
  }
}

Verb report_verb(std::string summary, Groups groups, std::vector<UsageExample> examples) {
  return {.name = "report",
          .summary = std::move(summary),
          .groups = groups.with(Group::kReport),
          .examples = std::move(examples),
          .run = [](const Document& document, const VerbContext& context) {
            if (list_examples(document, context)) return ExitCode::kDone;
            const fs::path& folder = document.output.file;
            if (folder.empty()) throw usage_error("report needs a folder to make: try --out report");
            run_study(std::string(name_of(context.explorer.kind)), document, {folder}, context);
            return ExitCode::kDone;
          }};
}

}  // namespace palpate
