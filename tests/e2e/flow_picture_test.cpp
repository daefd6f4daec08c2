// What the built `flow` draws: pictures, colours, volumes, sessions.

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

class FlowPicture : public ExplorerTest {
 protected:
  FlowPicture() : ExplorerTest("flow") {}
};

TEST_F(FlowPicture, TakesOptionsFromASessionUnlessTheyAreTyped) {
  folder_.write("s.toml",
                "format = 1\nprogram = \"flow\"\n[scene]\nexample = \"abc\"\nseeds = \"grid:2,2,2\"\n"
                "integrator = \"rk34\"\ncamera = \"0,90,0,1\"\n");
  const Json read = json({"trace", "--session", "s.toml", "--out", "a.vtp"});
  EXPECT_EQ(read["seeds"], 8);
  EXPECT_EQ(read["integrator"], "rk34");
  const Json typed = json({"trace", "--session", "s.toml", "--integrator", "dp54", "--out", "b.vtp"});
  EXPECT_EQ(typed["integrator"], "dp54");
  EXPECT_EQ(run({"trace", "--session", "missing.toml", "--out", "c.vtp"}).exit_code, 3);
}

// What a hand has made is saved beside the session, moves with it, and is drawn without a display, too.
TEST_F(FlowPicture, DrawsTheLinesThatASessionHasKept) {
  const std::string header = "line,seed,point,x,y,z,time,arc,speed,error,termination,force\n";
  const std::string lines = header +
                            "0,1,0,-3,0,0,0,0,1,0,loop,nan\n0,1,1,3,0,0,1,6,1,0,loop,0.5\n"
                            "1,4,0,0,-3,0,0,0,1,0,loop,1\n1,4,1,0,3,0,1,6,1,0,loop,1\n";
  const std::string session =
      "format = 1\nprogram = \"flow\"\n[lines]\nfile = \"made/s.lines.csv\"\n[scene]\nexample = \"abc\"\n"
      "seeds = \"grid:2,2,2\"\n";
  folder_.write("here/made/s.lines.csv", lines);
  folder_.write("here/s.toml", session);
  std::filesystem::rename(folder_.path("here"), folder_.path("there"));
  const auto render = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",  "--session", "there/s.toml", "--size",
                                       "160x120", "--out",     "p.png",        "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  };
  // The pixels, without the texts before them, which have the command.
  const auto pixels = [&] {
    const std::string file = read_file(folder_.path("p.png"));
    return file.substr(std::min(file.find("IDAT"), file.size()));
  };
  const ProgramResult drawn = render({});
  EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
  EXPECT_NE(drawn.out.find("2 lines drawn by hand"), std::string::npos) << drawn.out;
  const std::string with = pixels();
  EXPECT_EQ(render({"--drawn-lines", ""}).out.find("drawn by hand"), std::string::npos);
  EXPECT_NE(pixels(), with);
  EXPECT_NE(render({"--drawn-lines", "there/made/s.lines.csv"}).out.find("2 lines"), std::string::npos);
  EXPECT_EQ(pixels(), with);

  folder_.write("there/made/s.lines.csv", lines.substr(0, lines.size() - 20));
  const ProgramResult damaged = render({});
  EXPECT_EQ(damaged.exit_code, 3);
  EXPECT_NE(damaged.err.find("s.lines.csv: line 5"), std::string::npos) << damaged.err;
  std::filesystem::remove(folder_.path("there/made/s.lines.csv"));
  const ProgramResult missing = render({});
  EXPECT_EQ(missing.exit_code, 3);
  EXPECT_NE(missing.err.find("s.lines.csv"), std::string::npos) << missing.err;
  EXPECT_EQ(render({"--drawn-lines", ""}).exit_code, 0) << "and without them";
}

TEST_F(FlowPicture, DrawsAPictureThatSaysHowItWasMade) {
  const Json object = json({"render", "--example", "abc", "--seeds", "grid:3,3,3", "--size", "160x120",
                            "--repeat", "2", "--out", "p.png"});
  EXPECT_EQ(object["frames_timed"], 2);
  for (const char* key : {"frame_ms", "seconds_load", "image_error"})
    EXPECT_TRUE(object[key].is_number()) << key;
  const std::string png = read_file(folder_.path("p.png"));
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_NE(png.find("flow render --example abc"), std::string::npos);
}

