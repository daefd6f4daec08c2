#include "common/cli/verb_open.h"

#include <optional>
#include <utility>

#include "common/base/parallel.h"
#include "common/base/version.h"
#include "common/cli/verbs.h"
#include "common/cli/window_touch.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_plane.h"
#include "common/compose/stereo_text.h"
#include "common/hand/bench/head_view.h"
#include "common/render/gl/gpu_objects.h"
#include "common/window/window.h"

namespace palpate {
namespace {

ExitCode run_open(const WindowVerb& verb, const Options& given, const VerbContext& context) {
  Options options = given;
  if (list_examples(options, context)) return ExitCode::kDone;
  const bool nothing_named = options.input.files.empty() && options.input.example.empty();
  if (nothing_named) options.input.example = examples_of(context.explorer.kind).front().name;
  const CameraAngles angles = camera_angles(options.view.camera);
  const std::optional<Vec3> focal_point = focal_point_of(options.view);
  StereoView stereo = stereo_of(options.view);
  verb.check(options);
  const bool felt = !verb.modes.empty();
  ProbeSessionOptions touch;
  if (felt) touch = window_touch(verb.modes, options, context);
  std::optional<BenchDisplayOptions> bench = bench_display_of(options, touch);
  if (bench && !bench->several && stereo.mode == StereoMode::kNone)
    stereo.mode = bench->bench.screens[bench->screen].stereo;
  if (!window_available() && nothing_named) return headless_tour(verb.render, options, context, verb.next);
  if (options.common.explain) {
    const Input input = open_input(options, context);
    SceneUse use = verb.use(input, options);
    use.verb = "open";
    use.threads = resolve_threads(options.common.threads);
    use.drawing = true;
    use.window = true;
    context.console.print(plan_text(plan_scene(input, use)));
  }
  if (!window_available()) refuse_window(options, context);
  const auto model = verb.model(options, context.explorer.name);
  WindowOptions window{
      .program = context.explorer.name,
      .frame_budget = options.view.frame_budget > 0.0 ? options.view.frame_budget : kFrameBudget,
      .angles = angles,
      .focal_point = focal_point,
      .command_line = context.command_line,
      .version = version_text(context.explorer.name),
      .bench = std::move(bench),
      .touch = std::move(touch),
      .region =
          options.slice.box.empty() ? std::nullopt : std::optional(parse_box(options.slice.box, "--box")),
      .plotted = options.series.plot,
      .play_rate = options.view.play_rate,
      .threads = options.common.threads,
      .stop_requested = [] { return InterruptGuard::interrupted(); }};
  verb.style(options, window.view);
  window.view.stereo = stereo;
  if (!options.record.empty()) context.interrupt.keep(options.record);
  const WindowResult result = run_user_window(*model, std::move(window),
                                              [&](const std::string& line) { context.console.note(line); });
  if (felt) tell_of_touch(result, context);
  if (options.common.explain)
    context.console.print(gpu_text(result.gpu) + tables_text(result.tables_by) + model->measured());
  return InterruptGuard::interrupted() ? ExitCode::kInterrupted : ExitCode::kDone;
}

}  // namespace

Verb make_open_verb(WindowVerb window, std::vector<UsageExample> examples) {
  const std::string summary = window.summary;
  const VerbGroups groups = window.groups;
  return {.name = "open",
          .summary = summary,
          .groups = groups,
          .examples = std::move(examples),
          .run = [window = std::move(window)](const Options& options, const VerbContext& context) {
            return run_open(window, options, context);
          }};
}

void style_projection(const Options& options, SceneView& view) {
  if (options.volume.projection == "orthographic") view.camera.projection = Projection::kOrthographic;
}

}  // namespace palpate
