// Lenses, slices and parts of volumes, as a user of `grid` asks for them.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <sstream>

#include <stb_image.h>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

/// A picture in memory.
struct Picture {
  int width = 0, height = 0;
  std::vector<unsigned char> rgb;

  [[nodiscard]] const unsigned char* at(int x, int y) const {
    return rgb.data() + 3 * (static_cast<std::ptrdiff_t>(y) * width + x);
  }
};

Picture read_picture(const std::filesystem::path& file) {
  Picture picture;
  int channels = 0;
  unsigned char* pixels = stbi_load(file.c_str(), &picture.width, &picture.height, &channels, 3);
  if (pixels == nullptr) return picture;
  picture.rgb.assign(pixels, pixels + std::ptrdiff_t{3} * picture.width * picture.height);
  stbi_image_free(pixels);
  return picture;
}

/// Share of pixels that differ by more than a hair.
double difference(const Picture& a, const Picture& b) {
  if (a.rgb.size() != b.rgb.size() || a.rgb.empty()) return -1.0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.rgb.size(); i += 3) {
    bool differs = false;
    for (std::size_t c = i; c < i + 3; ++c) differs = differs || std::abs(a.rgb[c] - b.rgb[c]) > 3;
    count += differs ? 1 : 0;
  }
  return static_cast<double>(count) / static_cast<double>(a.rgb.size() / 3);
}

class GridCut : public ExplorerTest {
 protected:
  GridCut() : ExplorerTest("grid") {}

