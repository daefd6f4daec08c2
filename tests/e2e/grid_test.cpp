// `grid`, run as a user runs it.

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include <stb_image.h>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Grid : public ExplorerTest {
 protected:
  Grid() : ExplorerTest("grid") {}
};

TEST_F(Grid, HelpsWithExamplesAndListsItsVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"},
                                                    {"info", "--help"},
                                                    {"probe", "-h"},
                                                    {"render", "-h"},
                                                    {"report", "-h"},
                                                    {"open", "-h"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << arguments[0];
    EXPECT_NE(result.out.find("  grid "), std::string::npos) << arguments[0];
  }
}

TEST_F(Grid, ListsItsOwnExamplesAndSaysWhatTheyHold) {
  const Json list = json({"info", "--example", "list"})["examples"];
  EXPECT_GE(list.size(), 4U);
  for (const Json& example : list) {
    const Json info = json({"info", "--example", example["name"]});
    EXPECT_EQ(info["field"], "scalars");
    EXPECT_EQ(info["arrays"].size(), 1U);
    EXPECT_LT(info["range"][0].get<double>(), info["range"][1].get<double>());
  }
  EXPECT_EQ(run({"info", "--example", "tornado"}).exit_code, 2);
}

// A ball that is red on one side and blue on the other: their magnitudes are one.
TEST_F(Grid, DrawsColoursAsColours) {
  constexpr int n = 24;
  std::string voxels;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const double x = i - 11.5, y = j - 11.5, z = k - 11.5;
        const bool in = x * x + y * y + z * z < 81.0;
        voxels += {in && x < 0.0 ? '\xff' : '\0', '\0', in && x >= 0.0 ? '\xff' : '\0'};
      }
    }
  }
  folder_.write("ball.nrrd",
                "NRRD0004\ntype: uint8\ndimension: 4\nsizes: 3 24 24 24\nkinds: RGB-color domain domain "
                "domain\nspacings: nan 1 1 1\nencoding: raw\n\n" +
                    voxels);
  for (const std::vector<std::string>& drawn :
       {std::vector<std::string>{"render", "ball.nrrd"}, {"clip", "ball.nrrd", "--plane", "0,1,0,11.5"}}) {
    std::vector<std::string> arguments = drawn;
    arguments.insert(arguments.end(), {"--size", "96x96", "--out", "a.png", "--force"});
    const ProgramResult result = run(arguments);
    ASSERT_EQ(result.exit_code, 0) << result.err;
    int width = 0, height = 0, channels = 0;
    stbi_uc* const pixels = stbi_load(folder_.path("a.png").c_str(), &width, &height, &channels, 3);
    ASSERT_NE(pixels, nullptr);
    EXPECT_NE(result.err.find("own colours"), std::string::npos) << result.err;
    int red = 0, blue = 0;
    for (int i = 0; i < width * height; ++i) {
      const int difference = pixels[3 * i] - pixels[3 * i + 2];
      red += difference > 60 ? 1 : 0;
      blue += difference < -60 ? 1 : 0;
    }
    stbi_image_free(pixels);
    EXPECT_GT(red, 200) << drawn[0];
    EXPECT_GT(blue, 200) << drawn[0];
  }
}

TEST_F(Grid, SaysWhatAHeaderlessFileHoldsByOptionsSidecarOrName) {
  std::string voxels;
  for (int i = 0; i < 24; ++i) voxels += {'\0', static_cast<char>(i)};
  folder_.write("a.raw", voxels);
  const Json info = json({"info", "a.raw", "--raw-size", "2x3x4", "--raw-type", "uint16", "--raw-endian",
                          "big", "--raw-spacing", "1,2,3"});
  EXPECT_EQ(info["range"], Json({0.0, 23.0}));
  EXPECT_EQ(info["blocks"][0]["bounds"]["upper"], Json({1.0, 4.0, 9.0}));
  EXPECT_EQ(info["space"], nullptr);

  const ProgramResult unknown = run({"info", "a.raw"});
  EXPECT_EQ(unknown.exit_code, 3);
  EXPECT_NE(unknown.err.find("--raw-size"), std::string::npos) << unknown.err;
  folder_.write("a.raw.toml", "[raw]\nsize = \"2x3x4\"\ntype = \"uint16\"\nendian = \"big\"\n");
  EXPECT_EQ(json({"info", "a.raw"})["range"], Json({0.0, 23.0}));
  folder_.write("b_2x3x8_uint8.raw", voxels);
  EXPECT_EQ(json({"info", "b_2x3x8_uint8.raw"})["blocks"][0]["size"], Json({2, 3, 8}));

  EXPECT_EQ(run({"info", "a.raw", "--raw-size", "2x3", "--raw-type", "uint16"}).exit_code, 2);
  EXPECT_EQ(run({"info", "a.raw", "--raw-size", "9x9x9", "--raw-type", "uint16"}).exit_code, 3);
}

