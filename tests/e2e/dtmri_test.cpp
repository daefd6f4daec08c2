// `dtmri`, run as a user runs it.

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Dtmri : public ExplorerTest {
 protected:
  Dtmri() : ExplorerTest("dtmri") {}

  /// The compressed pixels: what stands before them names the command.
  std::string pixels_of(const std::string& picture) const {
    const std::string content = read_file(folder_.path(picture));
    return content.substr(std::min(content.size(), content.find("IDAT")));
  }
};

TEST_F(Dtmri, HelpsWithExamples) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"info", "--help"}}) {
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0);
    EXPECT_NE(result.out.find("Examples:"), std::string::npos) << arguments[0];
    EXPECT_NE(result.out.find("  dtmri "), std::string::npos) << arguments[0];
  }
}

TEST_F(Dtmri, ListsItsOwnExamplesAndSaysWhatTheyHold) {
  const Json list = json({"info", "--example", "list"})["examples"];
  EXPECT_GE(list.size(), 1U);
  for (const Json& example : list) {
    const Json info = json({"info", "--example", example["name"]});
    EXPECT_EQ(info["arrays"].size(), 1U) << example;
    EXPECT_EQ(info["arrays"][0]["components"], 6) << example;
    EXPECT_GT(info["largest_trace"].get<double>(), 0.0) << example;
  }
  EXPECT_EQ(run({"info", "--example", "tornado"}).exit_code, 2);
}

TEST_F(Dtmri, SaysWhatATensorImageHolds) {
  PALPATE_NEED_DATA(helix, "dtmri/helix-synthetic/helix-DTI.nhdr");
  const Json info = json({"info", helix.string()});
  EXPECT_EQ(info["field"], "tensors");
  EXPECT_EQ(info["fields"], Json({"tensors"}));
  EXPECT_EQ(info["space"], "RAS");
  EXPECT_EQ(info["blocks"][0]["size"], Json({64, 32, 16}));
  EXPECT_GT(info["largest_trace"].get<double>(), 0.0);
}

TEST_F(Dtmri, RefusesFilesWithoutTensorsAndUnknownFields) {
  PALPATE_NEED_DATA(tooth, "grid/tooth/tooth.nhdr");
  PALPATE_NEED_DATA(helix, "dtmri/helix-synthetic/helix-DTI.nhdr");
  EXPECT_EQ(json({"info", tooth.string()})["field"], nullptr);
  const ProgramResult result = run({"info", "--field", "fibres", helix.string()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("tensors"), std::string::npos) << result.err;
}

// Of the example's main directions as an image of peaks, one a voxel; tensors are none.
TEST_F(Dtmri, StartsAlongPeaksWhereThereAreSome) {
  ASSERT_EQ(run({"measure", "--example", "helix", "--measure", "v1", "--out", "v1.nii.gz"}).exit_code, 0);
  const std::vector<std::string> rest{"--max-steps", "20", "--out", "t.tck", "-f"};
  const auto lines = [&](const std::string& file, const std::string& seeds) {
    std::vector<std::string> arguments{"trace", file, "--seeds", seeds};
    arguments.insert(arguments.end(), rest.begin(), rest.end());
    return json(arguments)["lines"].get<int>();
  };
  const int longest = lines("v1.nii.gz", "grid:6,6,6");
  EXPECT_GT(longest, 50);
  EXPECT_EQ(lines("v1.nii.gz", "peaks:grid:6,6,6"), longest);
  const ProgramResult refused =
      run({"trace", "--example", "helix", "--seeds", "peaks:fa:0.6", "--out", "u.tck"});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_NE(refused.err.find("no peaks"), std::string::npos) << refused.err;
}

TEST_F(Dtmri, RendersSlicesAndGlyphs) {
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n0.1,0,0,0.05\n0.2,5,0,0.1\n0.3,10,5,0.1\n");
  const Json made = json({"render", "--example", "helix", "--out", "a.png", "--size", "160x120"});
  EXPECT_EQ(made["voxels"], 41 * 41 * 41);
  EXPECT_GT(made["frame_ms"].get<double>(), 0.0);
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--slices", "none"},
        {"--slices", "-,-,0"},
        {"--color", "fa", "--voxels", "linear"},
        {"--path", "path.csv"},
        {"--glyphs", "superquadric", "--projection", "orthographic"}}) {
    std::vector<std::string> arguments{"render", "--example", "helix",   "--out",
                                       "b.png",  "--size",    "160x120", "-f"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    // Each shows something else.
    EXPECT_NE(pixels_of("a.png"), pixels_of("b.png")) << more.front();
  }
}

