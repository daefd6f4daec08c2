// `dtmri`, run as a user runs it.

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class Dtmri : public ExplorerTest {
 protected:
  Dtmri() : ExplorerTest("dtmri") {}
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

}  // namespace
}  // namespace palpate::test