TEST_F(Grid, SaysHowARealHeadLies) {
  PALPATE_NEED_DATA(head, "grid/head-mr/avg152T1_RL_nifti.nii.gz");
  const Json info = json({"info", head.string()});
  EXPECT_EQ(info["space"], "RAS");
  EXPECT_EQ(info["blocks"][0]["size"], Json({91, 109, 91}));
  EXPECT_EQ(info["blocks"][0]["bounds"]["lower"], Json({-90.0, -126.0, -72.0}));
  EXPECT_EQ(info["range"], Json({0.0, 255.0}));
  EXPECT_NE(info["orientation"][0].get<std::string>().find("R, A, S"), std::string::npos);
}

TEST_F(Grid, OpensWhatTheVtkAndNrrdHelpersRead) {
  PALPATE_NEED_DATA(tooth, "grid/tooth/tooth.nhdr");
  EXPECT_EQ(json({"info", tooth.string()})["range"], Json({0.0, 1300.0}));
  PALPATE_NEED_DATA(protein, "grid/ironprot/ironProt.vtk");
  EXPECT_EQ(json({"info", protein.string()})["range"], Json({0.0, 255.0}));
  const ProgramResult field = run({"info", tooth.string(), "--field", "density"});
  EXPECT_EQ(field.exit_code, 2);
  EXPECT_NE(field.err.find("scalars"), std::string::npos) << field.err;
}

/// Mean brightness of a picture's middle, 0 to 255.
double brightness(const std::filesystem::path& file) {
  int width = 0, height = 0, channels = 0;
  unsigned char* pixels = stbi_load(file.c_str(), &width, &height, &channels, 3);
  if (pixels == nullptr) return -1.0;
  double sum = 0.0;
  int count = 0;
  for (int y = 2 * height / 5; y < 3 * height / 5; ++y) {
    for (int x = 2 * width / 5; x < 3 * width / 5; ++x, ++count) {
      const unsigned char* p = pixels + 3 * (y * width + x);
      sum += (p[0] + p[1] + p[2]) / 3.0;
    }
  }
  stbi_image_free(pixels);
  return sum / count;
}

TEST_F(Grid, RendersWhatTheTransferFunctionShows) {
  folder_.write("clear.csv", "value,red,green,blue,opacity\n0,1,1,1,0\n255,1,1,1,0\n");
  const auto render = [this](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", "--example", "shells", "--size", "96x96", "--out", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return brightness(folder_.path(name));
  };
  const double clear = render("clear.png", {"--transfer-function", "clear.csv"});
  EXPECT_GT(render("automatic.png", {}), clear + 10.0);
  EXPECT_GT(render("density.png", {"--transfer-function", "density", "--shading", "off"}), clear + 10.0);
  EXPECT_EQ(files().size(), 4U) << "temporary files stay";
}

