// `grid`, run as a user runs it.

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Grid : public ExplorerTest {
 protected:
  Grid() : ExplorerTest("grid") {}
};

TEST_F(Grid, HelpsWithExamplesAndListsItsVerbs) {
  for (const std::vector<std::string>& arguments : {std::vector<std::string>{"--help"}, {"info", "--help"}}) {
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

}  // namespace
}  // namespace palpate::test
