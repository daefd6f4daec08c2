#include "common/field/transfer/color_transfer.h"

#include <cmath>
#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

ColorTransfer ramp_and_step() {
  return ColorTransfer({{1.0, {0.0F, 0.0F, 0.0F}, 0.0},
                        {3.0, {1.0F, 0.5F, 0.0F}, 0.5},
                        {3.0, {0.0F, 0.0F, 1.0F}, 0.25},
                        {5.0, {0.0F, 0.0F, 1.0F}, 1.0}});
}

TEST(ColorTransfer, IsLinearBetweenPointsAndConstantBeyondThem) {
  const ColorTransfer transfer = ramp_and_step();
  EXPECT_EQ(transfer.at(-10.0).opacity, 0.0);
  EXPECT_EQ(transfer.at(2.0).opacity, 0.25);
  EXPECT_EQ(transfer.at(2.0).color, Vec3f(0.5F, 0.25F, 0.0F));
  EXPECT_EQ(transfer.at(4.0).opacity, 0.625);
  EXPECT_EQ(transfer.at(99.0).opacity, 1.0);
}

TEST(ColorTransfer, TakesTheLaterPointFromAStepOn) {
  const ColorTransfer transfer = ramp_and_step();
  EXPECT_EQ(transfer.at(3.0).opacity, 0.25);
  EXPECT_NEAR(transfer.at(std::nextafter(3.0, 0.0)).opacity, 0.5, 1e-12);
}

TEST(ColorTransfer, NanAndAFunctionWithoutPointsShowNothing) {
  EXPECT_EQ(ramp_and_step().at(kNan).opacity, 0.0);
  EXPECT_EQ(ColorTransfer().at(1.0).opacity, 0.0);
}

TEST(ColorTransfer, RefusesWhatIsNoColourOpacityOrOrder) {
  const ColorPoint fine{0.0, Vec3f(0.5F), 0.5};
  EXPECT_THROW(ColorTransfer({{kNan, Vec3f(0.0F), 0.0}}), Error);
  EXPECT_THROW(ColorTransfer({{kInfinity, Vec3f(0.0F), 0.0}}), Error);
  EXPECT_THROW(ColorTransfer({fine, {1.0, Vec3f(0.0F, 1.5F, 0.0F), 0.0}}), Error);
  EXPECT_THROW(ColorTransfer({fine, {1.0, Vec3f(0.0F), kNan}}), Error);
  EXPECT_THROW(ColorTransfer({fine, {-1.0, Vec3f(0.0F), 0.0}}), Error);
}

// Values whose difference overflows.
TEST(ColorTransfer, ReachesOverTheWholeRangeOfDoubles) {
  const double most = std::numeric_limits<double>::max();
  const ColorTransfer transfer({{-most, Vec3f(0.0F), 0.0}, {most, Vec3f(1.0F), 1.0}});
  EXPECT_DOUBLE_EQ(transfer.at(0.0).opacity, 0.5);
  EXPECT_DOUBLE_EQ(transfer.table(-most, most, 3)[1].opacity, 0.5);
}

TEST(OpticalDepth, GivesTheCorrectedOpacityOfAnyLength) {
  // Ikits 2006, eq. 2.1 with d = 3 d_0.
  EXPECT_NEAR(1.0 - std::exp(-3.0 * optical_depth(0.2)), 1.0 - std::pow(0.8, 3.0), 1e-15);
  EXPECT_EQ(optical_depth(0.0), 0.0);
  EXPECT_TRUE(std::isfinite(optical_depth(1.0)));
}

TEST(ColorPreset, SpreadsOverTheDataButNotHounsfieldUnits) {
  for (const ColorPreset preset : {ColorPreset::kDensity, ColorPreset::kMr}) {
    const ColorTransfer transfer = make_color_transfer(preset, -4.0, 12.0);
    EXPECT_EQ(transfer.points().front().value, -4.0);
    EXPECT_EQ(transfer.points().back().value, 12.0);
    EXPECT_EQ(transfer.at(-4.0).opacity, 0.0);
    EXPECT_GT(transfer.at(12.0).opacity, 0.3);
  }
  EXPECT_EQ(make_color_transfer(ColorPreset::kCt, 0.0, 1.0),
            make_color_transfer(ColorPreset::kCt, -5.0, 9.0));
}

TEST(ColorPreset, OfConstantDataIsAValidFunction) {
  EXPECT_GT(make_color_transfer(ColorPreset::kDensity, 7.0, 7.0).at(7.0).opacity, 0.0);
}

class ColorTransferFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    const std::string path = (folder_.path() / "function.csv").string();
    std::ofstream(path) << text;
    return path;
  }
  // The message of reading `text`, or "no error".
  std::string refusal(const std::string& text) {
    try {
      (void)read_color_transfer(write(text), 0.0, 1.0);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "no error";
  }

  test::TempFolder folder_;
};

TEST_F(ColorTransferFile, GivesBackWhatWasWritten) {
  const ColorTransfer transfer({{-0.1, {0.1F, 0.2F, 0.3F}, 1.0 / 3.0}, {1e-30, {1.0F, 0.0F, 0.7F}, 0.9}});
  EXPECT_EQ(read_color_transfer(write(color_transfer_text(transfer)), 0.0, 1.0), transfer);
}

TEST_F(ColorTransferFile, SpreadsFractionsOverTheData) {
  const std::string text = "# mine\nfraction,red,green,blue,opacity\n\n0,0,0,0,0\n1,1,1,1,0.5\n";
  const ColorTransfer transfer = read_color_transfer(write(text), 100.0, 300.0);
  EXPECT_EQ(transfer.points().front().value, 100.0);
  EXPECT_EQ(transfer.at(200.0).opacity, 0.25);
}

TEST_F(ColorTransferFile, NamesTheLineThatIsWrong) {
  const std::string head = "value,red,green,blue,opacity\n0,0,0,0,0\n";
  for (const char* row : {"nan,0,0,0,0", "inf,0,0,0,0", "1,0,nan,0,0", "1,0,0,0,1.5", "1,0,0,0,-0.1",
                          "-1,0,0,0,0", "1,0,0,0", "1,red,0,0,0"}) {
    const std::string message = refusal(head + row + "\n");
    EXPECT_NE(message.find("line 3"), std::string::npos) << row << ": " << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
}

TEST_F(ColorTransferFile, RefusesTablesOfSomethingElse) {
  EXPECT_NE(refusal("x,y,z\n1,2,3\n").find("no column red"), std::string::npos);
  EXPECT_NE(refusal("").find("empty"), std::string::npos);
  EXPECT_NE(refusal("value,red,green,blue,opacity\n").find("no point"), std::string::npos);
  EXPECT_NE(refusal("red,green,blue,opacity\n0,0,0,0\n").find("value or fraction"), std::string::npos);
}

}  // namespace
}  // namespace palpate