TEST_F(FlowPicture, ColoursLinesByMeasuresAndArrays) {
  const auto picture = [&](const std::vector<std::string>& input, const std::string& color) {
    std::vector<std::string> arguments{"render"};
    arguments.insert(arguments.end(), input.begin(), input.end());
    arguments.insert(arguments.end(), {"--seeds", "grid:3,3,3", "--size", "120x90", "--color", color, "--out",
                                       "p.png", "--force"});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 0) << color << ": " << result.err;
    const std::string png = read_file(folder_.path("p.png"));
    return png.substr(png.find("IDAT"));  // without the text, which names the colour
  };
  EXPECT_NE(picture({"--example", "abc"}, "speed"), picture({"--example", "abc"}, "vorticity"));
  EXPECT_NE(picture({"--example", "abc", "--line-opacity", "0.3"}, "speed"),
            picture({"--example", "abc", "--line-width", "9"}, "speed"));
  const auto disk = shared_data("flow/disk/disk_out_ref.ex2");
  if (disk.empty()) GTEST_SKIP() << "sample data missing: flow/disk/disk_out_ref.ex2";
  EXPECT_NE(picture({disk.string()}, "speed"), picture({disk.string()}, "Temp"));
  const ProgramResult unknown = run({"render", disk.string(), "--color", "smell", "--out", "q.png"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_NE(unknown.err.find("Temp"), std::string::npos) << unknown.err;
}

TEST_F(FlowPicture, DrawsAScalarAsAVolumeAndSaysWhatResamplingCosts) {
  const auto drawn = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",     "--example", "abc",   "--seeds",
                                       "grid:2,2,2", "--size",    "64x48", "--force"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  const Json coarse = json(drawn({"--volume", "speed", "--resample", "12", "--out", "coarse.png"}));
  const Json fine = json(drawn({"--volume", "speed,q", "--resample", "23", "--lens",
                                "sphere:3,3,3,1,field=q,tf=density", "--out", "fine.png"}));
  ASSERT_EQ(coarse["resampled"].size(), 1U);
  ASSERT_EQ(fine["resampled"].size(), 2U);
  EXPECT_EQ(coarse["resampled"][0]["points"], Json({12, 12, 12}));
  EXPECT_EQ(coarse["resampled"][0]["outside"], 0.0);
  // Twice as fine a lattice: a quarter of the error, where the speed is smooth.
  const double from = coarse["resampled"][0]["error_rms"], to = fine["resampled"][0]["error_rms"];
  EXPECT_GT(from, 1e-3);
  EXPECT_NEAR(from / to, 4.0, 0.8);
  EXPECT_NE(read_file(folder_.path("coarse.png")), read_file(folder_.path("fine.png")));

  const std::vector<std::pair<std::vector<std::string>, std::string>> refused{
      {{"--volume", "speed"}, "--resample 128"},
      {{"--volume", "nothing", "--resample", "8"}, "vorticity"},
      {{"--volume", "speed", "--resample", "1"}, "from 2 to 1024"},
      {{"--volume", "speed", "--resample", "1024"}, "2^27 points"},
      {{"--lens", "sphere:3,3,3,1"}, "--volume speed"}};
  for (const auto& [more, word] : refused) {
    std::vector<std::string> arguments = drawn(more);
    arguments.insert(arguments.end(), {"--out", "refused.png"});
    const ProgramResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 2) << result.err;
    EXPECT_NE(result.err.find(word), std::string::npos) << result.err;
  }
  EXPECT_EQ(files(), (std::vector<std::string>{"coarse.png", "fine.png"}));
}

TEST_F(FlowPicture, DrawsArraysOfRealDataAsVolumesFromTheirVoxelsOrResampled) {
  PALPATE_NEED_DATA(carotid, "flow/carotid/carotid.vtk");
  PALPATE_NEED_DATA(grid, "flow/bluntfin/bluntfinxyz.bin");
  PALPATE_NEED_DATA(solution, "flow/bluntfin/bluntfinq.bin");
  const Json image = json({"render", carotid.string(), "--volume", "scalars", "--seeds", "speed:5", "--size",
                           "64x48", "--explain", "--out", "image.png"});
  EXPECT_EQ(image["voxels"], 76 * 49 * 45);
  EXPECT_FALSE(image.contains("resampled")) << "its own voxels";
  EXPECT_NE(image["explain"].dump().find("scalars as a volume"), std::string::npos);
  const Json fin = json({"render", grid.string(), "--solution", solution.string(), "--volume", "Density",
                         "--resample", "48", "--seeds", "grid:2,2,2", "--size", "64x48", "--out", "fin.png"});
  const Json& cost = fin["resampled"][0];
  EXPECT_NEAR(cost["outside"], 0.12, 0.02) << "the corners of its box";
  EXPECT_GT(cost["error_rms"], 1e-3);
  EXPECT_LT(cost["error_rms"], 0.02);
  EXPECT_GT(cost["error_worst"], cost["error_rms"]);
  EXPECT_LT(cost["error_worst"], 0.6);
}

TEST_F(FlowPicture, MakesATourWhereThereIsNoDisplay) {
  const ProgramResult result = run({});
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(files(), std::vector<std::string>{"flow-tour.png"});
  EXPECT_NE((result.out + result.err).find("flow-tour.png"), std::string::npos);
  // A file, though, is not silently turned into a picture.
  const ProgramResult open = run({"--example", "abc"});
  EXPECT_EQ(open.exit_code, 1);
  EXPECT_NE(open.err.find("render"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
