#include <utility>

#include "apps/dtmri/dtmri_model.h"
#include "apps/dtmri/dtmri_verbs.h"
#include "apps/dtmri/tensor_scene.h"
#include "apps/dtmri/tract_request.h"
#include "common/cli/verb_open.h"
#include "common/cli/verbs.h"
#include "common/compose/text/slice_panes_text.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/files/open_window.h"

namespace palpate {

Verb open_tensors_verb(std::vector<UsageExample> examples) {
  return make_open_verb(
      {.summary =
           "look at tensors in a window, and trace tracts by hand (the verb that FILE alone stands for)",
       .groups = {Group::kInput, Group::kLines, Group::kView, Group::kPanes, Group::kTouch, Group::kRecord,
                  Group::kReplay, Group::kNotes},
       .window = user_window(dtmri_panels()),
       .modes = modes_of(FieldKind::kTensor),
       .render = tensor_render_verb({}),
       .next = "info FILE",
       .check =
           [](const Document& options) {
             check_tensor_options(options);
             check_view_tracts(options.tracts, options.tract_appearance);
             (void)slice_panes_of(options.panes, Box());
           },
       .model = [](const Document& options,
                   const std::string& program) { return std::make_unique<DtmriModel>(options, program); }},
      std::move(examples));
}

}  // namespace palpate
