#include <utility>

#include "apps/grid/grid_model.h"
#include "apps/grid/grid_verbs.h"
#include "common/cli/verb_open.h"
#include "common/cli/verbs.h"
#include "common/compose/volume_scene.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/open_window.h"

namespace palpate {

Verb open_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary = "look at a volume in a window, and feel it (the verb that FILE alone stands for)",
       .groups = {.view = true, .touch = true, .record = true, .replay = true, .notes = true, .part = true},
       .window = user_window(),
       .modes = modes_of(FieldKind::kScalar),
       .render = volume_render_verb(modes_of(FieldKind::kScalar), {}),
       .next = "probe FILE --path path.csv --out log.csv",
       .check = [](const Options& options) { check_volume_options(options.volume); },
       .use = [](const Input&, const Options&) { return SceneUse{}; },
       .model = [](const Options& options,
                   const std::string& program) { return std::make_unique<GridModel>(options, program); },
       .style = style_projection},
      std::move(examples));
}

}  // namespace palpate
