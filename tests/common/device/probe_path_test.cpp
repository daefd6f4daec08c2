#include "common/device/probe_path.h"

#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

class ProbePathTest : public testing::Test {
 protected:
  std::vector<PathRow> read(const std::string& text) {
    return read_probe_path(folder_.write("p.csv", text).string());
  }
  std::string refusal(const std::string& text) {
    try {
      (void)read(text);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      const std::string line = error.what();
      return line.substr(line.find("p.csv: ") + 7);
    }
    return "accepted";
  }
  TempFolder folder_;
};

TEST_F(ProbePathTest, ReadsRowsWithAndWithoutAButton) {
  const auto path = read("t,x,y,z\r\n0,1,2,3\r\n0.001, 1e-3 ,-2,+3\r\n\r\n");
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].position, Vec3(1, 2, 3));
  EXPECT_EQ(path[1].time, 0.001);
  EXPECT_EQ(path[1].position, Vec3(1e-3, -2, 3));
  EXPECT_EQ(path[1].buttons, 0U);
  const auto pressed = read("# a path\nt,x,y,z,b0\n0,0,0,0,1\n1,0,0,0,0\n2,0,0,0,nan\n");
  ASSERT_EQ(pressed.size(), 3U);
  EXPECT_EQ(pressed[0].buttons, 1U);
  EXPECT_EQ(pressed[1].buttons, 0U);
  EXPECT_EQ(pressed[2].buttons, 0U);
}

TEST_F(ProbePathTest, KeepsRowsThatMakeNoSenseAsRows) {
  const auto path = read("t,x,y,z\n0,nan,2,3\n-1,1,inf,3\nnan,1,2,-inf\n");
  ASSERT_EQ(path.size(), 3U);
  EXPECT_TRUE(std::isnan(path[0].position.x));
  EXPECT_EQ(path[1].time, -1.0);
  EXPECT_EQ(path[1].position.y, HUGE_VAL);
  EXPECT_TRUE(std::isnan(path[2].time));
}

TEST_F(ProbePathTest, NamesTheLineOfAnythingElse) {
  const std::string header = "a probe path with the header t,x,y,z or t,x,y,z,b0";
  EXPECT_EQ(refusal(""), "is empty; expected " + header);
  EXPECT_EQ(refusal("0,1,2,3\n"), "line 1: has no column t; expected " + header);
  EXPECT_EQ(refusal("t,x,y,z\n0,1,2,3\n0,1,2\n"),
            "line 3: has 3 fields; expected 4 as in the header t,x,y,z");
  EXPECT_EQ(refusal("t,x,y,z\n0,1,2,up\n"), "line 2: no number in column z; expected a number");
  EXPECT_TRUE(read("t,x,y,z\n").empty());
}

}  // namespace
}  // namespace palpate::test
