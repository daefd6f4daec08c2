#include "common/app/cli/simulated_option.h"

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

std::string refusal(const std::string& device) {
  try {
    (void)simulated_option(device);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "accepted";
}

TEST(SimulatedOption, NamesDeviceAndHandInAnyOrder) {
  EXPECT_FALSE(simulated_option("mouse"));
  EXPECT_FALSE(simulated_option("simulatedx"));
  EXPECT_FALSE(simulated_option("replay:simulated"));
  const auto of = [](const char* text) { return title_of(simulated_option(text).value()); };
  EXPECT_EQ(of("simulated"), "PHANToM Premium 3.0 class in a relaxed hand");
  EXPECT_EQ(of("simulated:falcon"), "Novint Falcon class in a relaxed hand");
  EXPECT_EQ(of("simulated:falcon,hand=firm"), "Novint Falcon class in a firm hand");
  EXPECT_EQ(of("simulated:hand=firm,falcon"), "Novint Falcon class in a firm hand");
  EXPECT_EQ(of("simulated:hand=relaxed"), "PHANToM Premium 3.0 class in a relaxed hand");
}

TEST(SimulatedOption, RefusesWhatItDoesNotKnow) {
  EXPECT_NE(refusal("simulated:omega").find("known are premium3, falcon, ideal"), std::string::npos);
  EXPECT_NE(refusal("simulated:").find("known are"), std::string::npos);
  EXPECT_NE(refusal("simulated:falcon,hand=limp").find("known are relaxed, firm"), std::string::npos);
  EXPECT_EQ(refusal("simulated:falcon,premium3"),
            "--device simulated:falcon,premium3: one device and one hand at most");
  EXPECT_EQ(refusal("simulated:hand=firm,hand=firm"),
            "--device simulated:hand=firm,hand=firm: one device and one hand at most");
}

}  // namespace
}  // namespace palpate::test
