#include "common/window/files/open_window.h"

#include <utility>
#include <vector>

#include "common/base/ledger.h"
#include "common/base/version.h"
#include "common/compose/line_view.h"
#include "common/compose/slice_plane.h"
#include "common/window/window.h"

namespace palpate {
namespace {

WindowOutcome open_window(const std::vector<PanelPart>& panels, WindowModel& model, const Document& options,
                          WindowRequest request) {
  const Work work("window", "to look and touch");
  const WindowResult result = run_user_window(
      model,
      {.program = request.program,
       .view = std::move(request.view),
       .frame_budget = options.view.frame_budget > 0.0 ? options.view.frame_budget : kFrameBudget,
       .angles = camera_angles(options.view.camera),
       .focal_point = focal_point_of(options.view),
       .command_line = std::move(request.command_line),
       .version = version_text(request.program),
       .kind = options.input.kind,
       .start_page = request.start_page,
       .session = options.common.session,
       .workbench = std::move(request.workbench),
       .touch = std::move(request.touch),
       .panels = panels,
       .region =
           options.slice.box.empty() ? std::nullopt : std::optional(parse_box(options.slice.box, "--box")),
       .plotted = options.series.plot,
       .play_rate = options.view.play_rate,
       .threads = options.common.threads,
       .draw_example = std::move(request.draw_example),
       .stop_requested = std::move(request.stop_requested)},
      options, request.note);
  return {.servo = result.probe.servo, .fault = result.probe.fault, .replay = result.replay};
}

}  // namespace

WindowMaker user_window(std::vector<PanelPart> panels) {
  return {.available = window_available,
          .prefer = prefer,
          .open = [panels = std::move(panels)](WindowModel& model, const Document& options,
                                               WindowRequest request) {
            return open_window(panels, model, options, std::move(request));
          }};
}

}  // namespace palpate
