#include "common/cli/console.h"

#include <cstdio>

#include "common/base/error.h"
#include "common/base/ledger.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"

namespace palpate {

void Console::note(const std::string& line) const {
  if (!quiet_) std::fprintf(stderr, "%s: %s\n", program_.c_str(), printable(line).c_str());
}

void Console::print(const std::string& text) {
  if (json_) return;
  std::fputs(printable(text, "\n").c_str(), stdout);
  std::fflush(stdout);
}

void Console::print_json(const std::string& object) {
  if (!json_ || json_printed_) return;
  json_printed_ = true;
  std::string text = settings_.empty() ? object : with_member(object, "settings", settings_);
  if (explain_) text = with_member(text, "explain", ledger_json(Ledger::entries()));
  std::fputs(text.c_str(), stdout);
  std::fputc('\n', stdout);
}

void Console::fail(const std::string& line, int exit_code) {
  std::fprintf(stderr, "%s: %s\n", program_.c_str(), printable(line, "\n").c_str());
  settings_.clear();  // an error says what was wrong with them
  print_json(error_json(line, exit_code));
  if (explain_) print(ledger_text(Ledger::entries()));
  std::fflush(stdout);
}

void Console::finish() {
  if (explain_) print(ledger_text(Ledger::entries()));
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw work_error("stdout: cannot be written");
}

}  // namespace palpate
