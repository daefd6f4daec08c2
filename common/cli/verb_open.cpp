#include "common/cli/verb_open.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/base/job.h"
#include "common/base/parallel.h"
#include "common/cli/draw_example.h"
#include "common/cli/verbs.h"
#include "common/cli/window_touch.h"
#include "common/compose/appearance.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_plane.h"
#include "common/compose/text/stereo_text.h"
#include "common/hand/workbench/head_view.h"
#include "common/scene/document/setting.h"

namespace palpate {
namespace {

/// Refuses what the window would refuse, before anything is opened. @throws Error (usage).
void check_view(const Document& options) {
  (void)camera_angles(options.view.camera);
  (void)focal_point_of(options.view);
  if (!options.slice.box.empty()) (void)parse_box(options.slice.box, "--box");
}

/// Whether the window begins with its start page: no data is named, and nothing is said of how to see or feel it
/// but what holds for all data.
bool begins_with_start_page(const Document& given) {
  const auto of_all_data = [](const std::string& name) {
    return std::ranges::any_of(settings(), [&](const Setting& row) {
      return row.name == name && (row.preferred || row.groups.has(Group::kCommon));
    });
  };
  return given.input.files.empty() && given.input.example.empty() && given.common.session.empty() &&
         std::ranges::all_of(given.given, of_all_data);
}

ExitCode run_open(const WindowVerb& verb, const Document& given, const VerbContext& context) {
  Document options = given;
  if (list_examples(options, context)) return ExitCode::kDone;
  const bool available = verb.window.available();
  const auto note = [&](const std::string& line) { context.console.note(line); };
  if (available) verb.window.prefer(context.explorer.name, options, note);
  const bool nothing_named = options.input.files.empty() && options.input.example.empty();
  if (nothing_named) options.input.example = examples_of(context.explorer.kind).front().name;
  check_view(options);
  StereoView stereo = stereo_of(options.view);
  verb.check(options);
  const bool haptic = !verb.modes.empty();
  WindowRequest request{.program = context.explorer.name,
                        .command_line = context.command_line,
                        .start_page = begins_with_start_page(given),
                        .draw_example = draw_example,
                        .stop_requested = [] { return InterruptGuard::interrupted(); },
                        .note = note};
  apply_appearance(options, request.view);
  if (haptic) request.touch = window_touch(verb.modes, options, context);
  request.workbench = workbench_display_of(options, request.touch);
  if (const auto& workbench = request.workbench;
      workbench && !workbench->several && stereo.mode == StereoMode::kNone)
    stereo.mode = workbench->workbench.screens[workbench->screen].stereo;
  if (!available && nothing_named) return headless_tour(verb.render, options, context, verb.next);
  if (!available) refuse_window(options, context);
  const auto model = verb.model(options, context.explorer.name);
  request.view.stereo = stereo;
  if (!options.hand.record.empty()) context.interrupt.keep(options.hand.record);
  const JobScope none(nullptr);  // the window is asked to close, and has jobs of its own
  const WindowOutcome outcome = verb.window.open(*model, options, std::move(request));
  if (haptic) tell_of_touch(outcome, context);
  return InterruptGuard::interrupted() ? ExitCode::kInterrupted : ExitCode::kDone;
}

}  // namespace

Verb make_open_verb(WindowVerb window, std::vector<UsageExample> examples) {
  const std::string summary = window.summary;
  const Groups groups = window.groups;
  return {.name = "open",
          .summary = summary,
          .groups = groups,
          .examples = std::move(examples),
          .run = [window = std::move(window)](const Document& options, const VerbContext& context) {
            return run_open(window, options, context);
          }};
}

}  // namespace palpate
