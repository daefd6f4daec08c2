/// dtmri: images of diffusion tensors, seen and felt.
#include "apps/dtmri/dtmri_verbs.h"
#include "apps/dtmri/study/bundle_task.h"
#include "common/cli/verbs.h"
#include "common/experiment/study_verb.h"
#include "common/hand/mode/haptic_mode.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer dtmri{
      .name = "dtmri",
      .summary = "Explore diffusion-tensor images: tracts traced by hand and by rule",
      .kind = FieldKind::kTensor,
      .examples =
          {
              {"dtmri helix-DTI.nhdr", "look at a file in the window"},
              {"dtmri info helix-DTI.nhdr", "what the file holds"},
              {"dtmri render dwi.nii.gz --out dwi.png", "a picture, with or without a display"},
              {"dtmri trace helix-DTI.nhdr --seeds fa:0.5 --out tracts.tck",
               "tracts from every voxel of high FA"},
              {"dtmri probe tensor.nii.gz --path path.csv --tract tract.tck",
               "trace by hand, without a window"},
              {"dtmri fit dwi.nii.gz --out tensor.nii.gz", "tensors from diffusion-weighted volumes"},
              {"dtmri measure tensor.nii.gz --measure fa --out fa.nii.gz", "images of what they measure"},
              {"dtmri report dwi.nii.gz --out report", "how far to trust directions and tracts"},
              {"dtmri --example list", "the built-in data sets"},
          },
      .verbs =
          {
              info_verb({{"dtmri info helix-DTI.nhdr", "grid, tensors, orientation, memory"},
                         {"dtmri info dwi.nii.gz --explain", "and what that took, and what it left out"}}),
              tensor_render_verb(
                  {{"dtmri render helix-DTI.nhdr --out helix.png", "three slices, coloured by direction"},
                   {"dtmri render dwi.nii.gz --slices -,-,20 --camera 0,90,0,1 --glyphs superquadric --out "
                    "s.png",
                    "an axial slice with glyphs, seen from above"},
                   {"dtmri render tensors.nii.gz --color fa --voxels linear --out fa.png",
                    "fractional anisotropy"},
                   {"dtmri render --example helix --path path.csv --out hand.png",
                    "what a hand on a recorded path has drawn, coloured by the tension"}}),
              tensor_slice_verb(
                  {{"dtmri slice dwi.nii.gz --seeds fa:0.5 --out slices.png",
                    "three slices with tracts over them, and the scene"},
                   {"dtmri slice dwi.nii.gz --layout 2 --pane coronal --slice-show fa --tracts bundle.trk "
                    "--tract-slab 8 --out coronal.png",
                    "tracts within 4 mm of a slice of anisotropy"}}),
              study_verb([] { return StudyTasks{make_bundle_task()}; },
                         {{"dtmri study make trial-study",
                           "an experiment in which people trace bundles, with guidance and without"},
                          {"dtmri study simulate trial-study", "simulated participants in all places"}}),
              open_tensors_verb({{"dtmri helix-DTI.nhdr", "a file in the window"},
                                 {"dtmri --example helix", "a built-in data set"},
                                 {"dtmri open --session dwi.palpate.toml", "what Ctrl+S saved"}}),
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
              probe_verb(modes_of(FieldKind::kTensor),
                         {{"dtmri probe tensor.nii.gz --path path.csv --tract tract.vtp",
                           "feel along a recorded path and keep the way of the proxy"},
                          {"dtmri probe --example helix --path path.csv --mode anisotropy-point "
                           "--anisotropy-curve 0:0,0.3:6,smooth --out log.csv",
                           "stops where diffusion is isotropic; with a curve of its own"}}),
              fit_verb(
                  {{"dtmri fit dwi.nii.gz --out tensor.nii.gz",
                    "b-values and gradients lie next to the file"},
                   {"dtmri fit dwi.nii.gz --bval b.txt --bvec g.txt --mask brain.nii.gz --out tensor.nrrd",
                    "or are named, and so is the mask"}}),
              measure_verb({{"dtmri measure tensor.nii.gz --measure fa --out fa.nii.gz", "from tensors"},
                            {"dtmri measure dwi.nii.gz --measure color --out color.nii.gz",
                             "fitted first; main directions as colours"}}),
              report_verb(
                  "measure what noise, weighting, step and time do to directions and tracts", {Group::kInput},
                  {{"dtmri report dwi.nii.gz --out report",
                    "a page: directions against b-value and noise at these gradients, tracts against time"},
                   {"dtmri report --example helix --quick --out report",
                    "without a file, in a few seconds"}}),
              tracts_verb(
                  {{"dtmri tracts dwi.nii.gz --tracts bundle.trk", "do they fit the image?"},
                   {"dtmri tracts tensor.nii.gz --tracts bundle.tck --turn=-x,-y,z --out ras.tck",
                    "from LPS to RAS"},
                   {"dtmri tracts tensor.nii.gz --tracts bundle.trx --out bundle.trk",
                    "the same lines in another format"},
                   {"dtmri tracts tensor.nii.gz --tracts bundle.tck --profile fa.csv --density count.nii.gz",
                    "FA along the bundle, and the voxels that it passes"}}),
          },
  };
  return run_explorer(dtmri, argc, argv);
}
