// The stimuli of the four tasks: which paths are kept, and of how many fields, whatever the seed.
#include "apps/flow/study/flow_stimuli.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/flow/study/path_task.h"
#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate::test {
namespace {

double length_of(const std::vector<Vec3>& path) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += glm::distance(path[i], path[i + 1]);
  return sum;
}

class FlowStimuli : public ::testing::TestWithParam<PathWish> {};

TEST_P(FlowStimuli, AreOfManyFieldsAndStartApart) {
  for (const std::uint64_t seed : {1U, 12U}) {
    Progress progress;
    const PathChoice choice = choose_paths(GetParam(), seed, 30, progress);
    ASSERT_EQ(choice.stimuli.size(), 30U);
    // 70 as the reference selected, and fewer only where all places of the other fields were tried.
    constexpr std::size_t kEnough = 70, kMost = kMostOfField * as_size(kFields), kPlaces = 10'000;
    const std::size_t poor = (kMost - std::min(kMost, choice.good)) / kMostOfField;  // fields, at least
    EXPECT_TRUE(choice.good >= kEnough || choice.tried >= kPlaces * poor) << "seed " << seed;
    EXPECT_GE(choice.good, 60U) << "seed " << seed;
    EXPECT_LE(choice.good, kMost);
    std::map<const VectorField*, std::vector<Vec3>> starts;
    for (const auto& stimulus : choice.stimuli) {
      EXPECT_NEAR(length_of(stimulus->path), GetParam().length, 1e-3);
      std::vector<Vec3>& others = starts[stimulus->field.get()];
      for (const Vec3& other : others) EXPECT_GE(glm::distance(other, stimulus->path.front()), kStartsApart);
      others.push_back(stimulus->path.front());
    }
    EXPECT_EQ(starts.size(), choice.fields);
    EXPECT_GE(choice.fields, 15U) << "seed " << seed;
    for (const auto& [field, of_field] : starts) EXPECT_LE(of_field.size(), 2U) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, FlowStimuli,
                         ::testing::Values(PathWish{.flat = true, .goal = PathGoal::kCircle},
                                           PathWish{.flat = true, .goal = PathGoal::kEnd},
                                           PathWish{.flat = false, .goal = PathGoal::kPlane},
                                           PathWish{.flat = false, .goal = PathGoal::kEnd}));

TEST(FlowStimuli, SayOfHowManyFieldsTheyAre) {
  Progress progress;
  const std::string said = make_tracing_2d()->prepare(7, 30, progress);
  EXPECT_NE(said.find("the 30 best of "), std::string::npos) << said;
  EXPECT_NE(said.find(" of the 30 fields"), std::string::npos) << said;
  EXPECT_THROW((void)choose_paths({}, 7, 71, progress), Error);
}

}  // namespace
}  // namespace palpate::test
