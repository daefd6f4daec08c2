#include "apps/flow/open_verb.h"

#include "apps/flow/flow_model.h"
#include "apps/flow/flow_modes.h"
#include "common/app/cli/line_color.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/verbs.h"
#include "common/app/cli/window_touch.h"
#include "common/app/window/window.h"
#include "common/base/parallel.h"
#include "common/base/version.h"
#include "common/field/analytic/examples.h"
#include "common/scene/plan.h"
#include "common/scene/seeds.h"

namespace palpate {
namespace {

ExitCode run_open(const Options& given, const VerbContext& context) {
  Options options = given;
  if (list_examples(options, context)) return ExitCode::kDone;
  const bool nothing_named = options.input.files.empty() && options.input.example.empty();
  if (nothing_named) options.input.example = examples().front().name;
  const TraceOptions trace = trace_options(options, "both");
  const CameraAngles angles = camera_angles(options.view.camera);
  ProbeSessionOptions touch = window_touch(flow_modes(), options, context);
  if (!window_available() && nothing_named) {
    return headless_tour(render_verb(flow_modes(), {}), options, context,
                         "trace FILE --seeds grid:8,8,8 --out lines.vtp");
  }
  if (options.common.explain) {
    const SeedSpec seeds = parse_seeds(options.tracing.seeds.empty() ? kViewSeeds : options.tracing.seeds);
    const Input input = open_input(options, context);
    const LineColor color = line_color(options.view.color, input);
    context.console.print(
        plan_text(plan_scene(input, {.verb = "open",
                                     .tracing = true,
                                     .lines = line_count(seeds, trace),
                                     .threads = resolve_threads(trace.threads),
                                     .drawing = true,
                                     .window = true,
                                     .color_array = color.array ? color.name : std::string()})));
  }
  if (!window_available()) {
    refuse_window(options, context);
  }
  FlowModel model(options, context.explorer.name);
  WindowOptions window{.program = context.explorer.name,
                       .angles = angles,
                       .command_line = context.command_line,
                       .version = version_text(context.explorer.name),
                       .touch = std::move(touch),
                       .stop_requested = [] { return InterruptGuard::interrupted(); }};
  // Any other name is an array of the input: the model knows it once that is open.
  for (int i = 0; i < kColorByCount; ++i) {
    const auto by = static_cast<ColorBy>(i);
    if (name_of(by) == options.view.color) window.view.style.color_by = by;
  }
  const WindowResult result =
      run_user_window(model, std::move(window), [&](const std::string& line) { context.console.note(line); });
  tell_of_touch(result, context);
  if (options.common.explain) context.console.print(measured_text(model.costs()));
  return InterruptGuard::interrupted() ? ExitCode::kInterrupted : ExitCode::kDone;
}

}  // namespace

Verb open_verb(std::vector<UsageExample> examples) {
  return {.name = "open",
          .summary = "look at lines in a window (the verb that FILE alone stands for)",
          .groups = {.tracing = true, .view = true, .touch = true, .record = true, .replay = true},
          .examples = std::move(examples),
          .run = run_open};
}

}  // namespace palpate