TEST_F(Grid, RenderStatesItsErrorAndRefusesNonsense) {
  const Json summary = json({"render", "--example", "marschner-lobb", "--size", "64x48", "--out", "a.png",
                             "--projection", "orthographic", "--explain"});
  EXPECT_EQ(summary["voxels"], 41 * 41 * 41);
  std::uint64_t voxel_bytes = 0;
  for (const Json& object : summary["explain"])
    voxel_bytes += object["what"] == "texture voxels" ? object["bytes"].get<std::uint64_t>() : 0U;
  EXPECT_EQ(voxel_bytes, 4U * 41U * 41U * 41U);
  EXPECT_GE(summary["image_error"].get<double>(), 0.0);
  EXPECT_LT(summary["image_error"].get<double>(), 0.02);
  EXPECT_GT(summary["frame_ms"].get<double>(), 0.0);

  const auto refused = [this](const std::vector<std::string>& more, int exit_code, const std::string& word) {
    std::vector<std::string> arguments{"render", "--example", "voxel", "--size", "32x32", "--out", "b.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, exit_code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
    EXPECT_FALSE(std::filesystem::exists(folder_.path("b.png")));
  };
  refused({"--transfer-function", "rainbow"}, 2, "density");
  refused({"--transfer-function", "lost.csv"}, 3, "lost.csv");
  folder_.write("bad.csv", "value,red,green,blue,opacity\n0,0,0,0,0\n1,nan,0,0,1\n");
  refused({"--transfer-function", "bad.csv"}, 3, "bad.csv");
  refused({"--samples", "0"}, 2, "--samples");
  refused({"--projection", "fisheye"}, 2, "--projection");
  refused({"--field", "density"}, 2, "scalars");
}

TEST_F(Grid, StoresVoxelsInTheMemoryGiven) {
  const auto voxels = [this](const std::string& memory) {
    const Json summary = json({"render", "--example", "shells", "--size", "64x48", "--out",
                               "memory" + memory + ".png", "--gpu-memory", memory, "--explain"});
    std::pair<std::string, std::uint64_t> found{"", 0U};
    for (const Json& object : summary["explain"]) {
      std::string what = object["what"].get<std::string>();
      if (!what.starts_with("texture ")) continue;
      what.erase(0, std::string_view("texture ").size());
      if (!what.starts_with("voxels") && what != "index of bricks") continue;
      if (what.starts_with("voxels")) found.first = what;
      found.second += object["bytes"].get<std::uint64_t>();
    }
    return found;
  };
  const auto [whole, all] = voxels("1000");
  EXPECT_EQ(whole, "voxels");
  const auto megabytes = [](std::uint64_t bytes) {
    return std::to_string(static_cast<double>(bytes) / 1048576.0);
  };
  const auto [bricks, some] = voxels(megabytes(all - all / 16));
  EXPECT_TRUE(bricks.starts_with("voxels")) << bricks;
  EXPECT_LE(some, all - all / 16);
  EXPECT_GT(some, all / 16);
  EXPECT_LE(voxels(megabytes(all / 100)).second, all / 100);
  EXPECT_EQ(run({"render", "--example", "shells", "--gpu-memory", "0", "--out", "c.png"}).exit_code, 2);
  // A coarser picture is not passed off as the volume's.
  const auto said = [this](const std::string& memory) {
    return run({"render", "--example", "shells", "--size", "32x32", "--gpu-memory", memory, "--out",
                "said" + memory + ".png"})
               .err.find("finer ones do not fit --gpu-memory") != std::string::npos;
  };
  EXPECT_FALSE(said("1000"));
  EXPECT_TRUE(said(megabytes(all / 100)));
}

// Through the outermost shell of the example "shells", radius 0.86, and on to the middle.
// A budget that no picture keeps leaves the coarsest one, a generous one all that was asked for.
TEST_F(Grid, GivesUpQualityForABudgetAndSaysHowMuch) {
  const auto render = [this](const std::string& budget, const std::string& name) {
    return json({"render", "--example", "shells", "--size", "200x150", "--lens", "sphere:0,0,0,0.5",
                 "--frame-budget", budget, "--out", name});
  };
  const Json hasty = render("1", "hasty.png"), patient = render("60000", "patient.png");
  const auto expect_quality = [](const Json& picture, double context, double focus, double viewport,
                                 double resolution) {
    const Json& quality = picture["quality"];
    EXPECT_EQ(quality["context_samples"], context);
    EXPECT_EQ(quality["focus_samples"], focus);
    EXPECT_EQ(quality["context_resolution"], viewport);
    EXPECT_EQ(quality["resolution"], resolution);
  };
  expect_quality(hasty, 0.25, 0.5, 0.25, 0.25);
  expect_quality(patient, 1.0, 1.0, 1.0, 1.0);
  EXPECT_GT(hasty["image_error"].get<double>(), 2.0 * patient["image_error"].get<double>());
  // What a budget expects knows before the picture is there that outlines get thicker.
  const double hasty_error = hasty["image_error"].get<double>();
  EXPECT_NEAR(hasty["quality"]["expected_error"].get<double>(), hasty_error, 0.2 * hasty_error);
  EXPECT_NEAR(patient["quality"]["expected_error"].get<double>(), patient["image_error"].get<double>(), 1e-3);
  const Json converged = json({"render", "--example", "shells", "--size", "200x150", "--lens",
                               "sphere:0,0,0,0.5", "--converged", "--out", "converged.png"});
  EXPECT_LT(255.0 * converged["image_error_worst"].get<double>(), 1.5);
  EXPECT_EQ(run({"render", "--example", "shells", "--converged", "--frame-budget", "9", "--out", "c.png"})
                .exit_code,
            2);
  EXPECT_EQ(run({"render", "--example", "shells", "--frame-budget", "0", "--out", "c.png"}).exit_code, 2);
}

TEST_F(Grid, EnlargesInALensAndRefusesWhereThereIsNoMiddle) {
  EXPECT_EQ(run({"render", "--example", "shells", "--size", "64x48", "--lens", "sphere:0,0,0,0.5,magnify=2",
                 "--out", "a.png"})
                .exit_code,
            0);
  const ProgramResult refused =
      run({"render", "--example", "shells", "--lens", "halfspace:1,0,0,0,magnify=2", "--out", "b.png"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("magnify"), std::string::npos) << refused.err;
}

TEST_F(Grid, ReportsErrorsAgainstTheTimeOfAFrame) {
  const Json summary = json({"report", "--example", "shells", "--quick", "--out", "report"});
  EXPECT_GT(summary["work_precision_rows"].get<int>(), 10);
  const Json report = parse_json(read_file(folder_.path("report/report.json")));
  EXPECT_EQ(report["work_precision"].size(), summary["work_precision_rows"].get<std::size_t>());
  EXPECT_TRUE(std::filesystem::exists(folder_.path() / "report" / "volume_error.svg"));
  EXPECT_EQ(run({"report", "--example", "shells", "--out", "report"}).exit_code, 2);  // is there already
}

TEST_F(Grid, ProbesIsosurfacesAndDensities) {
  std::string path = "t,x,y,z\n";
  for (int i = 0; i <= 300; ++i)
    path += std::to_string(1e-3 * i) + "," + std::to_string(1.0 - i / 300.0) + ",0,0\n";
  folder_.write("path.csv", path);
  for (const std::string mode : {"isosurface", "density"}) {
    const Json summary = json({"probe", "--example", "shells", "--path", "path.csv", "--mode", mode, "--out",
                               mode + ".csv", "--workspace-scale", "0.05"});
    EXPECT_EQ(summary["steps"], 301);
    EXPECT_EQ(summary["faults"], 0);
    EXPECT_EQ(summary["mode"], mode);
    EXPECT_GT(summary["max_force_n"].get<double>(), 0.01) << mode;
    EXPECT_LE(summary["max_force_n"].get<double>(), summary["force_cap_n"].get<double>()) << mode;
  }
  const ProgramResult unknown =
      run({"probe", "--example", "shells", "--path", "path.csv", "--mode", "streamline", "--json"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("isosurface, density"), std::string::npos) << unknown.err;
}

TEST_F(Grid, DrawsThinConstantAnisotropicAndEmptyVolumes) {
  std::string numbers;
  for (int i = 0; i < 64; ++i) {
    const float value =
        i % 5 == 0 ? std::numeric_limits<float>::quiet_NaN() : std::sin(static_cast<float>(i));
    numbers.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  std::string nothing;
  for (int i = 0; i < 64; ++i) nothing += std::string("\0\0\xc0\x7f", 4);  // NaN
  folder_.write("thin_8x8x1_uint8.raw", std::string(32, '\0') + std::string(32, '\x7f'));
  folder_.write("constant_4x4x4_uint8.raw", std::string(64, '\7'));
  folder_.write("holes_4x4x4_float32.raw", numbers);
  folder_.write("nothing_4x4x4_float32.raw", nothing);
  for (const std::string name :
       {"thin_8x8x1_uint8", "constant_4x4x4_uint8", "holes_4x4x4_float32", "nothing_4x4x4_float32"}) {
    const ProgramResult result = run({"render", name + ".raw", "--size", "32x32", "--out", name + ".png"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(run({"info", name + ".raw"}).exit_code, 0) << name;
  }
  const ProgramResult stretched =
      run({"render", "holes_4x4x4_float32.raw", "--raw-size", "4x4x4", "--raw-type", "float32",
           "--raw-spacing", "1,1,1000", "--size", "32x32", "--out", "stretched.png"});
  EXPECT_EQ(stretched.exit_code, 0) << stretched.err;
}

TEST_F(Grid, TakesWhatASessionHoldsAndWhatIsTypedInstead) {
  folder_.write("s.toml",
                "format = 1\nprogram = \"grid\"\n[scene]\nexample = \"voxel\"\nsamples = \"2\"\n"
                "shading = \"off\"\nprojection = \"orthographic\"\ntransfer-function = \"rainbow\"\n");
  EXPECT_EQ(run({"render", "--session", "s.toml", "--size", "32x32", "--out", "a.png"}).exit_code, 2);
  const ProgramResult typed = run(
      {"render", "--session", "s.toml", "--transfer-function", "mr", "--size", "32x32", "--out", "a.png"});
  EXPECT_EQ(typed.exit_code, 0) << typed.err;
  EXPECT_NE(typed.err.find("example voxel"), std::string::npos) << typed.err;
}

TEST_F(Grid, WithoutADisplayItDrawsAPictureOrSaysWhy) {
  const ProgramResult alone = run({});
  EXPECT_EQ(alone.exit_code, 0) << alone.err;
  EXPECT_TRUE(std::filesystem::exists(folder_.path("grid-tour.png")));
  const ProgramResult named = run({"--example", "blob"});
  EXPECT_EQ(named.exit_code, 1);
  EXPECT_NE(named.err.find("no display"), std::string::npos) << named.err;
  EXPECT_EQ(run({"lost.nrrd"}).exit_code, 3);
}

}  // namespace
}  // namespace palpate::test
