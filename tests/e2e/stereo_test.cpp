// Pictures for two eyes, and for a head before a screen of a workbench, from the command line.

#include <string>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

const char* const kBench =
    "[[screen]]\nname = 'front'\nlower_left = [-0.2, -0.15, 0]\nlower_right = [0.2, -0.15, 0]\nupper_left = "
    "[-0.2, 0.15, 0]\n[[screen]]\nname = 'wide'\nlower_left = [-0.4, -0.15, 0]\nlower_right = [0.4, -0.15, "
    "0]\nupper_left = [-0.4, 0.15, 0]\n[interaction]\nmiddle = [0, 0, 0]\nrotation = [1, 0, 0, 0]\n";

class Stereo : public ExplorerTest {
 protected:
  Stereo() : ExplorerTest("grid") { folder_.write("bench.toml", kBench); }
};

TEST_F(Stereo, SaysWhatTheEyesSeeAndKeepsItInReach) {
  const auto wide =
      run({"render", "--example", "shells", "--size", "64x48", "--stereo", "anaglyph", "--out", "a.png"});
  EXPECT_EQ(wide.exit_code, 0) << wide.err;
  EXPECT_NE(wide.out.find("brought to"), std::string::npos) << wide.out;
  const auto free = run({"render", "--example", "shells", "--size", "64x48", "--stereo", "rows",
                         "--disparity-limit", "20", "--out", "b.png"});
  EXPECT_EQ(free.exit_code, 0) << free.err;
  EXPECT_EQ(free.out.find("brought to"), std::string::npos) << free.out;
  const auto head = run({"render", "--example", "shells", "--size", "64x48", "--workbench", "bench.toml",
                         "--head", "0.1,0,0.6", "--stereo", "columns", "--out", "c.png"});
  EXPECT_EQ(head.exit_code, 0) << head.err;
  EXPECT_NE(head.out.find("stereo columns"), std::string::npos) << head.out;
}

TEST_F(Stereo, RefusesWhatCannotBeShown) {
  const auto refused = [this](std::vector<std::string> more, const char* word, int code = 2) {
    std::vector<std::string> arguments{"render", "--example", "shells", "--size", "64x48", "--out", "x.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, code) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  };
  refused({"--stereo", "cross"}, "anaglyph-grey");
  refused({"--stereo", "rows", "--projection", "orthographic"}, "perspective");
  refused({"--head", "0,0,1"}, "--workbench");
  refused({"--screen", "front"}, "--head");
  refused({"--workbench", "bench.toml", "--head", "0,0,-1"}, "before the screen");
  refused({"--workbench", "bench.toml", "--head", "0,1"}, "--head");
  refused({"--workbench", "bench.toml", "--head", "0,0,1,2,0,0,0"}, "length 1");
  refused({"--workbench", "bench.toml", "--head", "0,0,1", "--screen", "wide"}, "--size");
  refused({"--workbench", "bench.toml", "--head", "0,0,1", "--screen", "rear"}, "front, wide");
  folder_.write("bare.toml", "[stylus]\ntip = [0, 0, 0]\n");
  refused({"--workbench", "bare.toml", "--head", "0,0,1"}, "[screen]", 3);
}

}  // namespace
}  // namespace palpate::test
