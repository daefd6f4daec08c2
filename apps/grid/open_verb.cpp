#include <utility>

#include "apps/grid/grid_model.h"
#include "apps/grid/grid_verbs.h"
#include "common/cli/verb_open.h"
#include "common/cli/verbs.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/compose/volume_scene.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/files/open_window.h"
#include "common/window/panels/volume/volume_panel.h"

namespace palpate {

Verb open_volume_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary = "look at a volume in a window, and feel it (the verb that FILE alone stands for)",
       .groups = {Group::kInput, Group::kView, Group::kPanes, Group::kTouch, Group::kRecord, Group::kReplay,
                  Group::kNotes, Group::kPart},
       .window = user_window({draw_volume}),
       .modes = modes_of(FieldKind::kScalar),
       .render = volume_render_verb(modes_of(FieldKind::kScalar), {}),
       .next = "probe FILE --path path.csv --out log.csv",
       .check =
           [](const Document& options) {
             check_volume_options(options.volume);
             (void)slice_panes_of(options.panes, Box());
           },
       .model = [](const Document& options,
                   const std::string& program) { return std::make_unique<GridModel>(options, program); }},
      std::move(examples));
}

}  // namespace palpate
