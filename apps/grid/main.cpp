/// grid: volumes of scalars, seen and felt.
#include "common/app/cli/verbs.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const Explorer grid{
      .name = "grid",
      .summary = "Explore volumes: CT, MR, densities and other scalars",
      .kind = FieldKind::kScalar,
      .examples = {{"grid info tooth.nhdr", "what the file holds"},
                   {"grid info avg152T1.nii.gz", "orientation included, in RAS+ mm"},
                   {"grid --example list", "the built-in volumes"}},
      .verbs = {info_verb(
          {{"grid info tooth.nhdr", "grid, values, orientation, memory"},
           {"grid info ct.raw --raw-size 512x512x300 --raw-type int16 --raw-spacing 0.5,0.5,1",
            "voxels without a header"},
           {"grid info head.nii.gz --explain", "and what each verb would load"}})},
  };
  return run_explorer(grid, argc, argv);
}
