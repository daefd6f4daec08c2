// Pictures for two eyes, and for a head before a screen of a workbench, from the command line.

#include <string>
#include <vector>

#include <stb_image.h>

#include "common/base/json.h"
#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

const char* const kBench =
    "[[screen]]\nname = 'front'\nlower_left = [-0.2, -0.15, 0]\nlower_right = [0.2, -0.15, 0]\nupper_left = "
    "[-0.2, 0.15, 0]\n[[screen]]\nname = 'wide'\nlower_left = [-0.4, -0.15, 0]\nlower_right = [0.4, -0.15, "
    "0]\nupper_left = [-0.4, 0.15, 0]\n[interaction]\nmiddle = [0, 0, 0]\nrotation = [1, 0, 0, 0]\n";

class Stereo : public ExplorerTest {
 protected:
  Stereo() : ExplorerTest("grid") { folder_.write("workbench.toml", kBench); }
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
  const auto head = run({"render", "--example", "shells", "--size", "64x48", "--workbench", "workbench.toml",
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
  refused({"--workbench", "workbench.toml", "--head", "0,0,-1"}, "before the screen");
  refused({"--workbench", "workbench.toml", "--head", "0,1"}, "--head");
  refused({"--workbench", "workbench.toml", "--head", "0,0,1,2,0,0,0"}, "length 1");
  refused({"--workbench", "workbench.toml", "--head", "0,0,1", "--screen", "wide"}, "--size");
  refused({"--workbench", "workbench.toml", "--head", "0,0,1", "--screen", "rear"}, "front, wide");
  folder_.write("bare.toml", "[stylus]\ntip = [0, 0, 0]\n");
  refused({"--workbench", "bare.toml", "--head", "0,0,1"}, "[screen]", 3);
}

// A picture for each screen, in its own pixels, and each the one that is asked for alone.
TEST_F(Stereo, DrawsEveryScreenFromOneHead) {
  folder_.write("pixels.toml",
                "[[screen]]\nname = 'front'\npixels = [80, 60]\nlower_left = [-0.2, -0.15, 0]\nlower_right = "
                "[0.2, -0.15, 0]\nupper_left = [-0.2, 0.15, 0]\n[[screen]]\npixels = [48, 60]\nstereo = "
                "'quad-buffer'\nlower_left = [0.2, -0.15, 0]\nlower_right = [0.2, -0.15, 0.24]\nupper_left = "
                "[0.2, 0.15, 0]\n[interaction]\nmiddle = [0, 0, 0]\n");
  const std::vector<std::string> head{"render",      "--example", "shells",    "--workbench",
                                      "pixels.toml", "--head",    "-0.1,0,0.6"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = head;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  const auto all = with({"--screen", "all", "--out", "seen.png"});
  ASSERT_EQ(all.exit_code, 0) << all.err;
  EXPECT_NE(all.out.find("seen-front.png (80 x 60"), std::string::npos) << all.out;
  EXPECT_NE(all.out.find("seen-2.png (48 x 120"), std::string::npos) << all.out;
  const auto alone = with({"--screen", "front", "--out", "alone.png"});
  ASSERT_EQ(alone.exit_code, 0) << alone.err;
  int width = 0, height = 0;
  const auto pixels = [&](const char* name) {
    unsigned char* data = stbi_load(folder_.path(name).c_str(), &width, &height, nullptr, 4);
    std::vector<unsigned char> out(data, data + 4 * width * height);
    stbi_image_free(data);
    return out;
  };
  EXPECT_EQ(pixels("seen-front.png"), pixels("alone.png"));
  EXPECT_EQ(with({"--screen", "all", "--out", "seen.png"}).exit_code, 2) << "they are there already";
}

// What a hand picks that points into the picture: told, and marked there.
TEST_F(Stereo, MarksWhatIsPickedByARayOrThroughAnAperture) {
  const auto picks = [this](const std::string& by) {
    const auto result =
        run({"render", "--example", "shells", "--size", "64x48", "--lens", "sphere:0.5,0,0,0.1", "--clip",
             "0,0,1,0.3", "--pick", by, "--json", "--out", "p.png", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parse_json(result.out).at("picked");
  };
  const auto lens = picks("ray:0.5,0,5,0,0,-1");
  EXPECT_EQ(lens.at("what"), "lens 1");
  EXPECT_NEAR(lens.at("z").get<double>(), 0.1, 1e-12);
  EXPECT_EQ(picks("aperture:0.55,0,5,0.55,0,4,0.05").at("what"), "lens 1");
  EXPECT_EQ(picks("ray:-0.5,0,5,0,0,-1").at("what"), "plane 1");
  EXPECT_TRUE(picks("ray:0,0,500,0,0,1").is_null());
  EXPECT_EQ(run({"render", "--example", "shells", "--pick", "0,0,1", "--out", "p.png"}).exit_code, 2);
}

// A recorded head: its end by default, another time where that is asked for, ahead by the workbench's
// latency.
TEST_F(Stereo, FollowsARecordedHead) {
  folder_.write("head.csv",
                "t,x,y,z,qw,qx,qy,qz\n0,0,0,0.6,1,0,0,0\n0.05,0.02,0,0.6,1,0,0,0\n0.1,0.04,0,0.6,1,0,0,0\n");
  folder_.write("ahead.toml", std::string(kBench) + "[head]\nlatency = 0.05\n");
  const auto picture = [&](const char* workbench, std::vector<std::string> head, const char* out) {
    std::vector<std::string> arguments{"render",      "--example", "shells", "--size", "64x48",
                                       "--workbench", workbench,   "--out",  out,      "--force"};
    arguments.insert(arguments.end(), head.begin(), head.end());
    const auto result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    // Without the text that holds the command line.
    int width = 0, height = 0;
    unsigned char* data = stbi_load(folder_.path(out).c_str(), &width, &height, nullptr, 4);
    std::vector<unsigned char> pixels(data, data + 4 * width * height);
    stbi_image_free(data);
    return pixels;
  };
  const auto at = [&](const char* place) {
    return picture("workbench.toml", {"--head", place}, "still.png");
  };
  EXPECT_EQ(picture("workbench.toml", {"--head", "replay:head.csv"}, "end.png"), at("0.04,0,0.6"));
  EXPECT_EQ(picture("workbench.toml", {"--head", "replay:head.csv", "--head-time", "0.06"}, "early.png"),
            at("0.024,0,0.6"));
  EXPECT_EQ(picture("ahead.toml", {"--head", "replay:head.csv"}, "ahead.png"), at("0.06,0,0.6"));
  EXPECT_NE(at("0.04,0,0.6"), at("0.06,0,0.6"));
  EXPECT_EQ(run({"render", "--example", "shells", "--out", "x.png", "--head-time", "1"}).exit_code, 2);
  EXPECT_EQ(run({"render", "--example", "shells", "--out", "x.png", "--workbench", "workbench.toml", "--head",
                 "replay:none.csv"})
                .exit_code,
            3);
  EXPECT_EQ(
      run({"open", "--example", "shells", "--workbench", "workbench.toml", "--head", "hands"}).exit_code, 2);
}

}  // namespace
}  // namespace palpate::test
