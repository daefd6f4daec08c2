#include <algorithm>
#include <filesystem>

#include "common/app/cli/json_output.h"
#include "common/app/cli/verbs.h"
#include "common/field/analytic/examples.h"
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

InputSpec input_spec(const InputOptions& options, FieldKind kind) {
  return {.files = options.files,
          .solution = options.solution,
          .example = options.example,
          .field = options.field,
          .time = options.time,
          .kind = kind,
          .raw = options.raw,
          .tensor = options.tensor,
          .refine = options.refine,
          .series = options.series,
          .constant_cells = options.cell_directions == "constant",
          .keeping = keeping_from_name(options.cache),
          .surface_markers = options.surface_markers,
          .remesher = options.remesher};
}

bool list_examples(const Options& options, const VerbContext& context) {
  if (options.input.example != "list") return false;
  const std::vector<ExampleInfo> list = examples_of(context.explorer.kind);
  std::size_t widest = 0;
  for (const ExampleInfo& entry : list) widest = std::max(widest, entry.name.size());
  std::string text;
  for (const ExampleInfo& entry : list) {
    text += entry.name + std::string(widest + 2 - entry.name.size(), ' ') + entry.summary + "\n";
  }
  context.console.print(text);
  context.console.print_json(examples_json(list));
  return true;
}

Input open_input(const Options& options, const VerbContext& context) {
  if (!options.session.empty()) {
    for (const std::string& sentence : changed_inputs(load_session(options.session), &context.progress)) {
      context.console.note(sentence);
    }
  }
  context.progress.begin("opening", 0);
  Input input = Input::open(input_spec(options.input, context.explorer.kind), &context.progress);
  for (const std::string& note : input.notes()) context.console.note(input.title() + ": " + note);
  return input;
}

ExitCode headless_tour(const Verb& render, Options options, const VerbContext& context,
                       const std::string& next) {
  const std::string program = context.explorer.name;
  // The first name that is free: flow-tour.png, flow-tour-2.png, …
  options.out = program + "-tour.png";
  for (int n = 2; std::filesystem::exists(options.out); ++n)
    options.out = program + "-tour-" + std::to_string(n) + ".png";
  context.console.note("no display here, so no window: drawing example " + options.input.example + " into " +
                       options.out.string() + " instead");
  const ExitCode code = render.run(options, context);
  if (code == ExitCode::kDone) {
    context.console.note("next: " + program + " --example list, " + program +
                         " render FILE --out picture.png, " + program + " " + next);
  }
  return code;
}

void refuse_window(const Options& options, const VerbContext& context) {
  (void)Input::open(input_spec(options.input, context.explorer.kind), &context.progress);
  throw work_error("no display, so no window; '" + context.explorer.name +
                   " render' draws a picture without one: add --out picture.png");
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

std::size_t line_count(const SeedSpec& seeds, const TraceOptions& trace) noexcept {
  return seed_count(seeds) * (trace.forward && trace.backward ? 2 : 1);
}

}  // namespace palpate
