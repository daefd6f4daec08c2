#include "common/haptics/coupling.h"

#include <cmath>

#include <gtest/gtest.h>

namespace palpate::test {
namespace {

TEST(StiffnessBound, IsTheLeastOfWhatIsKnown) {
  // b = 2 N s/m at 1 kHz: 4000 N/m; with 2 ms of delay 2 / 2.5 ms.
  WallLoop loop{.damping = 2.0, .period = 0.001};
  EXPECT_NEAR(stiffness_bound(loop, 0.0).stiffness, 4000.0, 1e-9);
  EXPECT_EQ(stiffness_bound(loop, 0.0).limit, StiffnessLimit::kHold);
  EXPECT_NEAR(stiffness_bound(loop, 0.5).stiffness, 3000.0, 1e-9) << "virtual damping costs stiffness";
  EXPECT_NEAR(stiffness_bound(loop, -0.5).stiffness, 3000.0, 1e-9);
  EXPECT_EQ(stiffness_bound(loop, 5.0).stiffness, 0.0) << "never negative";
  loop.delay = 0.002;
  EXPECT_NEAR(stiffness_bound(loop, 0.0).stiffness, 800.0, 1e-9);
  EXPECT_NEAR(stiffness_bound(loop, 0.5).stiffness, 1000.0, 1e-9) << "with delay it adds some";
  EXPECT_EQ(stiffness_bound(loop, 0.0).limit, StiffnessLimit::kDelay);
  loop.delay = 0.0;
  loop.encoder_step = 5e-5;
  loop.friction = 0.05;
  EXPECT_NEAR(stiffness_bound(loop, 0.0).stiffness, 2000.0, 1e-9);
  EXPECT_EQ(stiffness_bound(loop, 0.0).limit, StiffnessLimit::kEncoder);
  loop.device_stiffness = 1000.0;
  EXPECT_EQ(stiffness_bound(loop, 0.0).stiffness, 1000.0);
  EXPECT_EQ(stiffness_bound(loop, 0.0).limit, StiffnessLimit::kDevice);
  loop.friction = 0.0;
  EXPECT_EQ(stiffness_bound(loop, 0.0).stiffness, 0.0) << "a quantum that nothing ever takes away";
}

TEST(StiffnessBound, WarnsInOneLineThatNamesTheLimit) {
  WallLoop loop{.damping = 0.1, .friction = 0.2, .encoder_step = 2.54e-5, .period = 0.001};
  EXPECT_EQ(stiffness_warning(loop, 200.0, 0.0), "");
  EXPECT_EQ(stiffness_warning(loop, 400.0, 0.0),
            "a stiffness of 400 N/m is above 200 N/m, twice the free damping of 0.1 N s/m over the servo's "
            "period: an unheld arm may start to swing");
  loop.device_stiffness = 150.0;
  EXPECT_EQ(stiffness_warning(loop, 400.0, 0.0),
            "a stiffness of 400 N/m is above 150 N/m, the most that is stated for this device");
  loop.friction = 1e-4;
  EXPECT_NE(stiffness_warning(loop, 400.0, 0.0).find("over the encoder's step of 0.0254 mm"),
            std::string::npos);
  loop.delay = 0.01;
  EXPECT_NE(stiffness_warning(loop, 400.0, 0.0).find("above 7.87402 N/m"), std::string::npos);
  loop.friction = 1.0;
  EXPECT_NE(stiffness_warning(loop, 400.0, 0.0).find("what a delay of 10 ms leaves"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
