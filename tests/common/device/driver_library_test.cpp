// Driver modules opened by name: what crosses the border, and what is refused before anything does.

#include "common/device/driver_library.h"

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include <dlfcn.h>
#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

std::string refusal(const std::string& device) {
  try {
    (void)open_device(parse_device(device));
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

std::string contents(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::string mapped() { return contents("/proc/self/maps"); }

class DriverLibrary : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { ::setenv("PALPATE_HELPERS", (build_folder() / "lib/palpate").c_str(), 1); }
  static void TearDownTestSuite() { ::unsetenv("PALPATE_HELPERS"); }
};

TEST_F(DriverLibrary, ReadsDevicesOfTheCommandLine) {
  const DeviceText text = parse_device("falcon:firmware=/a/b.bin,gain=3500");
  EXPECT_EQ(text.name, "falcon");
  EXPECT_EQ(text.options, (DriverOptions{{"firmware", "/a/b.bin"}, {"gain", "3500"}}));
  EXPECT_TRUE(parse_device("falcon").options.empty());
  EXPECT_THROW((void)parse_device("falcon:gain"), Error);
  EXPECT_EQ(parse_device("vrpn:Tracker0@lab:4000,sensor=1").options,
            (DriverOptions{{"at", "Tracker0@lab:4000"}, {"sensor", "1"}}));
  EXPECT_THROW((void)parse_device("falcon:=3"), Error);
}

TEST_F(DriverLibrary, ReadsTheDeadManSwitch) {
  EXPECT_FALSE(parse_device("falcon:gain=1").button.has_value());
  EXPECT_EQ(parse_device("falcon:button=31").button, 31);
  EXPECT_EQ(parse_device("falcon:button=none").button, DeviceLimits::kNoButton);
  const DeviceText text = parse_device("falcon:enable=pedal,gain=3500,button=2");
  EXPECT_EQ(text.enable, "pedal");
  EXPECT_EQ(text.button, 2);
  EXPECT_EQ(text.options, (DriverOptions{{"gain", "3500"}})) << "the driver need not know";
  for (const char* wrong :
       {"button=", "button=-1", "button=32", "button=1x", "enable=", "enable=pedal,button=none"}) {
    EXPECT_THROW((void)parse_device("falcon:" + std::string(wrong)), Error) << wrong;
  }
}

TEST_F(DriverLibrary, NamesWhatThereIs) {
  for (const char* name : {"nothing", "../../bin/flow", "", "falcon/../falcon", "Falcon"}) {
    EXPECT_NE(refusal(name).find("known are mouse"), std::string::npos) << name;
  }
}

TEST_F(DriverLibrary, OpensAModuleThatIsAskedForAndWorksItsLink) {
  EXPECT_EQ(mapped().find("palpate_driver"), std::string::npos);
  const std::unique_ptr<DriverLink> link = open_device(parse_device("falcon_emulated:gain=3500")).link;
  ASSERT_TRUE(link);
  EXPECT_NE(mapped().find("palpate_driver_falcon_emulated.so"), std::string::npos);
  const auto start = std::chrono::steady_clock::now();
  constexpr std::chrono::seconds kLimit{20};
  while (link->status().phase != LinkPhase::kReady && std::chrono::steady_clock::now() - start < kLimit) {
    (void)round_with(*link, Vec3{0.0});
  }
  EXPECT_EQ(link->status().phase, LinkPhase::kReady) << link->advice();
  EXPECT_EQ(link->place(), "usb 1-2");
  EXPECT_EQ(&open_driver("falcon_emulated"), &open_driver("falcon_emulated"));
  std::string error;
  const auto found = open_driver("falcon_emulated").find(error);
  ASSERT_EQ(found.size(), 1U) << error;
  EXPECT_EQ(found[0].name, "Novint Falcon");
  EXPECT_EQ(found[0].driver, "falcon");
}

TEST_F(DriverLibrary, OpensTheSwitchWithTheDevice) {
  const auto opened = [](const char* text) { return open_device(parse_device(text)).enabling; };
  EXPECT_EQ(opened("falcon_emulated").button, 2) << "the driver's own";
  EXPECT_EQ(opened("falcon_emulated").sample_button(), 2);
  EXPECT_EQ(opened("falcon_emulated:button=1").sample_button(), 1);
  EXPECT_EQ(opened("falcon_emulated:button=none").sample_button(), DeviceLimits::kNoButton);
  const DeviceText other = parse_device("falcon_emulated:enable=falcon_emulated,button=3");
  const OpenedDevice both = open_device(other);
  ASSERT_TRUE(both.enabling.link);
  EXPECT_EQ(both.enabling.button, 3);
  EXPECT_EQ(both.enabling.sample_button(), EnablingSwitch::kOtherBit);
  EXPECT_EQ(description_of(both.enabling, other), "while button 3 of falcon_emulated is held");
  EXPECT_NE(refusal("falcon_emulated:enable=nothing").find("known are mouse"), std::string::npos);
}

TEST_F(DriverLibrary, SaysWhatADriverRefuses) {
  EXPECT_NE(refusal("falcon_emulated:gain=much").find("takes a number"), std::string::npos);
  EXPECT_NE(refusal("falcon_emulated:gains=1").find("known are firmware"), std::string::npos);
}

TEST_F(DriverLibrary, ShowsNothingButItsEntry) {
  (void)open_driver("falcon_emulated");
  // Names of a module reach nobody else.
  EXPECT_EQ(::dlsym(RTLD_DEFAULT, kDriverEntry), nullptr);
}

TEST_F(DriverLibrary, RefusesAModuleOfAnotherBuildAndOneThatIsNone) {
  const TempFolder folder;
  folder.write("palpate_driver_text.so", "this is no library");
  ::setenv("PALPATE_HELPERS", folder.path().c_str(), 1);
  EXPECT_NE(refusal("text").find("driver 'text'"), std::string::npos);
  // A module with its build changed by a byte, of the same length.
  std::string bytes = contents(build_folder() / "lib/palpate/palpate_driver_falcon_emulated.so");
  const auto at = bytes.find(driver_build());
  ASSERT_NE(at, std::string::npos);
  bytes[at] = '9';
  folder.write("palpate_driver_other.so", bytes);
  EXPECT_NE(refusal("other").find("is of another build"), std::string::npos) << refusal("other");
  ::setenv("PALPATE_HELPERS", (build_folder() / "lib/palpate").c_str(), 1);
}

}  // namespace
}  // namespace palpate::test
