// Tracked hands as a table: what is there comes back, what is not is none, and nonsense is refused by its
// line.

#include "common/device/tracked_hands.h"

#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

class TrackedHandsTest : public testing::Test {
 protected:
  std::vector<TrackedHands> read(const std::string& text) {
    return read_hands(folder_.write("hands.csv", text).string());
  }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return error.what();
    }
    return "accepted";
  }
  TempFolder folder_;
};

TEST_F(TrackedHandsTest, ReadsBothHandsAndTheirButtons) {
  const auto hands = read(
      "t,x,y,z,qw,qx,qy,qz,b0,b1,hx,hy,hz,hqw,hqx,hqy,hqz,h0\n"
      "0,0.1,0.2,0.3,1,0,0,0,1,0,0.4,0.5,0.6,0,1,0,0,1\n"
      "0.01,nan,nan,nan,nan,nan,nan,nan,0,1,nan,nan,nan,nan,nan,nan,nan,0\n");
  ASSERT_EQ(hands.size(), 2U);
  ASSERT_TRUE(hands[0].stylus && hands[0].other);
  EXPECT_EQ(hands[0].stylus->position, Vec3(0.1, 0.2, 0.3));
  EXPECT_EQ(hands[0].other->position, Vec3(0.4, 0.5, 0.6));
  EXPECT_EQ(hands[0].other->orientation, Quat(0.0, 1.0, 0.0, 0.0));
  EXPECT_TRUE(hands[0].acts && !hands[0].clutch && hands[0].carries);
  EXPECT_TRUE(!hands[1].stylus && !hands[1].other) << "out of sight";
  EXPECT_TRUE(!hands[1].acts && hands[1].clutch && !hands[1].carries);
  // One hand alone.
  const auto alone = read("t,x,y,z,qw,qx,qy,qz\n0,1,2,3,0.6,0,0.8,0\n");
  ASSERT_EQ(alone.size(), 1U);
  EXPECT_TRUE(alone[0].stylus && !alone[0].other && !alone[0].carries);
}

TEST_F(TrackedHandsTest, NamesTheLineOfWhatIsWrong) {
  const std::string header = "t,x,y,z,qw,qx,qy,qz\n";
  EXPECT_NE(refusal("t,x,y,z\n0,0,0,0\n").find("qw"), std::string::npos) << "a path is no table of hands";
  const std::string length = refusal(header + "0,0,0,0,1,0,0,0\n1,0,0,0,1,1,0,0\n");
  EXPECT_NE(length.find("line 3"), std::string::npos) << length;
  EXPECT_NE(length.find("quaternion"), std::string::npos) << length;
  EXPECT_NE(refusal(header + "0,inf,0,0,1,0,0,0\n").find("line 2"), std::string::npos);
  EXPECT_NE(refusal(header + "1,0,0,0,1,0,0,0\n1,0,0,0,1,0,0,0\n").find("line 3"), std::string::npos);
}

TEST_F(TrackedHandsTest, ReplaysAtItsOwnPace) {
  ReplayHands replay(read("t,x,y,z,qw,qx,qy,qz\n5,1,0,0,1,0,0,0\n5.1,2,0,0,1,0,0,0\n5.2,3,0,0,1,0,0,0\n"));
  TrackedHands hands;
  const auto x_at = [&](double now) { return replay.read(now, hands) ? hands.stylus->position.x : -1.0; };
  EXPECT_EQ(x_at(100.0), 1.0);
  EXPECT_EQ(x_at(100.05), 1.0);
  EXPECT_EQ(x_at(100.15), 2.0);
  EXPECT_EQ(x_at(100.25), 3.0);
  EXPECT_EQ(x_at(100.4), -1.0) << "gone";
}

}  // namespace
}  // namespace palpate::test
