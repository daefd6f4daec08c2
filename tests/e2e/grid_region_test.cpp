// A region of interest: what the window crops is what `grid clip --box` writes.
#include <fstream>
#include <sstream>
#include <string>

#include "common/app/window/region_control.h"
#include "common/app/window/saved_files.h"
#include "common/field/analytic/volume_examples.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class GridRegion : public ExplorerTest {
 protected:
  GridRegion() : ExplorerTest("grid") {}
};

std::string bytes_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

TEST_F(GridRegion, TheWindowCropsToWhatClipWrites) {
  const auto image = make_volume_image(volume_example("shells"), kVolumeArray, "shells");
  Box region = new_region(image->bounds());
  region.upper.x += 0.1 * image->bounds().size().x;
  const SavedFiles files(folder_.path(), "grid");
  for (const std::string ending : {".nrrd", ".vti", ".nii.gz"}) {
    const auto cropped = files.save_region(*image, region, ending);
    const auto clipped = "clip" + ending;
    const ProgramResult result =
        run({"clip", "--example", "shells", "--box", box_text(region), "--out", clipped});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string wanted = bytes_of(folder_.path(clipped));
    EXPECT_FALSE(wanted.empty());
    EXPECT_EQ(bytes_of(cropped), wanted) << ending;
    // Never over a file that is there.
    EXPECT_NE(files.save_region(*image, region, ending), cropped);
  }
}

// Verbs without a box leave it to those that have one.
TEST_F(GridRegion, SessionsWithABoxServeAllVerbs) {
  std::ofstream(folder_.path("box.toml")) << "format = 1\nprogram = \"grid\"\n[scene]\nexample = "
                                             "\"shells\"\nbox = \"-0.5,-0.5,-0.5,0.5,0.5,0.5\"\n";
  const ProgramResult picture = run({"render", "--session", "box.toml", "--size", "16x16", "--out", "a.png"});
  EXPECT_EQ(picture.exit_code, 0) << picture.err;
  const ProgramResult part = run({"clip", "--session", "box.toml", "--out", "session.nrrd"});
  ASSERT_EQ(part.exit_code, 0) << part.err;
  const ProgramResult same =
      run({"clip", "--example", "shells", "--box", "-0.5,-0.5,-0.5,0.5,0.5,0.5", "--out", "option.nrrd"});
  ASSERT_EQ(same.exit_code, 0) << same.err;
  EXPECT_EQ(bytes_of(folder_.path("session.nrrd")), bytes_of(folder_.path("option.nrrd")));
}

}  // namespace
}  // namespace palpate::test
