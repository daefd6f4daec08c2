// The experiment of flow as it is, from `study make` to `study analyse`, with the force set to zero: both conditions are
// one then, and what the tests of its page find is chance.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "apps/flow/study/path_task.h"
#include "common/base/index.h"
#include "common/base/json.h"
#include "common/cli/explorer.h"
#include "common/experiment/study_verb.h"
#include "tests/support/temp_folder.h"
#include "tests/support/uniformity.h"

namespace palpate::test {
namespace {

/// A task of flow with the stimuli of another seed than the experiment's: they take most of the time, and many
/// experiments share them.
class SharedStimuli final : public StudyTask {
 public:
  SharedStimuli(std::shared_ptr<StudyTask> task, std::uint64_t seed) : task_(std::move(task)), seed_(seed) {}

  [[nodiscard]] const StudyTaskInfo& info() const override { return task_->info(); }
  std::string prepare(std::uint64_t, int count, Progress& progress) override {
    if (said_.empty()) said_ = task_->prepare(seed_, count, progress);
    return said_;
  }
  [[nodiscard]] std::unique_ptr<StudyTrial> open(int stimulus) const override {
    return task_->open(stimulus);
  }
  [[nodiscard]] std::vector<DataColumn> stimulus_columns() const override {
    return task_->stimulus_columns();
  }
  [[nodiscard]] std::vector<double> stimulus_row(int stimulus) const override {
    return task_->stimulus_row(stimulus);
  }

 private:
  std::shared_ptr<StudyTask> task_;
  std::uint64_t seed_;
  std::string said_;
};

StudyTasks shared_stimuli(std::uint64_t seed) {
  StudyTasks out;
  for (auto&& task : {make_advection_2d(), make_tracing_2d(), make_advection_3d(), make_tracing_3d()})
    out.push_back(std::make_shared<SharedStimuli>(task, seed));
  return out;
}

/// A test, what it is of, and a task.
using Subject = std::pair<std::string, std::string>;
/// The p values of one experiment.
std::vector<std::pair<Subject, double>> p_values(const StudyTasks& tasks, std::uint64_t seed,
                                                 double guidance) {
  const Explorer flow{.name = "flow",
                      .summary = "",
                      .examples = {},
                      .verbs = {study_verb([&tasks] { return tasks; }, {})},
                      .default_verb = "study"};
  TempFolder temporary;
  const std::string folder = temporary.path("s").string();
  const auto run = [&](std::vector<std::string> words) {
    words.insert(words.begin(), {"flow", "study"});
    words.emplace_back("--quiet");
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    ::testing::internal::CaptureStdout();
    const int code = run_explorer(flow, static_cast<int>(arguments.size()), arguments.data());
    const std::string said = ::testing::internal::GetCapturedStdout();
    ASSERT_EQ(code, 0) << words[2] << " " << said;
  };
  run({"make", folder, "--seed", std::to_string(seed), "--participants", "8", "--practice", "0", "--recorded",
       "4", "--guidance", std::to_string(guidance)});
  run({"simulate", folder});
  run({"analyse", folder});
  const std::map<std::string, std::string> tests{{"means, ISO - ANISO", "t test"},
                                                 {"permutation, ANISO - ISO", "permutation"}};
  std::vector<std::pair<Subject, double>> out;
  const Json report = parse_json(read_file(temporary.path("s/analysis/report.json")));
  for (const Json& m : report["measurements"]) {
    const auto test = tests.find(m["parameter"].get<std::string>());
    if (test == tests.end() || m["quantity"] != "p" || !m["value"].is_number()) continue;
    out.push_back({{test->second + ", " + m["subject"].get<std::string>(), m["method"].get<std::string>()},
                   m["value"].get<double>()});
  }
  return out;
}

/// PALPATE_STUDY_SEEDS=200 asks that of 200 experiments, each with a seed of its own, 25 of them at a time with the same
/// stimuli (docs/guide/study.md has what came of it); by default a few are looked at.
TEST(StudyWithoutForce, FindsNoEffect) {
  const char* const asked = std::getenv("PALPATE_STUDY_SEEDS");
  const int seeds = asked != nullptr ? std::max(1, std::atoi(asked)) : 2;
  constexpr int kShared = 25;
  StudyTasks tasks;
  std::map<std::string, std::vector<double>> found;
  std::size_t not_defined = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    if (seed % kShared == 0) tasks = shared_stimuli(static_cast<std::uint64_t>(1000 + seed));
    const auto values = p_values(tasks, static_cast<std::uint64_t>(1 + seed), 0.0);
    // Two tests of two subjects in four tasks. Where its four paths lead nearly everybody astray who is not guided, a
    // task has too few participants left, and nothing is tested.
    ASSERT_LE(values.size(), 16U);
    not_defined += 16U - values.size();
    for (const auto& [subject, p] : values) {
      EXPECT_GT(p, 1e-5) << subject.first << " " << subject.second << ", seed " << 1 + seed;
      found[subject.first + ", " + subject.second].push_back(p);
      found[subject.first + ", all tasks"].push_back(p);
      if (asked != nullptr)
        std::cout << seed + 1 << "\t" << subject.first << "\t" << subject.second << "\t" << p << std::endl;
    }
  }
  EXPECT_LE(not_defined, as_size(seeds) / 10);
  if (asked != nullptr) std::cout << not_defined << " p values are not defined\n";
  for (const auto& one : found) {
    const std::string& subject = one.first;
    const std::vector<double>& p = one.second;
    const UniformityTest test = uniformity_test(p);
    const auto below = [&p](double most) {
      return std::ranges::count_if(p, [&](double x) { return x <= most; });
    };
    EXPECT_TRUE(test.p > 0.001 || subject.starts_with("t test")) << subject << ", p = " << test.p;
    if (asked != nullptr) {
      std::cout << subject << ": " << p.size() << " values, D = " << test.distance << ", p = " << test.p
                << ", " << below(0.05) << " up to 0.05, " << below(0.25) << " up to 0.25, " << below(0.5)
                << " up to 0.5\n";
    }
  }
}

/// With the force of the reference the same experiment is of another opinion.
TEST(StudyWithoutForce, FindsAnEffectWithForce) {
  const auto values = p_values(shared_stimuli(1000), 1, 1.0);
  EXPECT_GE(
      std::ranges::count_if(
          values, [](const auto& v) { return v.first.first == "t test, position error" && v.second < 0.01; }),
      3);
}

}  // namespace
}  // namespace palpate::test
