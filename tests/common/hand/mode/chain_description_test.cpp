#include "common/hand/mode/chain_description.h"

#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

const ChainSettings kOdd{.stiffness = 1000.0 / 3.0,
                         .streamline = {.release_distance = 0.1 + 0.2, .speed_force = -0.1},
                         .ticks = {.interval = 1.7976931348623157e308, .stiffness = 1.0 / 7.0},
                         .drag = {.threshold = 5e-324}};

class ChainDescription : public ::testing::Test {
 protected:
  /// A mode that only remembers what it is asked to build.
  std::vector<HapticMode> modes_{{"held", "", [this](const HapticScene& scene) {
                                    scale_ = scene.workspace.scale();
                                    settings_ = scene.settings;
                                    return HapticChain{};
                                  }}};
  NamedField open_{helix_flow(0.25), field_key("velocity of the wind", 3)};
  double scale_ = 0.0;
  ChainSettings settings_;

  [[nodiscard]] ExitCode code_of(const std::string& description) const {
    try {
      (void)build_chain(description, modes_, open_, 1);
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << "one line";
      return error.code();
    }
    return ExitCode::kDone;
  }
};

TEST_F(ChainDescription, ReadsBackToTheLastBit) {
  (void)build_chain(describe_chain("held", 0.1 / 3.0, kOdd, open_.name), modes_, open_, 1);
  EXPECT_EQ(scale_, 0.1 / 3.0);
  EXPECT_EQ(settings_, kOdd);
}

TEST_F(ChainDescription, BuildsTheChainOfItsMode) {
  const auto modes = sample_modes();
  const HapticChain held = build_chain(describe_chain("streamline", 0.05, {}, open_.name), modes, open_, 1);
  EXPECT_TRUE(held.chain);
  EXPECT_TRUE(held.followed);
  const HapticChain drag = build_chain(describe_chain("isotropic", 0.05, {}, open_.name), modes, open_, 1);
  EXPECT_TRUE(drag.chain);
  EXPECT_FALSE(drag.followed);
}

TEST_F(ChainDescription, RefusesAnotherField) {
  EXPECT_EQ(code_of(describe_chain("held", 0.1, {}, open_.name)), ExitCode::kDone);
  EXPECT_EQ(code_of(describe_chain("held", 0.1, {}, field_key("velocity of the wind", 4))),
            ExitCode::kBadInput);
  EXPECT_EQ(code_of(describe_chain("held", 0.1, {}, field_key("vorticity", 3))), ExitCode::kBadInput);
}

TEST_F(ChainDescription, RefusesWhatMakesNoSense) {
  const std::string good = describe_chain("held", 0.1, {}, open_.name);
  const std::string field = " field=" + open_.name;
  EXPECT_EQ(code_of(""), ExitCode::kBadInput);
  EXPECT_EQ(code_of(describe_chain("unheard-of", 0.1, {}, open_.name)), ExitCode::kBadInput);
  EXPECT_EQ(code_of("held"), ExitCode::kBadInput);
  EXPECT_EQ(code_of("held" + field), ExitCode::kBadInput) << "no numbers";
  EXPECT_EQ(code_of(good.substr(0, good.find(" field="))), ExitCode::kBadInput);
  for (const char* name : {"scale", "stiffness", "streamline.release", "drag.threshold", "ticks.stiffness"}) {
    const std::string key = std::string(" ") + name + "=";
    const std::size_t at = good.find(key) + key.size(), end = good.find(' ', at);
    for (const char* bad : {"", "x", "nan", "inf", "1e999", "1,5", "0x"}) {
      std::string broken = good;
      broken.replace(at, end - at, bad);
      EXPECT_EQ(code_of(broken), ExitCode::kBadInput) << broken;
    }
  }
  for (const double scale : {0.0, -1.0}) {
    EXPECT_EQ(code_of(describe_chain("held", scale, {}, open_.name)), ExitCode::kBadInput);
  }
  EXPECT_EQ(code_of(describe_chain("held", 0.1, {.stiffness = -1.0}, open_.name)), ExitCode::kBadInput);
}

}  // namespace
}  // namespace palpate::test
