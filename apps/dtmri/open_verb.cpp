#include "apps/dtmri/open_verb.h"

#include <utility>

#include "apps/dtmri/dtmri_model.h"
#include "common/app/cli/line_view.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/verbs.h"
#include "common/app/window/window.h"
#include "common/base/parallel.h"
#include "common/base/version.h"
#include "common/scene/plan.h"

namespace palpate {
namespace {

ExitCode run_open(const Options& given, const VerbContext& context) {
  Options options = given;
  if (list_examples(options, context)) return ExitCode::kDone;
  const bool nothing_named = options.input.files.empty() && options.input.example.empty();
  if (nothing_named) options.input.example = examples_of(FieldKind::kTensor).front().name;
  const CameraAngles angles = camera_angles(options.view.camera);
  check_tensor_options(options.tensors);
  if (!window_available() && nothing_named)
    return headless_tour(tensor_render_verb({}), options, context, "info FILE");
  if (options.common.explain) {
    const Input input = open_input(options, context);
    context.console.print(plan_text(plan_scene(input, {.verb = "open",
                                                       .threads = resolve_threads(options.common.threads),
                                                       .drawing = true,
                                                       .window = true})));
  }
  if (!window_available()) refuse_window(options, context);
  DtmriModel model(options, context.explorer.name);
  WindowOptions window{.program = context.explorer.name,
                       .angles = angles,
                       .command_line = context.command_line,
                       .version = version_text(context.explorer.name),
                       .stop_requested = [] { return InterruptGuard::interrupted(); }};
  if (options.volume.projection == "orthographic") window.view.camera.projection = Projection::kOrthographic;
  (void)run_user_window(model, std::move(window),
                        [&](const std::string& line) { context.console.note(line); });
  return InterruptGuard::interrupted() ? ExitCode::kInterrupted : ExitCode::kDone;
}

}  // namespace

Verb open_verb(std::vector<UsageExample> examples) {
  return {.name = "open",
          .summary = "look at tensors in a window (the verb that FILE alone stands for)",
          .groups = {.view = true},
          .examples = std::move(examples),
          .run = run_open};
}

}  // namespace palpate
