#include "apps/dtmri/open_verb.h"

#include <utility>

#include "apps/dtmri/dtmri_model.h"
#include "common/app/cli/tensor_scene.h"
#include "common/app/cli/verb_open.h"
#include "common/app/cli/verbs.h"

namespace palpate {

Verb open_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary = "look at tensors in a window (the verb that FILE alone stands for)",
       .groups = {.view = true},
       .render = tensor_render_verb({}),
       .next = "info FILE",
       .check = [](const Options& options) { check_tensor_options(options); },
       .use = [](const Input&, const Options&) { return SceneUse{}; },
       .model = [](const Options& options,
                   const std::string& program) { return std::make_unique<DtmriModel>(options, program); },
       .style = style_projection},
      std::move(examples));
}

}  // namespace palpate
