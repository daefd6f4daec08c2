/// workbench: calibrates devices and displays, and judges what their errors do.
#include <algorithm>
#include <exception>
#include <map>
#include <string>
#include <vector>

#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/cli/interrupt.h"

namespace {

using namespace palpate;

int run(const std::vector<std::string>& arguments) {
  const WorkbenchOptions options = parse_workbench(arguments);
  Console console("workbench", options.json, options.quiet);
  if (options.verb.empty()) {
    Console plain("workbench", false, false);
    plain.print(options.text);
    plain.finish();
    return 0;
  }
  Progress progress;
  InterruptGuard interrupt(progress, "workbench");
  const ProgressBar bar(progress, options.quiet);
  std::string line = "workbench";
  for (const std::string& argument : arguments) line += " " + argument;
  const WorkbenchContext context{console, progress, line};
  const std::map<std::string, void (*)(const WorkbenchOptions&, const WorkbenchContext&)> verbs{
      {"calibrate", run_calibrate}, {"controls", run_controls},
      {"example", run_example},     {"report", run_workbench_report},
      {"screen", run_screen},       {"stability", run_stability_verb},
      {"devices", run_devices},     {"doctor", run_doctor},
      {"monitor", run_monitor},     {"feel", run_feel},
      {"tune", run_tune},
  };
  try {
    verbs.at(options.verb)(options, context);
    console.finish();
    return 0;
  } catch (const Error& error) {
    const bool interrupted = InterruptGuard::interrupted();
    const ExitCode code = interrupted ? ExitCode::kInterrupted : error.code();
    console.fail(interrupted ? "interrupted; " + interrupt.kept() : error.what(), static_cast<int>(code));
    return static_cast<int>(code);
  } catch (const std::exception& error) {
    console.fail(error.what(), static_cast<int>(ExitCode::kWorkFailed));
    return static_cast<int>(ExitCode::kWorkFailed);
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  try {
    return run(arguments);
  } catch (const Error& error) {
    const bool json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    Console("workbench", json, false).fail(error.what(), static_cast<int>(error.code()));
    return static_cast<int>(error.code());
  }
}