  Picture render(const std::string& name, const std::vector<std::string>& more,
                 const std::string& verb = "render") {
    std::vector<std::string> arguments{verb, "--example", "shells",  "--size",    "96x96", "--out",
                                       name, "--camera",  "0,0,0,1", "--samples", "2"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_picture(folder_.path(name));
  }
};

TEST_F(GridCut, ALensChangesThePictureWhereItLies) {
  const Json info = json({"info", "--example", "shells"});
  const auto& lower = info["blocks"][0]["bounds"]["lower"];
  const auto& upper = info["blocks"][0]["bounds"]["upper"];
  const double middle = 0.5 * (lower[0].get<double>() + upper[0].get<double>());
  const double size = upper[0].get<double>() - lower[0].get<double>();
  const auto place = [&](double part) { return std::to_string(middle + part * size); };
  const std::string center = place(0) + "," + place(0) + "," + place(0);
  const Picture plain = render("plain.png", {});
  folder_.write("white.csv", "fraction,red,green,blue,opacity\n0,1,1,1,0.9\n1,1,1,1,0.9\n");
  const Picture lens = render("lens.png", {"--lens", "sphere:" + center + "," + std::to_string(0.25 * size),
                                           "--focus-tf", "white.csv", "--shading", "off"});
  // White in the middle, nothing else at the border.
  const unsigned char* seen = lens.at(48, 48);
  EXPECT_GT(std::min({seen[0], seen[1], seen[2]}), 200);
  const Picture unlit = render("unlit.png", {"--shading", "off"});
  EXPECT_GT(difference(unlit, lens), 0.05);
  EXPECT_LT(difference(unlit, lens), 0.5);
  // A lens beside the volume is none; one that cuts all of it away leaves nothing.
  EXPECT_LE(difference(plain, render("beside.png", {"--lens", "sphere:1e6,0,0,1"})), 0.001);
  const std::string below = std::to_string(lower[2].get<double>() - 1.0);
  const Picture gone = render("gone.png", {"--lens", "halfspace:0,0,1," + below + ",cut"});
  const Picture clipped = render("clipped.png", {"--clip", "0,0,1," + below});
  EXPECT_EQ(gone.rgb, clipped.rgb);
  EXPECT_GT(difference(plain, gone), 0.1);
  // The verb is the same picture.
  EXPECT_EQ(render("verb.png", {"--plane", "0,0,1," + below}, "clip").rgb, clipped.rgb);
}

TEST_F(GridCut, TakesTransferFunctionsAsPointsAndRefusesNonsenseInOneLine) {
  const Picture file = [&] {
    folder_.write("a.csv", "value,red,green,blue,opacity\n0,0,0,0,0\n255,1,0.5,0.25,0.5\n");
    return render("file.png", {"--context-tf", "a.csv"});
  }();
  EXPECT_EQ(render("points.png", {"--transfer-function", "points:0,0,0,0,0/255,1,0.5,0.25,0.5"}).rgb,
            file.rgb);

  const auto refused = [this](const std::vector<std::string>& more, int exit_code, const std::string& word) {
    std::vector<std::string> arguments{"render", "--example", "voxel", "--size", "32x32", "--out", "b.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("b.png")));
  };
  refused({"--lens", "ball:0,0,0,1"}, 2, "--lens ball:0,0,0,1");
  refused({"--lens", "sphere:0,0,0,nan"}, 2, "nan");
  refused({"--lens", "sphere:0,0,0,-1"}, 2, "radius");
  refused({"--clip", "0,0,0,1"}, 2, "--clip 0,0,0,1");
  refused({"--lens", "sphere:0,0,0,1", "--focus-tf", "rainbow"}, 2, "density");
  refused({"--focus-tf", "lost.csv"}, 3, "lost.csv");
  refused({"--focus-tf", "points:0,1,2"}, 2, "0,1,2");
  refused({"--focus-tf", "points:0,1,1,1,7"}, 2, "opacity");
}

TEST_F(GridCut, PlanesShowTheDataInTheirGreyValues) {
  const Json info = json({"info", "--example", "shells"});
  const auto& bounds = info["blocks"][0]["bounds"];
  const double middle = 0.5 * (bounds["lower"][1].get<double>() + bounds["upper"][1].get<double>());
  const std::string plane = "0,-1,0," + std::to_string(-middle);  // the half before it is cut away
  const Picture cut = render("cut.png", {"--clip", plane});
  const Picture shown = render("shown.png", {"--clip", plane, "--plane-image", "on"});
  EXPECT_GT(difference(cut, shown), 0.3);
  // All values above a window that ends far below them are white.
  const Picture white =
      render("white.png", {"--clip", plane, "--plane-image", "on", "--window", "1", "--level", "-1e6"});
  EXPECT_EQ(white.at(48, 48)[0], 255);
  const Picture lined = render("lined.png", {"--clip", plane, "--plane-image", "on", "--window", "1",
                                             "--level", "-1e6", "--contours", "0.5"});
  EXPECT_GT(difference(white, lined), 0.01);
  EXPECT_LT(difference(white, lined), 0.5);
  EXPECT_EQ(run({"render", "--example", "shells", "--window", "0", "--out", "x.png"}).exit_code, 2);
  EXPECT_EQ(run({"render", "--example", "shells", "--contours", "a", "--out", "x.png"}).exit_code, 2);
}

TEST_F(GridCut, SlicesShowVoxelsInTheirPlaces) {
  // Voxels 0 to 23 of 2 x 3 x 4, steps 1, 2, 3.
  std::string voxels;
  for (int i = 0; i < 24; ++i) voxels += static_cast<char>(i);
  folder_.write("a_2x3x4_uint8.raw", voxels);
  const std::vector<std::string> input{"a_2x3x4_uint8.raw", "--raw-size", "2x3x4", "--raw-type", "uint8",
                                       "--raw-spacing",     "1,2,3"};
  const auto slice = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments{"slice"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    return json(arguments);
  };
  const Json axial = slice({"--plane", "axial:3", "--out", "axial.vti"});
  EXPECT_EQ(axial["size"], Json({2, 3, 1}));
  EXPECT_EQ(axial["origin"], Json({0.0, 0.0, 3.0}));
  EXPECT_EQ(axial["right"], "+x");
  EXPECT_EQ(axial["up"], "+y");
  EXPECT_EQ(axial["outside"], 0);
  // The image opens again: the second layer, 6 to 11, where it was.
  const Json again = json({"info", "axial.vti"});
  EXPECT_EQ(again["arrays"][0]["ranges"][0], Json({6.0, 11.0}));
  EXPECT_EQ(again["blocks"][0]["bounds"]["lower"], Json({0.0, 0.0, 3.0}));
  const Json coronal = slice({"--plane", "coronal", "--out", "c.nii"});
  EXPECT_EQ(coronal["size"], Json({2, 4, 1}));
  EXPECT_EQ(coronal["up"], "+z");
  // Square pixels in a picture: 2 x 4 voxels of 1 x 3 are 2 x 10; 4 is black, 22 white.
  (void)slice({"--plane", "sagittal:1", "--out", "s.png", "--window", "18", "--level", "14"});
  const Picture picture = read_picture(folder_.path("s.png"));
  EXPECT_EQ(picture.width, 3);
  EXPECT_EQ(picture.height, 5);
  EXPECT_EQ(picture.at(0, 4)[0], 0);  // y = 0, z = 0: 1, below black
  EXPECT_EQ(picture.at(2, 0)[0],
            std::lround(255.0 * (21.0 - 5.0) / 18.0));  // y = 4, z = 8: between 17 and 23

  // Of values 6 + x + y the line of 8.5 is x + y = 2.5.
  EXPECT_EQ(slice({"--plane", "axial:3", "--contours", "8.5,7", "--out", "lines.csv"})["lines"], 2);
  std::istringstream rows(read_file(folder_.path("lines.csv")));
  std::string row;
  std::getline(rows, row);
  EXPECT_NE(row.find(",value"), std::string::npos) << row;
  int points = 0;
  while (std::getline(rows, row)) {
    std::array<double, 6> v{};
    std::istringstream fields(row);
    std::string field;
    for (double& number : v) number = std::getline(fields, field, ',') ? std::stod(field) : NAN;
    EXPECT_NEAR(v[3] + v[4], v[1] == 0.0 ? 2.5 : 1.0, 1e-6) << row;
    EXPECT_EQ(v[5], 3.0) << row;
    ++points;
  }
  EXPECT_GE(points, 4);

  const auto refused = [&](const std::vector<std::string>& more, int exit_code, const std::string& word) {
    std::vector<std::string> arguments{"slice", "--example", "voxel"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  refused({"--plane", "oblique", "--out", "x.png"}, 2, "axial");
  refused({"--plane", "axial:1e9", "--out", "x.png"}, 2, "passes by");
  refused({"--plane", "0,0,0,1", "--out", "x.png"}, 2, "--plane");
  refused({"--spacing", "1e-9", "--out", "x.png"}, 2, "--spacing");
  refused({"--window", "0", "--out", "x.png"}, 2, "--window");
  refused({"--out", "x.gif"}, 2, ".nii.gz");
  refused({"--contours", "1,two", "--out", "x.vtp"}, 2, "two");
  refused({"--contours", "1", "--out", "x.png"}, 2, ".vtp");
  refused({"--contours", "1e9", "--out", "x.vtp"}, 1, "reach");
  refused({}, 2, "--out");
}

TEST_F(GridCut, PartsAreWrittenInTheirPlacesAndOpenAgain) {
  std::string voxels;
  for (int i = 0; i < 60; ++i) voxels += static_cast<char>(i);
  folder_.write("a_3x4x5_uint8.raw", voxels);
  for (const std::string name : {"part.nii.gz", "part.nrrd", "part.vti"}) {
    const Json part =
        json({"clip", "a_3x4x5_uint8.raw", "--raw-size", "3x4x5", "--raw-type", "uint8", "--raw-spacing",
              "1,2,3", "--box", "0.5,1,3,9,4,9", "--plane", "0,0,1,6.5", "--out", name});
    EXPECT_EQ(part["size"], Json({2, 2, 3}));
    EXPECT_EQ(part["origin"], Json({1.0, 2.0, 3.0}));
    EXPECT_EQ(part["outside"], 4);  // the layer z = 9
    // The first voxel that is kept is (1, 1, 1): 1 + 3 + 12 = 16; the last one (2, 2, 2).
    const Json info = json({"info", name});
    EXPECT_EQ(info["range"], Json({16.0, 32.0})) << name;
    EXPECT_EQ(info["blocks"][0]["size"], Json({2, 2, 3})) << name;
    // NIfTI has no places but a patient's, which nothing is known of here.
    const bool placed = name != "part.nii.gz";
    EXPECT_EQ(info["blocks"][0]["bounds"]["lower"], placed ? Json({1.0, 2.0, 3.0}) : Json({0.0, 0.0, 0.0}))
        << name;
    EXPECT_EQ(info["blocks"][0]["bounds"]["upper"], placed ? Json({2.0, 4.0, 9.0}) : Json({1.0, 2.0, 6.0}))
        << name;
  }
  // Shapes cut voxels as they cut pictures, from a session, too; lenses that show something are left aside.
  const std::vector<std::string> cut{"clip",   "a_3x4x5_uint8.raw", "--raw-size", "3x4x5", "--raw-type",
                                     "uint8",  "--raw-spacing",     "1,2,3",      "--out", "cut.nrrd",
                                     "--force"};
  const auto cut_by = [&](const std::vector<std::string>& shapes) {
    std::vector<std::string> words = cut;
    for (const std::string& shape : shapes) words.insert(words.end(), {"--lens", shape});
    return json(words);
  };
  EXPECT_EQ(cut_by({"sphere:1,2,3,1.5,cut", "sphere:1,2,3,9"})["outside"], 3)
      << "a voxel and those beside it in x";
  EXPECT_EQ(cut_by({"sphere:1,2,3,1.5,cut", "halfspace:0,0,1,10,cut"})["outside"], 3 + 12);
  EXPECT_EQ(cut_by({"sphere:1,2,3,1.5,cut", "halfspace:0,0,1,10,cut,off"})["outside"], 3);
  std::vector<std::string> shown = cut;
  shown.insert(shown.end(), {"--lens", "sphere:1,2,3,9"});
  EXPECT_EQ(run(shown).exit_code, 2) << "nothing is cut";
  EXPECT_EQ(run({"clip", "--example", "voxel", "--out", "x.nrrd"}).exit_code, 2);
  EXPECT_EQ(run({"clip", "--example", "voxel", "--box", "1e9,0,0,2e9,1,1", "--out", "x.nrrd"}).exit_code, 2);
  EXPECT_EQ(run({"clip", "--example", "voxel", "--box", "1,2,3", "--out", "x.nrrd"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("x.nrrd")));
}

// More shapes than a uniform block of shaders has room for, each of them seen: holes in a white block, in a
// picture and in what is left of it, as options and from a session.
TEST_F(GridCut, CutsByAsManyShapesAsAreAsked) {
  constexpr int kSide = 16, kHoles = 40;
  constexpr double kRadius = 0.75;
  std::string voxels(std::size_t{kSide} * kSide * kSide, '\xc8');
  voxels.front() = '\0';
  folder_.write("block_16x16x16_uint8.raw", voxels);
  std::string shapes, opaque = "points:0,1,1,1,0/150,1,1,1,1/255,1,1,1,1";
  std::vector<std::string> typed;
  for (int i = 0; i < kHoles; ++i) {
    const std::string x = std::to_string(1 + 2 * (i % 7)), z = std::to_string(1 + 2 * (i / 7));
    const std::string through =
        "cylinder:" + x + ",-1," + z + "," + x + ",16," + z + "," + std::to_string(kRadius);
    (shapes += i > 0 ? ";" : "") += through + ",cut";
    typed.insert(typed.end(), {"--lens", through + ",cut"});
  }
  folder_.write("s.toml",
                "format = 1\nprogram = \"grid\"\n[[input]]\nfile = \"block_16x16x16_uint8.raw\"\n"
                "[scene]\nprojection = \"orthographic\"\nshading = \"off\"\ntransfer-function = \"" +
                    opaque + "\"\nlens = \"" + shapes + "\"\n");
  const Json part = json({"clip", "--session", "s.toml", "--out", "part.nrrd"});
  EXPECT_EQ(part["outside"], kHoles * kSide) << "the voxels on its middle line";

  const auto picture = [&](const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--camera", "0,0,0,1", "--size", "128x128", "--out", name});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_picture(folder_.path(name));
  };
  const Picture seen = picture("seen.png", {"render", "--session", "s.toml"});
  std::vector<std::string> words{
      "render", "block_16x16x16_uint8.raw", "--projection", "orthographic", "--shading",
      "off",    "--transfer-function",      opaque};
  const Picture whole = picture("whole.png", words);
  words.insert(words.end(), typed.begin(), typed.end());
  EXPECT_EQ(picture("typed.png", words).rgb, seen.rgb);

  // The block is in the middle of the picture, its voxels at 0 and 15 on its borders.
  const double middle = 0.5 * whole.width;
  int left = 0;
  while (left < whole.width / 2 && whole.at(left, whole.height / 2)[0] < 250) ++left;
  const double pixels = (whole.width - 2.0 * left) / (kSide - 1);
  ASSERT_GT(pixels, 3.0);
  int holes = 0;
  for (int i = 0; i < 49; ++i) {
    const auto is_cut = [&](double x) {
      const auto right = static_cast<int>(middle + pixels * (x - 0.5 * (kSide - 1)));
      const auto down = static_cast<int>(middle - pixels * (1.0 + 2.0 * (i / 7) - 0.5 * (kSide - 1)));
      return std::abs(seen.at(right, down)[0] - whole.at(right, down)[0]) > 60;
    };
    const double x = 1.0 + 2.0 * (i % 7);
    holes += is_cut(x) ? 1 : 0;
    EXPECT_FALSE(is_cut(x) && i >= kHoles) << i;
    EXPECT_FALSE(is_cut(x + 1.0)) << "between two holes, " << i;
  }
  constexpr int kWritten = 4;  // title, axes and colour bar lie over some
  EXPECT_GE(holes, kHoles - kWritten);
}

TEST_F(GridCut, ACoronalSliceOfARealHeadHasItsRightOnTheRight) {
  PALPATE_NEED_DATA(head, "grid/head-mr/avg152T1_RL_nifti.nii.gz");
  const Json slice = json({"slice", head.string(), "--plane", "coronal:-20", "--out", "slice.nii.gz"});
  EXPECT_EQ(slice["size"], Json({91, 91, 1}));
  EXPECT_EQ(slice["origin"], Json({-90.0, -20.0, -72.0}));
  EXPECT_EQ(slice["right"], "right");
  EXPECT_EQ(slice["up"], "head");
  const Json part = json({"clip", head.string(), "--box", "-41,-61,-1,41,21,51", "--out", "part.nrrd"});
  const Json info = json({"info", "part.nrrd"});
  EXPECT_EQ(info["blocks"][0]["bounds"]["lower"], Json({-40.0, -60.0, 0.0}));
  EXPECT_EQ(info["blocks"][0]["bounds"]["upper"], Json({40.0, 20.0, 50.0}));
  EXPECT_EQ(info["space"], "RAS");
  EXPECT_EQ(part["size"], Json({41, 41, 26}));
}

TEST_F(GridCut, SaysThatNoSurfaceIsWhereNoValueIs) {
  const std::vector<std::string> arguments{"render", "--example", "shells",  "--size",    "16x16",
                                           "--out",  "a.png",     "--force", "--isovalue"};
  const auto noted = [&](const std::string& isovalues) {
    std::vector<std::string> all = arguments;
    all.push_back(isovalues);
    const ProgramResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return result.err.find("outside the values of scalars") != std::string::npos;
  };
  EXPECT_TRUE(noted("5000"));
  EXPECT_TRUE(noted("-5000,100"));
  EXPECT_FALSE(noted("100"));
}

}  // namespace
}  // namespace palpate::test
