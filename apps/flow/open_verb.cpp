#include "apps/flow/flow_model.h"
#include "apps/flow/flow_verbs.h"
#include "common/cli/verb_open.h"
#include "common/cli/verbs.h"
#include "common/compose/line_color.h"
#include "common/compose/line_view.h"
#include "common/compose/resampled_volume.h"
#include "common/compose/trace_options.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/scene/seeds.h"
#include "common/window/files/open_window.h"

namespace palpate {
Verb open_lines_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary = "look at lines in a window (the verb that FILE alone stands for)",
       .groups = {Group::kInput, Group::kLines, Group::kView, Group::kTouch, Group::kRecord, Group::kReplay,
                  Group::kNotes},
       .window = user_window(flow_panels()),
       .modes = modes_of(FieldKind::kVector),
       .render = render_verb(modes_of(FieldKind::kVector), {}),
       .next = "trace FILE --seeds grid:8,8,8 --out lines.vtp",
       .check =
           [](const Document& options) {
             (void)trace_options(options, "both");
             check_flow_volume(options.volume);
           },
       .model = [](const Document& options,
                   const std::string& program) { return std::make_unique<FlowModel>(options, program); }},
      std::move(examples));
}

}  // namespace palpate
