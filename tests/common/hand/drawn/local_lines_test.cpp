#include "common/hand/drawn/local_lines.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

bool wait_for(const std::function<bool()>& happened,
              std::chrono::milliseconds limit = std::chrono::seconds(30)) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  return true;
}

LocalRequest rake(const Vec3& center = {1.0, 0.0, 0.0}) {
  return {.field = helix_flow(0.25),
          .shape = SeedShape::kRake,
          .center = center,
          .along = {0.0, 0.25, 0.0},
          .seeds = 5,
          .length = 0.5};
}

TEST(LocalSeeds, OfARakeStandEvenlyFromEndToEnd) {
  const std::vector<Vec3> seeds = local_seeds(rake());
  ASSERT_EQ(seeds.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_LE(glm::distance(seeds[i], Vec3(1.0, -0.25 + 0.125 * static_cast<double>(i), 0.0)), 1e-15);
  }
  LocalRequest one = rake();
  one.seeds = 1;
  EXPECT_EQ(local_seeds(one), std::vector<Vec3>{one.center});
}

TEST(LocalSeeds, OfAPlaneStandRowByRow) {
  LocalRequest plane = rake();
  plane.shape = SeedShape::kPlane;
  plane.across = {0.0, 0.0, 0.5};
  plane.seeds = 3;
  const std::vector<Vec3> seeds = local_seeds(plane);
  ASSERT_EQ(seeds.size(), 9U);
  for (std::size_t j = 0; j < 3; ++j) {
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 expected{1.0, 0.25 * (static_cast<double>(i) - 1.0), 0.5 * (static_cast<double>(j) - 1.0)};
      EXPECT_LE(glm::distance(seeds[3 * j + i], expected), 1e-15);
    }
  }
}

TEST(LocalLines, TracesARakeBothWays) {
  std::atomic<int> woken{0};
  LocalLines local([&] { ++woken; });
  EXPECT_EQ(local.drawn(), nullptr);
  local.request(rake());
  ASSERT_TRUE(wait_for([&] { return local.drawn() != nullptr; }));
  EXPECT_TRUE(wait_for([&] { return woken > 0; }));
  const auto drawn = local.drawn();
  EXPECT_EQ(drawn->shape, SeedShape::kRake);
  EXPECT_EQ(drawn->seeds, local_seeds(rake()));
  EXPECT_LE(glm::distance(drawn->origin, Vec3(1.0, -0.25, 0.0)), 1e-15);
  EXPECT_LE(glm::distance(drawn->u, Vec3(0.0, 0.5, 0.0)), 1e-15);
  ASSERT_TRUE(drawn->lines);
  EXPECT_EQ(drawn->lines->size(), 10U) << "downstream and upstream of five seeds";
  for (const Line& line : *drawn->lines) {
    const Helix helix{line.points.front().position, 0.25};
    EXPECT_NEAR(line.points.back().arc, 0.5, 1e-6);
    for (const LinePoint& point : line.points) {
      EXPECT_LE(glm::distance(point.position, helix.at_time(point.time)), 1e-3);
    }
  }
}

TEST(LocalLines, HaveTheArrayThatColoursTheScene) {
  LocalLines local([] {});
  LocalRequest request = rake();
  auto array = std::make_shared<LineArray>();
  array->name = "Temp";
  array->at = [](const Vec3& x, CellHint&) { return 300.0 + x.z; };
  request.array = array;
  local.request(request);
  ASSERT_TRUE(wait_for([&] { return local.drawn() != nullptr; }));
  const LocalSeeds& drawn = *local.drawn();
  ASSERT_TRUE(drawn.array);
  EXPECT_EQ(drawn.array->name, "Temp");
  std::vector<float> expected;
  for (const Line& line : *drawn.lines) {
    for (const LinePoint& point : line.points)
      expected.push_back(static_cast<float>(300.0 + point.position.z));
  }
  EXPECT_EQ(drawn.array->values, expected);
  request.array = nullptr;
  local.request(request);
  EXPECT_TRUE(wait_for([&] { return local.drawn()->array == nullptr; }));
}

TEST(LocalLines, TheLatestRequestWins) {
  LocalLines local([] {});
  for (int i = 0; i <= 50; ++i) local.request(rake({0.5 + 0.01 * i, 0.0, 0.0}));
  EXPECT_TRUE(wait_for([&] {
    const auto drawn = local.drawn();
    return drawn && glm::distance(drawn->seeds[2], Vec3(1.0, 0.0, 0.0)) < 1e-12;
  }));
}

TEST(LocalLines, AreGoneWhenTheyAreSwitchedOffEvenWhileTheyAreTraced) {
  std::atomic<int> woken{0};
  LocalLines local([&] { ++woken; });
  int at_work = 0;  // times that they were switched off while they were traced
  for (int i = 0; i < 100 && at_work < 3; ++i) {
    const int before = woken;
    LocalRequest large = rake({1.0, 0.0, 0.001 * i});
    large.seeds = 3000;
    large.length = 5.0;
    local.request(large);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const bool done = woken > before;
    local.request({});
    EXPECT_EQ(local.drawn(), nullptr);
    if (done) continue;
    // Traced to the end all the same, or not begun yet.
    if (wait_for([&] { return woken > before; }, std::chrono::milliseconds(500))) ++at_work;
    EXPECT_EQ(local.drawn(), nullptr) << "lines of a shape that is no longer wanted";
  }
  EXPECT_GT(at_work, 0);
}

TEST(LocalLines, SeedsOutsideAndPlacesThatAreNoneGiveNoLines) {
  LocalLines local([] {});
  local.request(rake({NAN, 0.0, 0.0}));
  EXPECT_EQ(local.drawn(), nullptr);
  local.request(rake({2.0, 0.0, 0.0}));
  ASSERT_TRUE(wait_for([&] { return local.drawn() != nullptr; }));
  local.request(rake({9.0, 0.0, 0.0}));
  EXPECT_TRUE(wait_for([&] { return local.drawn()->lines->empty(); }));
}

}  // namespace
}  // namespace palpate::test
