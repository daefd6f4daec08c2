// The stimuli of the four tasks: which paths are kept, and of how many fields, whatever the seed.
#include "apps/flow/study/flow_stimuli.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/flow/study/path_task.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/render/camera.h"

namespace palpate::test {
namespace {

double length_of(const std::vector<Vec3>& path) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) sum += glm::distance(path[i], path[i + 1]);
  return sum;
}

/// [degrees] by which a path turns within 15 mm, at most.
double sharpest_turn(const std::vector<Vec3>& path) {
  double most = 0.0;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    double arc = 0.0;
    for (std::size_t j = i; j + 1 < path.size() && arc < 0.015; ++j) {
      const double cosine =
          glm::dot(glm::normalize(path[i + 1] - path[i]), glm::normalize(path[j + 1] - path[j]));
      most = std::max(most, std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi);
      arc += glm::distance(path[j], path[j + 1]);
    }
  }
  return most;
}

/// Points of displayed lines that cover the start in the window's picture.
std::size_t before_start(const std::shared_ptr<const PathStimulus>& stimulus) {
  constexpr int kHeight = 864, kWidth = 1152;
  constexpr double kBeside = 0.0018, kBefore = 0.003;  // [m]
  const Camera camera = PathTrial(stimulus).view(nullptr, 1.0 * kWidth / kHeight).camera;
  const Vec3 start = stimulus->path.front(), from = eye(camera);
  const Vec2 at = glm::dvec2(project(camera, start, kWidth, kHeight));
  std::size_t count = 0;
  for (const Line& line : *stimulus->lines) {
    count += as_size(std::ranges::count_if(line.points, [&](const LinePoint& q) {
      const Vec2 pixel = glm::dvec2(project(camera, q.position, kWidth, kHeight));
      return glm::distance(q.position, from) < glm::distance(start, from) - kBefore &&
             glm::distance(pixel, at) < kBeside * kHeight / camera.view_height;
    }));
  }
  return count;
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
    std::map<const VectorField*, std::vector<std::vector<Vec3>>> paths;
    std::set<int> numbers;
    for (std::size_t i = 0; i < choice.stimuli.size(); ++i) {
      const std::vector<Vec3>& path = choice.stimuli[i]->path;
      EXPECT_NEAR(length_of(path), GetParam().length, 1e-3);
      EXPECT_LT(sharpest_turn(path), 95.0) << "seed " << seed << ": stimulus " << i;
      if (!GetParam().flat) {
        EXPECT_EQ(before_start(choice.stimuli[i]), 0U) << "seed " << seed << ": stimulus " << i;
      }
      auto& others = paths[choice.stimuli[i]->field.get()];
      for (const std::vector<Vec3>& other : others) {
        EXPECT_GE(glm::distance(other.front(), path.front()), kStartsApart);
        EXPECT_LE(shared_part(path, other), kMostShared)
            << "seed " << seed << ": stimulus " << i << " goes along another one";
      }
      others.push_back(path);
      numbers.insert(choice.field_numbers.at(i));
    }
    EXPECT_EQ(paths.size(), choice.fields);
    EXPECT_EQ(numbers.size(), choice.fields);
    EXPECT_GE(choice.fields, 15U) << "seed " << seed;
    for (const auto& [field, of_field] : paths) EXPECT_LE(of_field.size(), 2U) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Tasks, FlowStimuli,
                         ::testing::Values(PathWish{.flat = true, .goal = PathGoal::kCircle},
                                           PathWish{.flat = true, .goal = PathGoal::kEnd},
                                           PathWish{.flat = false, .goal = PathGoal::kPlane},
                                           PathWish{.flat = false, .goal = PathGoal::kEnd}));

TEST(FlowStimuli, SayOfHowManyFieldsTheyAre) {
  Progress progress;
  const auto task = make_tracing_2d();
  const std::string said = task->prepare(7, 30, progress);
  EXPECT_NE(said.find("the 30 best of "), std::string::npos) << said;
  const std::vector<DataColumn> columns = task->stimulus_columns();
  const auto column = std::ranges::find(columns, "field", &DataColumn::name) - columns.begin();
  std::set<double> fields;
  for (int s = 0; s < 30; ++s) fields.insert(task->stimulus_row(s).at(as_size(column)));
  EXPECT_NE(said.find("of " + std::to_string(fields.size()) + " of the 30 fields"), std::string::npos)
      << said;
  EXPECT_THROW((void)choose_paths({}, 7, 71, progress), Error);
}

}  // namespace
}  // namespace palpate::test
