// Films of the built `flow`: numbered pictures, the same as those that are drawn alone, and what ffmpeg is given.

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

class Film : public ExplorerTest {
 protected:
  Film() : ExplorerTest("flow") {}

  [[nodiscard]] std::vector<std::string> drawn(std::vector<std::string> more) const {
    std::vector<std::string> arguments{"render",     "--example", "abc",    "--seeds",
                                       "grid:2,2,2", "--size",    "161x121"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  /// Without the texts before them, which have the command.
  [[nodiscard]] std::string pixels(const std::string& name) const {
    std::ifstream file(folder_.path(name), std::ios::binary);
    std::stringstream all;
    all << file.rdbuf();
    const std::string bytes = all.str();
    return bytes.substr(std::min(bytes.find("IDAT"), bytes.size()));
  }
  void write_path() {
    std::string rows = "t,x,y,z,b0\n";
    for (int i = 0; i <= 200; ++i)
      rows += std::to_string(1e-3 * i) + "," + std::to_string(1.0 + 0.01 * i) + ",2,3,1\n";
    folder_.write("hand.csv", rows);
  }
};

TEST_F(Film, OfATurntableIsAPictureEachThirdOfATurn) {
  const Json object = json(drawn({"--turntable", "3", "--out", "turn.png"}));
  EXPECT_EQ(object["frames"], 3);
  EXPECT_EQ(object["out"], "turn-0001.png");
  EXPECT_FALSE(object.contains("image_error")) << "nobody has measured it";
  EXPECT_EQ(files(), (std::vector<std::string>{"turn-0001.png", "turn-0002.png", "turn-0003.png"}));
  for (const auto& [frame, camera] : {std::pair("1", "30,20,0,1"), std::pair("2", "150,20,0,1")}) {
    ASSERT_EQ(run(drawn({"--camera", camera, "--out", "alone.png", "--force"})).exit_code, 0);
    EXPECT_EQ(pixels(std::string("turn-000") + frame + ".png"), pixels("alone.png")) << frame;
  }
  EXPECT_NE(pixels("turn-0001.png"), pixels("turn-0002.png"));

  EXPECT_EQ(run(drawn({"--turntable", "3", "--out", "turn.png"})).exit_code, 2) << "they are there";
  EXPECT_EQ(run(drawn({"--turntable", "3", "--out", "turn.png", "--force"})).exit_code, 0);
}

TEST_F(Film, OfAPathShowsTheHandOnItsWay) {
  write_path();
  const std::vector<std::string> path{"--path", "hand.csv"};
  const auto with_path = [&](std::vector<std::string> more) {
    more.insert(more.end(), path.begin(), path.end());
    return drawn(std::move(more));
  };
  ASSERT_EQ(run(with_path({"--path-frames", "3", "--out", "way.png"})).exit_code, 0);
  ASSERT_EQ(run(with_path({"--out", "end.png"})).exit_code, 0);
  EXPECT_EQ(pixels("way-0003.png"), pixels("end.png"));
  EXPECT_NE(pixels("way-0002.png"), pixels("end.png"));
  EXPECT_NE(pixels("way-0001.png"), pixels("way-0002.png"));
}

TEST_F(Film, RefusesWhatCannotBeOne) {
  const auto refused = [&](std::vector<std::string> more, const std::string& with) {
    const ProgramResult result = run(drawn(std::move(more)));
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(with), std::string::npos) << result.err;
  };
  refused({"--path-frames", "3", "--out", "a.png"}, "--path FILE.csv");
  refused({"--out", "a.mp4"}, "--turntable N");
  refused({"--turntable", "3", "--out", "a.avi"}, ".webm");
  refused({"--turntable", "3", "--repeat", "2", "--out", "a.png"}, "--repeat");
  write_path();
  refused({"--path", "hand.csv", "--turntable", "3", "--path-frames", "4", "--out", "a.png"},
          "the same number");
  EXPECT_EQ(files(), std::vector<std::string>{"hand.csv"}) << "nothing was written";
}

// A program of that name in its place counts what it is given: four bytes a pixel, one picture after the other.
TEST_F(Film, IsEncodedByFfmpegOrSaysThatThereIsNone) {
  const char* const path = std::getenv("PATH");
  const std::string before = path != nullptr ? path : "";
  std::filesystem::create_directory(folder_.path("bin"));
  ::setenv("PATH", folder_.path("bin").c_str(), 1);
  const ProgramResult without = run(drawn({"--turntable", "3", "--out", "turn.mp4"}));
  EXPECT_EQ(without.exit_code, 1);
  EXPECT_NE(without.err.find("ffmpeg"), std::string::npos) << without.err;
  EXPECT_NE(without.err.find("turn.png"), std::string::npos) << "and what can be done: " << without.err;

  const auto install = [&](const std::string& script) {
    folder_.write("bin/ffmpeg", "#!/bin/sh\nPATH='" + before + "'\n" + script);
    std::filesystem::permissions(folder_.path("bin/ffmpeg"), std::filesystem::perms::owner_all);
  };
  install("for last; do :; done\necho \"$@\" > arguments\ncat > \"${last#file:}\"\n");
  const Json object = json(drawn({"--turntable", "3", "--frame-rate", "12.5", "--out", "turn.mp4"}));
  EXPECT_EQ(object["out"], "turn.mp4");
  EXPECT_EQ(object["frame_rate"], 12.5);
  EXPECT_EQ(std::filesystem::file_size(folder_.path("turn.mp4")), 3U * 4U * 161U * 121U);
  std::ifstream arguments(folder_.path("arguments"));
  std::string line;
  std::getline(arguments, line);
  for (const char* word : {"-s 161x121", "-r 12.5", "libx264", "-f mp4"})
    EXPECT_NE(line.find(word), std::string::npos) << line;

  install("echo 'unknown encoder' >&2\nexit 1\n");
  const ProgramResult failed = run(drawn({"--turntable", "3", "--out", "other.webm"}));
  ::setenv("PATH", before.c_str(), 1);
  EXPECT_EQ(failed.exit_code, 1);
  EXPECT_NE(failed.err.find("unknown encoder"), std::string::npos) << failed.err;
  EXPECT_FALSE(std::filesystem::exists(folder_.path("other.webm")));
  for (const std::string& name : files()) EXPECT_EQ(name.find(".part"), std::string::npos) << name;
}

}  // namespace
}  // namespace palpate::test
