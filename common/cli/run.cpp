#include <algorithm>
#include <array>
#include <cstddef>
#include <exception>
#include <filesystem>
#include <new>
#include <string_view>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/files/kept_files.h"
#include "common/base/job.h"
#include "common/base/ledger.h"
#include "common/cli/command_line.h"
#include "common/cli/explorer.h"
#include "common/cli/json/json_output.h"

namespace palpate {
namespace {

std::string command_text(const std::string& program, const std::vector<std::string>& arguments) {
  std::string line = program;
  for (const std::string& argument : arguments) {
    const bool plain = !argument.empty() && argument.find_first_of(" \t\"'$&|;<>()*?\\") == std::string::npos;
    line += plain ? " " + argument : " '" + argument + "'";
  }
  return line;
}

/// No output may be one of the inputs, under whatever name: --force would destroy it.
/// @throws Error (usage).
void check_outputs(const Document& options) {
  std::vector<std::filesystem::path> inputs = options.input.files;
  if (options.input.solution) inputs.push_back(*options.input.solution);
  std::string device;
  for (const std::string_view word : {"replay:", "hands:"}) {
    if (options.hand.device.starts_with(word)) device = options.hand.device.substr(word.size());
  }
  for (const std::filesystem::path& input :
       {options.input.tensor.bval, options.input.tensor.bvec,
        std::filesystem::path(options.input.tensor.mask), options.hand.path, options.hand.workbench,
        options.hand.replay, options.common.session, std::filesystem::path(options.tracing.seeds),
        std::filesystem::path(device), options.calibration.table, options.calibration.nominal}) {
    inputs.push_back(input);
  }
  const DeviceOutputs& of_devices = options.device_outputs;  // of a section the rest stays: no output here
  const std::array<std::filesystem::path, 6> outputs{options.output.file,  options.hand.record,
                                                     options.output.tract, of_devices.report,
                                                     of_devices.pictures,  of_devices.picture};
  for (std::size_t o = 0; o < outputs.size(); ++o) {
    const std::filesystem::path& output = outputs[o];
    for (std::size_t other = 0; other < o; ++other) {
      if (!output.empty() && output.lexically_normal() == outputs[other].lexically_normal())
        throw usage_error(output.string() + " is named for two outputs; give each a name of its own");
    }
    for (const std::filesystem::path& input : inputs) {
      std::error_code ignored;
      if (!output.empty() && !input.empty() && std::filesystem::equivalent(output, input, ignored)) {
        throw usage_error(output.string() + " is the input " + input.string() +
                          "; give the output another name");
      }
    }
  }
}

/// What a verb names after its outputs or its data is no input either.
void keep_inputs(const InputOptions& input) {
  keep_from_outputs(input.files);
  const std::array<std::filesystem::path, 3> others{input.solution.value_or(std::filesystem::path()),
                                                    input.tensor.bval, input.tensor.bvec};
  keep_from_outputs(others);
}

/// Parts that bring time, memory or libraries along, in the Ledger's words.
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> kParts{{
    {"traced lines", "none was traced"},
    {"measures of the velocity gradient", "none was computed"},
    {"OpenGL off screen", "nothing was drawn by it"},
    {"window", "none was opened"},
    {"drivers of devices", "none was loaded"},
    {"helper palpate-lab", "no study was run"},
}};

/// Runs `verb` and turns whatever it throws into a line and an exit code.
ExitCode run_verb(const Verb& verb, const Document& options, const VerbContext& context) {
  const auto interrupted = [&] {
    context.console.fail("interrupted; " + context.interrupt.saved(),
                         static_cast<int>(ExitCode::kInterrupted));
    return ExitCode::kInterrupted;
  };
  try {
    check_outputs(options);
    keep_inputs(options.input);
    const JobScope scope(&context.progress);
    const ExitCode code = verb.run(options, context);
    context.console.finish();
    return code;
  } catch (const Error& error) {
    // What a cancelled job says last is a consequence, not the cause.
    if (InterruptGuard::interrupted()) return interrupted();
    context.console.fail(error.what(), static_cast<int>(error.code()));
    return error.code();
  } catch (const std::bad_alloc&) {
    context.console.fail("not enough memory for this data; give fewer seeds, or a part of the data",
                         static_cast<int>(ExitCode::kWorkFailed));
  } catch (const std::exception& error) {
    if (InterruptGuard::interrupted()) return interrupted();
    context.console.fail(error.what(), static_cast<int>(ExitCode::kWorkFailed));
  }
  return ExitCode::kWorkFailed;
}

}  // namespace

int run_explorer(const Explorer& explorer, int argc, char** argv) {
  const std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
  ParsedCommand parsed;
  try {
    parsed = parse_command_line(explorer, arguments);
    if (!parsed.verb) {
      Console console(explorer.name, false, false);
      console.print(parsed.text);
      console.finish();
      return 0;
    }
    if (explorer.complete) explorer.complete(parsed.options);
  } catch (const Error& error) {
    const bool json = std::find(arguments.begin(), arguments.end(), "--json") != arguments.end();
    Console(explorer.name, json, false).fail(error.what(), static_cast<int>(error.code()));
    return static_cast<int>(error.code());
  }

  const CommonOptions& common = parsed.options.common;
  const Groups groups = parsed.verb->groups.with(Group::kCommon);
  Console console(explorer.name, common.json, common.quiet,
                  common.json ? settings_json(parsed.options, groups) : std::string(), common.explain);
  for (const std::string& note : parsed.notes) console.note(note);
  for (const auto& [what, why_not] : kParts) Ledger::offer(what, why_not);
  Progress progress;
  InterruptGuard interrupt(progress, explorer.name);
  const ProgressBar bar(progress, common.quiet);
  const VerbContext context{explorer, progress, interrupt, console, command_text(explorer.name, arguments)};
  return static_cast<int>(run_verb(*parsed.verb, parsed.options, context));
}

}  // namespace palpate
