/// dtmri: images of diffusion tensors, seen and felt.
#include "common/app/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer dtmri{
      .name = "dtmri",
      .summary = "Explore diffusion-tensor images: tracts traced by hand and by rule",
      .kind = FieldKind::kTensor,
      .examples =
          {
              {"dtmri info helix-DTI.nhdr", "what the file holds"},
              {"dtmri --example list", "the built-in data sets"},
          },
      .verbs =
          {
              info_verb({{"dtmri info helix-DTI.nhdr", "grid, tensors, orientation, memory"},
                         {"dtmri info dwi.nii.gz --explain", "and what each verb would load"}}),
          },
      .default_verb = "info",
  };
  return run_explorer(dtmri, argc, argv);
}
