// A region of interest: what the window crops is what `grid clip --box` writes.
#include <fstream>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/technique/box_hold.h"
#include "common/load/write/write_image.h"
#include "common/window/controls/region_control.h"
#include "common/window/files/saved_files.h"
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
    const auto cropped =
        files.save_region(*image, region, ending, {.space = ImageSpace::kUnknown, .header = {}}).file;
    const auto clipped = "clip" + ending;
    const ProgramResult result =
        run({"clip", "--example", "shells", "--box", box_text(region), "--out", clipped});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const std::string wanted = bytes_of(folder_.path(clipped));
    EXPECT_FALSE(wanted.empty());
    EXPECT_EQ(bytes_of(cropped), wanted) << ending;
    // Never over a file that is there.
    EXPECT_NE(files.save_region(*image, region, ending, {.space = ImageSpace::kUnknown, .header = {}}).file,
              cropped);
  }
}

// In the type of the data, as far as a picture's single precision holds it.
TEST_F(GridRegion, TheWindowCropsInTheTypeOfTheData) {
  DataSet block = volume_example("shells");
  std::vector<double> values(block.arrays.at(0).tuples);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = 1000.0 / 3.0 - static_cast<double>(i % 701);
  const auto stored_as = [&]<typename Number>(ScalarType type, Number) {
    auto numbers = std::make_shared<std::vector<Number>>(values.begin(), values.end());
    DataArray& array = block.arrays.at(0);
    array.type = type;
    array.bytes = std::as_bytes(std::span<const Number>(*numbers));
    array.owner = numbers;
  };
  const SavedFiles files(folder_.path(), "grid");
  const auto compare = [&](bool exact) {
    const auto image = make_volume_image(block, kVolumeArray, "shells");
    const Box region = new_region(image->bounds());
    write_image(folder_.path("whole.nrrd"), std::get<UniformTopology>(block.topology), block.arrays.at(0),
                true, ImageSpace::kUnknown);
    const auto cropped =
        files.save_region(*image, region, ".nrrd", {.space = ImageSpace::kUnknown, .header = {}});
    EXPECT_EQ(cropped.exact, exact);
    const ProgramResult clipped =
        run({"clip", "whole.nrrd", "--box", box_text(region), "--out", "clipped.nrrd", "--force"});
    ASSERT_EQ(clipped.exit_code, 0) << clipped.err;
    const std::string made = bytes_of(cropped.file), wanted = bytes_of(folder_.path("clipped.nrrd"));
    EXPECT_TRUE(!exact || made == wanted) << name_of(block.arrays.at(0).type);
  };
  stored_as(ScalarType::kInt16, std::int16_t());
  compare(true);
  stored_as(ScalarType::kInt32, std::int32_t());
  compare(true);
  // A point without a value has no whole number: doubles.
  block.visible.assign(values.size(), 1);
  block.visible[values.size() / 2] = 0;
  const auto holed = make_volume_image(block, kVolumeArray, "shells");
  const auto hole =
      files.save_region(*holed, holed->bounds(), ".nrrd", {.space = ImageSpace::kUnknown, .header = {}});
  EXPECT_TRUE(hole.exact);
  EXPECT_NE(bytes_of(hole.file).find("type: double"), std::string::npos);
  block.visible.clear();
  stored_as(ScalarType::kFloat32, float());
  compare(true);
  stored_as(ScalarType::kFloat64, double());
  compare(false);
  for (double& value : values) value *= 1e9;
  stored_as(ScalarType::kInt64, std::int64_t());
  compare(false);
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

// A hand on the grid takes the face at +x from 0.5 to 0.72: with detents it is left on a voxel.
TEST_F(GridRegion, TheHandOnAGridLeavesTheFaceOnAVoxel) {
  const double spacing = 2.0 / 95.0;  // of the example: 96 points from -1 to 1
  const double from = -1.0 + 71.0 * spacing;
  {
    std::ofstream path(folder_.path("hand.csv"));
    path << "t,x,y,z,b0\n";
    for (int i = 0; i <= 300; ++i) {
      const double led = i < 60 ? 0.0 : i < 200 ? (i - 60) / 140.0 : (300 - i) / 100.0;
      path << 0.002 * i << ',' << from + led * (0.72 - from) << ',' << 0.004 * (i % 7 - 3) << ",0.1,"
           << (i >= 40 && i < 200 ? 1 : 0) << '\n';
    }
  }
  const std::vector<std::string> probe{"probe",  "--example", "shells",
                                       "--path", "hand.csv",  "--mode",
                                       "grid",   "--box",     "-0.5,-0.5,-0.5,0.5,0.5,0.5",
                                       "--json"};
  const auto box_after = [&](std::vector<std::string> words) {
    const ProgramResult result = run(words);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out).at("box").get<std::vector<double>>();
  };
  std::vector<std::string> with_detents = probe;
  with_detents.insert(with_detents.end(), {"--grid-detents", "1"});
  const std::vector<double> box = box_after(with_detents);
  ASSERT_EQ(box.size(), 6U);
  // A tooth is left for the next one where the hand is on that: the last node before 0.72.
  EXPECT_NEAR(box[3], -1.0 + std::floor((0.72 + 1.0) / spacing) * spacing, 1e-12);
  EXPECT_EQ(std::vector<double>({box[0], box[1], box[2], box[4], box[5]}),
            std::vector<double>({-0.5, -0.5, -0.5, 0.5, 0.5}));
  EXPECT_NEAR(box_after(probe)[3], 0.72, 0.005) << "where the hand was as it let go";
  // Away from all faces the button takes the view: the same pull moves its middle the other way, by whole
  // voxels of that axis alone.
  std::vector<std::string> away = with_detents;
  away[8] = "-0.9,-0.9,-0.9,0.99,0.9,0.9";
  away.insert(away.end(), {"--focal", "0.1,0.2,0.3"});
  const ProgramResult moved = run(away);
  ASSERT_EQ(moved.exit_code, 0) << moved.err;
  const auto focal = parse_json(moved.out).at("focal").get<std::vector<double>>();
  ASSERT_EQ(focal.size(), 3U);
  const double steps = (0.1 - focal[0]) / spacing;
  EXPECT_NEAR(steps, std::round(steps), 1e-9);
  EXPECT_NEAR(steps, std::floor((0.72 - from) / spacing), 1.0);
  EXPECT_EQ(focal[1], 0.2);
  EXPECT_EQ(focal[2], 0.3);
  EXPECT_EQ(box_after(away), std::vector<double>({-0.9, -0.9, -0.9, 0.99, 0.9, 0.9}));
  // So it does where the path ends with the button down.
  folder_.write("pressed.csv", "t,x,y,z,b0\n0,0,0,0,1\n0.1,0,0,0.2,1\n0.2,0,0,0.4,1\n");
  away[4] = "pressed.csv";
  const auto pressed = parse_json(run(away).out).at("focal").get<std::vector<double>>();
  EXPECT_LT(pressed[2], 0.0);
  EXPECT_EQ(pressed[0], 0.1);
  // At a face it does not.
  with_detents.insert(with_detents.end(), {"--focal", "0.1,0.2,0.3"});
  EXPECT_EQ(parse_json(run(with_detents).out).at("focal").get<std::vector<double>>(),
            std::vector<double>({0.1, 0.2, 0.3}));
  // Other modes know no box; what is none is refused.
  EXPECT_EQ(run({"probe", "--example", "shells", "--path", "hand.csv", "--box", "1,2", "--json"}).exit_code,
            2);
}

}  // namespace
}  // namespace palpate::test
