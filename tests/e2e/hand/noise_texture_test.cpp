// Noise felt as a texture, through the command line: what is clean is smooth, what is noisy is rough.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "tests/e2e/explorer_test.h"
#include "tests/e2e/hand/probe_log.h"

namespace palpate::test {
namespace {

class NoiseTexture : public ExplorerTest {
 protected:
  NoiseTexture() : ExplorerTest("grid") {
    // Onto the surface between object and background from outside, and round it a little deeper.
    std::ofstream path(folder_.path("hand.csv"));
    path << "t,x,y,z\n";
    for (int i = 0; i < 3000; ++i) {
      const double angle = i < 500 ? 0.0 : 4e-4 * (i - 500), radius = std::max(0.35, 0.9 - 0.002 * i);
      path << 0.001 * i << ',' << -radius * std::cos(angle) << ',' << -radius * std::sin(angle) << ",0\n";
    }
  }

  ProbeLogText feel(const std::string& example, const std::string& texture) {
    const ProgramResult result = run({"probe", "--example", example, "--path", "hand.csv", "--mode",
                                      "density", "--noise-texture", texture, "--out", "log.csv", "--force"});
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return read_probe_log(folder_.path("log.csv"));
  }
  static double strongest(const ProbeLogText& log) {
    double most = 0.0;
    for (const LogRow& row : log.rows) most = std::max(most, glm::length(row.force));
    return most;
  }
  /// Lines end in a comma.
  static double last_column(const std::string& line) {
    return std::stod(line.substr(line.rfind(',', line.size() - 2) + 1));
  }
};

// The noise of the blob is uniform over a tenth of full scale, of which its values take up 0.65.
TEST_F(NoiseTexture, ANoisyVolumeIsRoughAndSaysHowNoisyItIs) {
  const ProbeLogText smooth = feel("blob", "off"), rough = feel("blob", "on");
  EXPECT_EQ(smooth.header.find("noise"), std::string::npos);
  ASSERT_EQ(rough.header.substr(rough.header.rfind(',') + 1), "noise");
  double sum = 0.0;
  for (const std::string& line : rough.lines) sum += last_column(line);
  EXPECT_NEAR(sum / static_cast<double>(rough.lines.size()), 0.1 / std::sqrt(12.0) / 0.65, 0.008);
  // 2 mm of grain at 200 N/m, on top of the drag.
  EXPECT_NEAR(strongest(rough) - strongest(smooth), 0.4, 0.1);
  const ProbeLogText fine = feel("blob", "0:0,0.1:1");
  EXPECT_LT(strongest(fine), strongest(rough) - 0.2);
}

// What is left of the 8 bits of the shells is less than what is felt by default.
TEST_F(NoiseTexture, ACleanVolumeFeelsAsWithout) {
  const ProbeLogText smooth = feel("shells", "off"), rough = feel("shells", "on");
  ASSERT_EQ(smooth.rows.size(), rough.rows.size());
  for (std::size_t i = 0; i < rough.rows.size(); ++i) {
    ASSERT_EQ(rough.rows[i].force, smooth.rows[i].force) << i;
    ASSERT_LT(last_column(rough.lines[i]), 1.5 / (255.0 * std::sqrt(12.0))) << "a step of 1/255 at most";
  }
}

TEST_F(NoiseTexture, IsRefusedWhereItIsNone) {
  for (const char* words : {"1:2,x", "0.1:-1", "maybe", "0.1:2000"}) {
    const ProgramResult result = run({"probe", "--example", "blob", "--path", "hand.csv", "--mode", "density",
                                      "--noise-texture", words, "--json"});
    EXPECT_EQ(result.exit_code, 2) << words;
    EXPECT_NE(result.err.find("--noise-texture"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace palpate::test
