/// grid: volumes of scalars, seen and felt.
#include "apps/grid/grid_verbs.h"
#include "apps/grid/study/plane_task.h"
#include "common/cli/verbs.h"
#include "common/experiment/study_verb.h"
#include "common/hand/mode/haptic_mode.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer grid{
      .name = "grid",
      .summary = "Explore volumes: CT, MR, densities and other scalars",
      .kind = FieldKind::kScalar,
      .examples = {{"grid tooth.nhdr", "look at a file in the window"},
                   {"grid info tooth.nhdr", "what the file holds"},
                   {"grid info avg152T1.nii.gz", "orientation included, in RAS+ mm"},
                   {"grid render tooth.nhdr --out tooth.png", "a picture, with or without a display"},
                   {"grid slice tooth.nhdr --plane coronal --out slice.png",
                    "a slice; as an image: slice.vti"},
                   {"grid probe tooth.nhdr --path path.csv --out log.csv",
                    "along a haptic grid, on a recorded path"},
                   {"grid --example list", "the built-in volumes"}},
      .verbs =
          {info_verb({{"grid info tooth.nhdr", "grid, values, orientation, memory"},
                      {"grid info ct.raw --raw-size 512x512x300 --raw-type int16 --raw-spacing 0.5,0.5,1",
                       "voxels without a header"},
                      {"grid info head.nii.gz --explain", "and what that took, and what it left out"}}),
           probe_verb(modes_of(FieldKind::kScalar),
                      {{"grid probe tooth.nhdr --path path.csv --out log.csv --grid-peaks 2",
                        "along one axis of the voxels at a time, with notches where values pile up"},
                       {"grid probe tooth.nhdr --path path.csv --mode grid --box 20,20,40,80,70,120 --json",
                        "the button takes hold of faces of a region; where they lie at the end"},
                       {"grid probe tooth.nhdr --path path.csv --mode plane-widget --json",
                        "finds, moves and turns a cutting plane; where it lies at the end"},
                       {"grid probe tooth.nhdr --path path.csv --mode isosurface --out log.csv",
                        "stopped by the surface between object and background"},
                       {"grid probe --example blob --path path.csv --mode density --json",
                        "another mode; the summary as JSON"}}),
           volume_render_verb(
               modes_of(FieldKind::kScalar),
               {{"grid render tooth.nhdr --out tooth.png --size 1920x1080",
                 "colours and opacities from the histogram"},
                {"grid render ct.nii.gz --transfer-function ct --camera 0,0,0,1 --out ct.png",
                 "Hounsfield units, seen from the back to the front"},
                {"grid render tooth.nhdr --clip 1,0,0,52 --plane-image on --contours 900 --out cut.png",
                 "cut open, with the data and a line of equal value on the cut"},
                {"grid render tooth.nhdr --lens sphere:51,20,90,28 --out enamel.png",
                 "a lens that shows the denser half inside"},
                {"grid render head.nii.gz --lens box:0,-90,-72,90,90,108,cut --lens sphere:0,-40,10,35 "
                 "--focus-tf mr --out lens.png",
                 "cut open, with a lens of its own transfer function"},
                {"grid render tooth.nhdr --focus-tf boundaries --lens sphere:51,20,90,28 --out borders.png",
                 "borders between kinds of matter, by value and gradient, in a lens"},
                {"grid render ct.nii.gz --transfer-function ct --lens "
                 "sphere:0,0,0,60,field=pet.nii.gz,tf=density "
                 "--out both.png",
                 "another volume in a lens, on its own grid"},
                {"grid render tooth.nhdr --isovalue 900 --path path.csv --out touched.png",
                 "with a surface, and the forces of it on a hand along that path"},
                {"grid render --example shells --transfer-function shells.csv --out shells.png",
                 "with a transfer function of your own"}}),
           slice_verb(
               {{"grid slice head.nii.gz --plane coronal:-20 --out slice.png", "right stays on the right"},
                {"grid slice head.nii.gz --layout 4 --cross 0,-20,15 --out slices.png",
                 "three slices through a place, and the volume"},
                {"grid slice ct.nii.gz --plane axial:40 --window 400 --level 40 --out soft.png",
                 "Hounsfield units from -160 to 240"},
                {"grid slice tooth.nhdr --plane 1,1,1,150 --spacing 0.5 --out oblique.vti",
                 "an oblique slice as an image with its place, for ParaView"},
                {"grid slice tooth.nhdr --plane axial:100 --contours 400,900 --out lines.vtp",
                 "lines of equal value on a slice, with the error of each point"}}),
           clip_verb({{"grid clip tooth.nhdr --plane 0,1,0,45 --out cut.png",
                       "a picture without what lies where y > 45"},
                      {"grid clip head.nii.gz --box -40,-60,0,40,20,50 --out part.nii.gz",
                       "a part of the volume, in its place"},
                      {"grid clip --session tooth.palpate.toml --out cut.nrrd",
                       "what the planes of a window have left of its volume"}}),
           report_verb(
               "measure what ways to draw this volume faster cost in errors of its picture",
               {Group::kInput, Group::kView},
               {{"grid report tooth.nhdr --out report",
                 "error of the picture against milliseconds a frame, and how well a hand places planes"},
                {"grid report --example shells --quick --out report", "a first look"}}),
           annotate_verb({{"grid annotate tooth.nhdr --annotation length:51,40,10,51,40,150 --out n.csv",
                           "a length, as a table; .vtp for ParaView"}}),
           study_verb([] { return StudyTasks{make_plane_task()}; },
                      {{"grid study make trial-study",
                        "an experiment in which people place planes, with guidance and without"},
                       {"grid study simulate trial-study", "simulated participants in all places"}}),
           open_volume_verb({{"grid tooth.nhdr", "a file in the window"},
                             {"grid --example shells", "a built-in volume"},
                             {"grid open --session tooth.palpate.toml", "what Ctrl+S saved"}})},

  };
  return run_explorer(grid, argc, argv);
}
