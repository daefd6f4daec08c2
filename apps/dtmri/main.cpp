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
              {"dtmri trace helix-DTI.nhdr --seeds fa:0.5 --out tracts.tck",
               "tracts from every voxel of high FA"},
              {"dtmri --example list", "the built-in data sets"},
          },
      .verbs =
          {
              info_verb({{"dtmri info helix-DTI.nhdr", "grid, tensors, orientation, memory"},
                         {"dtmri info dwi.nii.gz --explain", "and what each verb would load"}}),
              trace_tracts_verb(
                  {{"dtmri trace helix-DTI.nhdr --seeds fa:0.5 --out tracts.tck",
                    "from the centre of every voxel whose FA is above one half"},
                   {"dtmri trace tensors.nii.gz --seeds mask:corpus.nii.gz --seeds-per-voxel 8 --include "
                    "sphere:0,20,15,8 --exclude mask:csf.nii.gz --min-length 20 --out corpus.trk",
                    "eight seeds in each voxel of a mask; lines through a ball, and not through another "
                    "mask"},
                   {"dtmri trace tensors.nii.gz --seeds point:-12,5,20 --integrator rk4 --step 0.3 "
                    "--max-angle 9 "
                    "--out one.vtp",
                    "one tract with fixed steps, for ParaView"},
                   {"dtmri trace --example helix --seeds fa:0.6 --json --out helix.csv",
                    "a built-in image; the counts as JSON"}}),
          },
      .default_verb = "info",
  };
  return run_explorer(dtmri, argc, argv);
}
