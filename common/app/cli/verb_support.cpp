#include <algorithm>
#include <system_error>
#include <unistd.h>

#include "common/app/cli/json_output.h"
#include "common/app/cli/verbs.h"
#include "common/base/text.h"
#include "common/scene/seeds.h"
#include "common/scene/session.h"

namespace palpate {
namespace {

StopRule stop_plane(const std::string& text) {
  const auto v = parse_numbers(text, 4, "--stop-plane takes nx,ny,nz,d for the plane n.x = d");
  const Vec3 n{v[0], v[1], v[2]};
  const double length = glm::length(n);
  if (!(length > 0.0)) throw usage_error("--stop-plane " + text + ": the normal is zero");
  // A unit normal makes the level a distance, as StopRule wants it.
  return {[unit = n / length, d = v[3] / length](const Vec3& x) { return glm::dot(unit, x) - d; }};
}

}  // namespace

InputSpec input_spec(const InputOptions& options) {
  return {options.files, options.solution, options.example, options.field, options.time};
}

bool list_examples(const Options& options, Console& console) {
  if (options.input.example != "list") return false;
  const auto examples = example_list();
  std::size_t widest = 0;
  for (const ExampleInfo& example : examples) widest = std::max(widest, example.name.size());
  std::string text;
  for (const ExampleInfo& example : examples) {
    text += example.name + std::string(widest + 2 - example.name.size(), ' ') + example.summary + "\n";
  }
  console.print(text);
  console.print_json(examples_json(examples));
  return true;
}

Input open_input(const Options& options, const VerbContext& context) {
  if (!options.session.empty()) {
    for (const std::string& sentence : changed_inputs(load_session(options.session), &context.progress)) {
      context.console.note(sentence);
    }
  }
  context.progress.begin("opening", 0);
  Input input = Input::open(input_spec(options.input), &context.progress);
  for (const std::string& note : input.file() ? input.file()->notes : std::vector<std::string>{}) {
    context.console.note(input.title() + ": " + note);
  }
  return input;
}

TraceOptions trace_options(const Options& options, const std::string& default_direction) {
  const TracingOptions& tracing = options.tracing;
  TraceOptions trace;
  if (!tracing.integrator.empty()) trace.integrator = integrator_from_name(tracing.integrator);
  const std::string direction = tracing.direction.empty() ? default_direction : tracing.direction;
  trace.forward = direction != "backward";
  trace.backward = direction != "forward";
  trace.tolerance = tracing.tolerance;
  trace.step = tracing.step;
  trace.max_length = tracing.max_length;
  trace.max_time = tracing.max_time;
  trace.max_steps = tracing.max_steps;
  for (const std::string& plane : tracing.stop_planes) trace.stop_rules.push_back(stop_plane(plane));
  trace.threads = options.common.threads;
  return trace;
}

void check_output_file(const std::filesystem::path& out, bool force) {
  if (out.empty()) throw usage_error("no output: give --out FILE");
  std::error_code error;
  if (std::filesystem::is_directory(out, error)) throw usage_error(out.string() + ": is a folder; name a file in it");
  if (std::filesystem::exists(out, error) && !force) {
    throw usage_error(out.string() + ": exists already; --force overwrites it");
  }
  const auto folder = std::filesystem::absolute(out).parent_path();
  if (!std::filesystem::is_directory(folder, error)) {
    throw work_error(folder.string() + ": no such folder for " + out.filename().string() + "; make it first");
  }
  if (access(folder.c_str(), W_OK) != 0) throw work_error(folder.string() + ": files cannot be written here");
}

}  // namespace palpate
