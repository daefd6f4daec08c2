#include "common/base/error.h"

#include "common/base/text.h"

namespace palpate {

Error input_error(const InputProblem& problem) {
  std::string line = problem.file;
  const auto append = [&line](const char* separator, const std::string& part) {
    if (part.empty()) return;
    if (!line.empty()) line += separator;
    line += part;
  };
  append(": ", problem.place);
  append(": ", problem.found);
  if (!problem.expected.empty()) append("; ", "expected " + problem.expected);
  append("; ", problem.remedy);
  return {ExitCode::kBadInput, printable(line)};
}

Error usage_error(const std::string& line) { return {ExitCode::kUsage, line}; }
Error work_error(const std::string& line) { return {ExitCode::kWorkFailed, line}; }

}  // namespace palpate
