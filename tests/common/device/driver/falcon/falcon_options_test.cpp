// Words of `--device falcon:…`, and what they refuse.

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/falcon/falcon_link.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::string refusal(const DriverOptions& options) {
  try {
    (void)falcon_settings(options);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(FalconOptions, SetGainGeometryAndFirmware) {
  const TempFolder folder;
  const std::string image(2000, 'x');
  const FalconSettings settings = falcon_settings({{"gain", "10000"},
                                                   {"thigh", "0.0602"},
                                                   {"cap", "3"},
                                                   {"firmware", folder.write("image.bin", image).string()}});
  EXPECT_EQ(settings.gain, 10000.0);
  EXPECT_EQ(settings.geometry.thigh, 0.0602);
  EXPECT_EQ(settings.force_cap, 3.0);
  EXPECT_EQ(settings.firmware.size(), 2000U);
  EXPECT_EQ(falcon_settings({}).gain, 3500.0);
}

TEST(FalconOptions, RefuseWhatMakesNoSense) {
  const TempFolder folder;
  EXPECT_NE(refusal({{"gains", "1"}}).find("known are firmware, gain, cap"), std::string::npos);
  EXPECT_NE(refusal({{"gain", "many"}}).find("takes a number"), std::string::npos);
  EXPECT_NE(refusal({{"gain", "nan"}}).find("out of bounds"), std::string::npos);
  EXPECT_NE(refusal({{"thigh", "-1"}}).find("out of bounds"), std::string::npos);
  EXPECT_NE(refusal({{"firmware", "nowhere.bin"}}).find("cannot be read"), std::string::npos);
  EXPECT_NE(refusal({{"firmware", folder.write("a", "short").string()}}).find("5 bytes"), std::string::npos);
  EXPECT_NE(
      refusal({{"firmware", folder.write("b", std::string(100'000, 'x')).string()}}).find("more than 65536"),
      std::string::npos);
}

}  // namespace
}  // namespace palpate::test