TEST_F(Dtmri, RefusesNonsenseBeforeItDraws) {
  for (const std::vector<std::string>& more : {std::vector<std::string>{"--slices", "1,2"},
                                               {"--slices", "nan,0,0"},
                                               {"--slices", "1e9,0,0"},
                                               {"--glyphs", "cubes"},
                                               {"--color", "speed"},
                                               {"--voxels", "cubic"}}) {
    std::vector<std::string> arguments{"render", "--example", "helix", "--out", "a.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << more.front();
    EXPECT_NE(result.err.find(more[1]), std::string::npos) << result.err;
  }
  EXPECT_TRUE(files().empty());
}

TEST_F(Dtmri, WithoutADisplayItDrawsAPictureOrSaysWhy) {
  EXPECT_EQ(run({}).exit_code, 0);
  EXPECT_EQ(files(), (std::vector<std::string>{"dtmri-tour.png"}));
  const ProgramResult refused = run({"--example", "helix"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("render"), std::string::npos) << refused.err;
}

TEST_F(Dtmri, FitsTheHeadAndMeasuresWhatItWrote) {
  PALPATE_NEED_DATA(dwi, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  const Json fit = json({"fit", dwi.string(), "--out", "tensor.nii.gz"});
  EXPECT_GT(fit["with_tensor"], 50'000);
  EXPECT_EQ(fit["suggested_turn"], "");
  const Json direct = json({"measure", dwi.string(), "--measure", "fa", "--out", "a.nii"});
  const Json written = json({"measure", "tensor.nii.gz", "--out", "b.nii"});  // fa is the default
  EXPECT_EQ(direct["with_tensor"], written["with_tensor"]);
  const auto voxels = [&](const char* name) { return read_file(folder_.path(name)).substr(352); };
  EXPECT_TRUE(voxels("a.nii") == voxels("b.nii"));
  // Both say what the head says of itself.
  for (const char* name : {"a.nii", "b.nii"})
    EXPECT_EQ(read_file(folder_.path(name)).substr(148, 5), "TE=79") << name;

  // A wrong axis is noticed, and the words that are suggested put it right.
  const Json flipped = json({"fit", dwi.string(), "--flip", "j", "--out", "flipped.nii.gz"});
  EXPECT_EQ(flipped["suggested_turn"], "--flip j");
  EXPECT_EQ(json({"fit", "flipped.nii.gz", "--flip", "j", "--out", "back.nii.gz"})["suggested_turn"], "");
}

TEST_F(Dtmri, ReportsOnExamplesAndAtTheGradientsOfAFile) {
  const Json made = json({"report", "--example", "helix", "--quick", "--out", "r"});
  EXPECT_GT(made["work_precision_rows"], 50);
  const Json report = parse_json(read_file(folder_.path("r/report.json")));
  EXPECT_FALSE(report["machine"]["processor"].get<std::string>().empty());
  EXPECT_FALSE(report.contains("reference"));  // of streamlines
  EXPECT_EQ(run({"report", "--example", "helix", "--quick", "--out", "r"}).exit_code, 2);
  EXPECT_EQ(run({"report", "--example", "helix", "--quick", "--out", "r", "--force"}).exit_code, 0);
  EXPECT_EQ(run({"report", "--example", "helix", "--quick"}).exit_code, 2);
  EXPECT_EQ(run({"report", "none.nii", "--quick", "--out", "s"}).exit_code, 3);
  EXPECT_EQ(files(), std::vector<std::string>{"r"});
  PALPATE_NEED_DATA(dwi, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  (void)json({"report", dwi.string(), "--quick", "--out", "head"});
  EXPECT_NE(read_file(folder_.path("head/index.html"))
                .find("13 volumes, 1 of them without weighting, b up to 1500"),
            std::string::npos);
}

TEST_F(Dtmri, ShowsTractsAndUnderlaysWithAndWithoutTensors) {
  (void)json({"trace", "--example", "helix", "--seeds", "fa:0.6", "--out", "t.tck"});
  (void)json({"measure", "--example", "helix", "--measure", "md", "--out", "md.nii.gz"});
  const auto picture = [&](const std::string& name, std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "render");
    arguments.insert(arguments.end(), {"--size", "160x120", "--out", name});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return pixels_of(name);
  };
  const std::string tensors = picture("1.png", {"--example", "helix"});
  const std::string blended = picture("2.png", {"--example", "helix", "--underlay", "md.nii.gz"});
  EXPECT_NE(blended, tensors);
  EXPECT_NE(picture("3.png", {"--example", "helix", "--underlay", "md.nii.gz", "--blend", "none"}), blended);
  EXPECT_NE(picture("4.png", {"--example", "helix", "--underlay", "md.nii.gz", "--level", "0"}), blended);
  const std::string tracts = picture("5.png", {"t.tck"});
  const std::string both = picture("6.png", {"t.tck", "--underlay", "md.nii.gz"});
  EXPECT_NE(tracts, both);
  EXPECT_NE(picture("7.png", {"t.tck", "--slices", "none", "--underlay", "md.nii.gz"}), both);
  const Json scalar =
      json({"render", "md.nii.gz", "--tracts", "t.tck", "--size", "160x120", "--out", "8.png"});
  EXPECT_EQ(scalar["lines"], json({"info", "t.tck"})["tracts"]["lines"]);
  EXPECT_TRUE(json({"info", "t.tck", "--explain"}).is_object());

  EXPECT_EQ(run({"render", "md.nii.gz", "--out", "x.png"}).exit_code, 3);  // neither tensors nor tracts
  EXPECT_EQ(run({"render", "t.tck", "--seeds", "fa:0.5", "--out", "x.png"}).exit_code, 2);
  EXPECT_EQ(run({"render", "t.tck", "--tracts", "t.tck", "--out", "x.png"}).exit_code, 2);
  EXPECT_EQ(run({"render", "t.tck", "--underlay", "none.nii", "--out", "x.png"}).exit_code, 3);
  EXPECT_EQ(run({"render", "--example", "helix", "--underlay", "t.tck", "--out", "x.png"}).exit_code, 3);
  EXPECT_EQ(run({"render", "--example", "helix", "--blend", "much", "--out", "x.png"}).exit_code, 2);
  EXPECT_EQ(run({"render", "--example", "helix", "--window", "0", "--out", "x.png"}).exit_code, 2);
  // Kinds of seeds that tracts cannot have are not among those that a refusal names.
  const ProgramResult seeds = run({"trace", "--example", "helix", "--seeds", "nowhere", "--out", "x.tck"});
  EXPECT_EQ(seeds.exit_code, 2);
  EXPECT_NE(seeds.err.find("fa:T"), std::string::npos) << seeds.err;
  EXPECT_NE(seeds.err.find("grid:nx,ny,nz"), std::string::npos) << seeds.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("x.png")));
}

TEST_F(Dtmri, RefusesToWriteOverFilesAndUnknownMeasures) {
  folder_.write("fa.nii", "precious");
  EXPECT_EQ(run({"measure", "--example", "straight", "--out", "fa.nii"}).exit_code, 2);
  EXPECT_EQ(read_file(folder_.path("fa.nii")), "precious");
  EXPECT_EQ(run({"measure", "--example", "straight", "--measure", "x", "--out", "x.nii"}).exit_code, 2);
  EXPECT_EQ(run({"measure", "--example", "straight", "--out", "x.png"}).exit_code, 2);
  EXPECT_EQ(run({"fit", "--example", "straight"}).exit_code, 2);
  folder_.write("path.csv", "t,x,y,z\n0,0,0,0\n1,1,0,0\n");
  EXPECT_EQ(
      run({"probe", "--example", "straight", "--path", "path.csv", "--out", "a.csv", "--tract", "./a.csv"})
          .exit_code,
      2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("a.csv")));
  EXPECT_EQ(run({"info", "--example", "straight", "--flip", "z"}).exit_code, 2);
}

}  // namespace
}  // namespace palpate::test
