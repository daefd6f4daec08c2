#include <utility>

#include "apps/cardiac/cardiac_model.h"
#include "apps/cardiac/cardiac_verbs.h"
#include "apps/cardiac/cut_away.h"
#include "apps/cardiac/heart_scene.h"
#include "common/cli/verb_open.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/open_window.h"

namespace palpate {

Verb open_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary =
           "look at layers and fibres in a window, and feel them (the verb that FILE alone stands for)",
       .groups = {.fibres = true,
                  .layer = true,
                  .angle = true,
                  .plot = true,
                  .view = true,
                  .touch = true,
                  .record = true,
                  .replay = true},
       .window = user_window(),
       .modes = modes_of(FieldKind::kFibre),
       .render = render_layers_verb({}),
       .next = "trace FILE --layer 0.5 --seeds random:200 --out fibres.vtp",
       .check =
           [](const Options& options) {
             (void)layer_of(options.heart);
             (void)parse_cut(options.heart.cut);
             (void)range_of(options.heart);
           },
       .use = [](const Input&, const Options&) { return SceneUse{.tracing = true}; },
       .model = [](const Options& options,
                   const std::string& program) { return std::make_unique<CardiacModel>(options, program); },
       .style = style_projection},
      std::move(examples));
}

}  // namespace palpate
