#include <utility>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/heart_scene.h"
#include "common/cli/verb_open.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/files/open_window.h"

namespace palpate {

Verb open_heart_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary =
           "look at layers and fibres in a window, and feel them (the verb that FILE alone stands for)",
       .groups = {Group::kInput, Group::kLines, Group::kLayer, Group::kAngle, Group::kPlot, Group::kView,
                  Group::kTouch, Group::kRecord, Group::kReplay, Group::kNotes},
       .window = user_window(cardiac_panels()),
       .modes = modes_of(FieldKind::kFibre),
       .render = render_layers_verb({}),
       .next = "trace FILE --layer 0.5 --seeds random:200 --out fibres.vtp",
       .check =
           [](const Document& options) {
             (void)layer_of(options.heart);
             (void)parse_cut(options.heart.cut);
           },
       .model = [](const Document& options,
                   const std::string& program) { return std::make_unique<CardiacModel>(options, program); }},
      std::move(examples));
}

}  // namespace palpate
