#include "common/render/gl/frame_timer.h"

#include <cmath>
#include <cstddef>

#include <epoxy/gl.h>
#include <gtest/gtest.h>

#include "common/render/gl/context.h"

namespace palpate {
namespace {

// Frames of these times by a driver that tells `share` of the GPU's.
double last_of(TimerCheck& check, double share, std::size_t frames, double clock = 20.0) {
  double last = 0.0;
  for (std::size_t i = 0; i < frames; ++i) last = check.add(share * clock, clock);
  return last;
}

TEST(TimerCheck, BelievesQueriesThatHoldAgainstTheClock) {
  TimerCheck check;
  EXPECT_FALSE(check.holds()) << "nothing is known";
  EXPECT_EQ(last_of(check, 0.95, TimerCheck::kFrames), 0.95 * 20.0);
  EXPECT_TRUE(check.holds());
  // Another program had the processor: what the GPU did is what it was.
  EXPECT_EQ(check.add(18.0, 90.0), 18.0);
  EXPECT_EQ(check.add(0.0, 20.0), 20.0) << "no time";
  EXPECT_EQ(check.add(30.0, 20.0), 20.0) << "more than there was";
  EXPECT_TRUE(check.holds());
}

TEST(TimerCheck, GoesByTheClockWhereADriverLies) {
  for (const double share : {0.0, 0.04, 0.8, 1.3, 25.0, std::nan("")}) {
    TimerCheck check;
    EXPECT_EQ(last_of(check, share, 3 * TimerCheck::kFrames), 20.0) << share;
    EXPECT_FALSE(check.holds()) << share;
    (void)last_of(check, 0.95, TimerCheck::kFrames);
    EXPECT_TRUE(check.holds()) << "it came to its senses";
    (void)last_of(check, share, TimerCheck::kFrames);
    EXPECT_FALSE(check.holds()) << share;
  }
}

TEST(FrameTimer, TellsNoMoreThanTheClock) {
  const OffscreenContext context;
  FrameTimer timer;
  for (std::size_t i = 0; i < 2 * TimerCheck::kFrames; ++i) {
    timer.begin();
    if (i % 5 == 0) timer.begin();  // a picture that nobody waited for
    glFlush();
    const double clock = timer.finish();
    EXPECT_GT(timer.milliseconds(), 0.0);
    EXPECT_LE(timer.milliseconds(), TimerCheck::kMost * clock);
    EXPECT_GE(timer.finish(), clock) << "nothing was begun";
  }
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
}

TEST(FrameTimer, OneThatIsLeftLetsAnotherBegin) {
  const OffscreenContext context;
  FrameTimer first, second;
  for (int i = 0; i < 2; ++i) {
    first.begin();
    first.leave();
    second.begin();
    EXPECT_GT(second.finish(), 0.0);
    EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  }
  EXPECT_EQ(first.milliseconds(), 0.0);
}

}  // namespace
}  // namespace palpate
