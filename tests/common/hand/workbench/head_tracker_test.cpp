// The eyes of a tracked head: where they are on it, where they are while it is not seen, and that they never
// jump.

#include "common/hand/workbench/head_tracker.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace palpate {
namespace {

const Screen kScreen{{-0.3, -0.2, 0.0}, {0.3, -0.2, 0.0}, {-0.3, 0.2, 0.0}};
constexpr double kSeparation = 0.064;

/// A head that is at `place` while it is seen.
class MadeHead final : public PoseSource {
 public:
  bool next(double now, PoseSample& sample) override {
    if (silent || now <= last_) return false;
    last_ = now;
    sample = {now, seen ? std::optional(TrackerPose{place, turn}) : std::nullopt};
    return true;
  }
  [[nodiscard]] bool live() const override { return true; }

  Vec3 place{0.1, 0.05, 0.7};
  Quat turn = identity_rotation();
  bool seen = true, silent = false;

 private:
  double last_ = -1.0;
};

Eyes step(HeadTracker& tracker, MadeHead& head, double now) {
  tracker.follow(head, now);
  return tracker.eyes(now, now);
}

TEST(HeadTracker, PutsTheEyesWhereTheyAreOnTheHead) {
  MadeHead head;
  head.turn = rotation_by({0.0, 0.5 * 3.14159265358979, 0.0});  // looks to the left: its right is away
  HeadTracker beside({}, kScreen, kSeparation);
  const Eyes eyes = step(beside, head, 1.0);
  EXPECT_LT(glm::distance(eyes[0], head.place + Vec3(0.0, 0.0, 0.5 * kSeparation)), 1e-12);
  EXPECT_LT(glm::distance(eyes[1], head.place - Vec3(0.0, 0.0, 0.5 * kSeparation)), 1e-12);

  WorkbenchGeometry workbench;
  workbench.eyes = EyesGeometry{Vec3{-0.03, -0.1, -0.05}, Vec3{0.035, -0.1, -0.05}};
  workbench.tracker.emplace();
  workbench.tracker->position = {
      .degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {{0.01, 0, 0}}};
  workbench.tracker->orientation = {
      .degree = 0, .center = Vec3{0.0}, .scale = 1.0, .coefficients = {Vec3{0.0}}};
  HeadTracker measured(workbench, kScreen, kSeparation);
  head.turn = identity_rotation();
  EXPECT_LT(glm::distance(step(measured, head, 2.0)[1], head.place + Vec3(0.045, -0.1, -0.05)), 1e-12);
  EXPECT_NEAR(glm::distance(measured.resting()[0], measured.resting()[1]), 0.065, 1e-12);
}

TEST(HeadTracker, FreezesThenGlidesToRestAndBackWithoutAJump) {
  WorkbenchGeometry workbench;
  workbench.head.resting_eye = Vec3{0.0, 0.1, 0.5};
  HeadTracker tracker(workbench, kScreen, kSeparation);
  MadeHead head;
  EXPECT_EQ(step(tracker, head, 1.0), tracker.eyes_on({head.place, head.turn})) << "there at once at first";
  const Eyes there = tracker.eyes_on({head.place, head.turn});
  const Vec3 rest = *workbench.head.resting_eye;
  // Not seen from 2 s on: it is where it was for a quarter of a second, and at rest after another 3/4.
  constexpr double kPicture = 1.0 / 128.0;
  std::vector<Vec3> ways;
  Eyes last = there;
  double fastest = 0.0;
  for (double t = 1.0 + kPicture; t < 5.0; t += kPicture) {
    head.seen = t < 2.0 || t > 4.0;
    const Eyes eyes = step(tracker, head, t);
    fastest = std::max(fastest, glm::distance(eyes[0], last[0]) / kPicture);
    last = eyes;
    const Vec3 middle = 0.5 * (eyes[0] + eyes[1]);
    if (t < 2.0 + workbench.head.freeze - kPicture) {
      ASSERT_LT(glm::distance(eyes[0], there[0]), 1e-12) << t;
    }
    if (t > 2.0 + workbench.head.freeze + workbench.head.glide + 2 * kPicture && t < 4.0) {
      ASSERT_LT(glm::distance(middle, rest), 1e-12) << t;
    }
  }
  EXPECT_EQ(tracker.state(), HeadTracker::State::kTracked);
  EXPECT_LT(glm::distance(last[0], there[0]), 1e-12);
  // The way is 0.23 m; a smooth step is 1.5 times as fast in its middle as on average.
  const double way = glm::distance(there[0], tracker.resting()[0]);
  EXPECT_LT(fastest, 1.01 * 1.5 * way / HeadTracker::kReturn);
  EXPECT_GT(fastest, 0.9 * 1.5 * way / HeadTracker::kReturn);
}

TEST(HeadTracker, TakesASilentTrackerForALostHead) {
  HeadTracker tracker({}, kScreen, kSeparation);
  MadeHead head;
  (void)step(tracker, head, 1.0);
  head.silent = true;
  (void)step(tracker, head, 1.0 + 0.9 * HeadTracker::kStale);
  EXPECT_EQ(tracker.state(), HeadTracker::State::kTracked);
  (void)step(tracker, head, 1.0 + 1.1 * HeadTracker::kStale);
  EXPECT_EQ(tracker.state(), HeadTracker::State::kFrozen);
}

TEST(HeadTracker, LooksAheadByTheLatency) {
  WorkbenchGeometry workbench;
  workbench.head.sensor_latency = 0.01;
  HeadTracker tracker(workbench, kScreen, kSeparation);
  workbench.head.predict = false;
  HeadTracker late(workbench, kScreen, kSeparation);
  const Vec3 v{0.4, 0.0, -0.1};
  MadeHead head, same;
  Eyes eyes, eyes_late;
  double t = 1.0;
  for (int i = 0; i < 20; ++i, t += 0.01) {
    head.place = same.place = Vec3(0.0, 0.0, 0.7) + (t - 0.01) * v;  // its word is a sensor's latency late
    tracker.follow(head, t);
    late.follow(same, t);
    eyes = tracker.eyes(t, t + 0.03);
    eyes_late = late.eyes(t, t + 0.03);
  }
  t -= 0.01;
  const Vec3 there = Vec3(0.0, 0.0, 0.7) + (t + 0.03) * v;
  EXPECT_LT(glm::distance(0.5 * (eyes[0] + eyes[1]), there), 1e-12);
  EXPECT_NEAR(glm::distance(0.5 * (eyes_late[0] + eyes_late[1]), there), 0.04 * glm::length(v), 1e-12);
}

TEST(LatencyMeter, TellsTheMedianOfTheLastOnes) {
  LatencyMeter meter;
  EXPECT_EQ(meter.median(), 0.0);
  for (int i = 0; i < 100; ++i) meter.add(i < 50 ? 1.0 : (i % 10 == 0 ? 5.0 : 0.02));
  EXPECT_EQ(meter.median(), 0.02);
}

}  // namespace
}  // namespace palpate
