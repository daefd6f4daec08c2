#include "lab/experiment/experiment_analysis.h"

#include <algorithm>

#include "common/base/index.h"

namespace palpate {
namespace {

double value_of(const TrialRecord& trial, Measure measure) noexcept {
  return measure == Measure::kError ? trial.outcome.error : trial.outcome.seconds;
}

TaskAnalysis analyse_task(const StudyTaskInfo& info, const std::vector<TrialRecord>& all,
                          std::uint64_t seed) {
  TaskAnalysis out{.info = info};
  std::map<std::string, std::array<std::vector<const TrialRecord*>, 2>> good;  // by participant and condition
  for (const TrialRecord& trial : all) {
    if (trial.task != info.name || trial.practice) continue;
    ++out.trials;
    out.repeats += trial.attempt > 0 ? 1 : 0;
    const std::size_t side = trial.guided ? 1 : 0;
    auto& of_participant = good[trial.participant];
    if (counts(trial, info)) {
      of_participant[side].push_back(&trial);
      ++out.kept[side];
      out.unreached += trial.outcome.reached ? 0 : 1;
    } else if (trial.outcome.flaws.any()) {
      ++out.flawed;
    } else {
      ++out.outliers[side];
      ++(trial.outcome.error > info.cutoff_error ? out.too_far : out.too_slow);
    }
  }
  std::array<std::vector<TrialValue>, 2> values;
  for (const auto& [code, by_condition] : good) {
    if (std::ranges::any_of(by_condition,
                            [](const auto& some) { return some.size() < as_size(kLeastOfCondition); })) {
      out.lacking.push_back(code);
      continue;
    }
    const int number = static_cast<int>(out.participants.size());
    out.participants.push_back(code);
    for (const Measure m : kMeasures) {
      MeasureAnalysis& a = out.measures[as_size(m)];
      for (const bool guided : {false, true}) {
        std::vector<double> numbers;
        for (const TrialRecord* trial : by_condition[guided ? 1 : 0]) {
          numbers.push_back(value_of(*trial, m));
          values[as_size(m)].push_back({number, trial->stimulus, guided, numbers.back()});
        }
        (guided ? a.means.guided : a.means.free).push_back(mean_of(numbers));
        (guided ? a.deviations.guided : a.deviations.free).push_back(deviation_of(numbers));
      }
    }
  }
  for (const Measure m : kMeasures) {
    MeasureAnalysis& a = out.measures[as_size(m)];
    a.of_means = paired_test(a.means.free, a.means.guided);
    a.of_deviations = paired_test(a.deviations.free, a.deviations.guided);
    a.intervals = inferential_intervals(a.means.free, a.means.guided);
    a.normality = shapiro_wilk(differences(a.means.free, a.means.guided));
    a.ranks = signed_rank_test(a.means.free, a.means.guided);
    a.permutation = permutation_test(values[as_size(m)], seed);
  }
  const MeasureAnalysis& errors = out.of(Measure::kError);
  const MeasureAnalysis& times = out.of(Measure::kTime);
  out.error_with_time = {correlation(times.means.free, errors.means.free),
                         correlation(times.means.guided, errors.means.guided)};
  return out;
}

/// The numbers of those who are in both tasks.
std::pair<std::vector<double>, std::vector<double>> common_of(const TaskAnalysis& a, const TaskAnalysis& b,
                                                              bool guided) {
  std::pair<std::vector<double>, std::vector<double>> out;
  const auto means = [guided](const TaskAnalysis& t) -> const std::vector<double>& {
    return guided ? t.of(Measure::kError).means.guided : t.of(Measure::kError).means.free;
  };
  for (std::size_t i = 0; i < a.participants.size(); ++i) {
    const auto found = std::ranges::find(b.participants, a.participants[i]);
    if (found == b.participants.end()) continue;
    out.first.push_back(means(a)[i]);
    out.second.push_back(means(b)[as_size(found - b.participants.begin())]);
  }
  return out;
}

}  // namespace

bool counts(const TrialRecord& trial, const StudyTaskInfo& info) noexcept {
  return !trial.practice && trial.outcome.error <= info.cutoff_error &&
         trial.outcome.seconds <= info.cutoff_time && !trial.outcome.flaws.any();
}

ExperimentAnalysis analyse_experiment(const StudyFolder& folder, const std::vector<TrialRecord>& all) {
  ExperimentAnalysis out;
  std::map<std::string, bool> who;
  for (const TrialRecord& trial : all) who[trial.participant] = trial.simulated;
  const std::size_t programs =
      as_size(std::ranges::count_if(who, [](const auto& one) { return one.second; }));
  out.simulated = programs == who.size();
  out.set_aside = out.simulated ? 0 : programs;
  out.participants = who.size() - out.set_aside;
  for (const StudyParticipant& one : folder.participants()) {
    if (one.simulated != out.simulated) continue;
    out.missing += as_size(std::ranges::count(folder.design(), one.number, &PlannedTrial::participant)) -
                   as_size(std::ranges::count_if(all, [&](const TrialRecord& trial) {
                     return trial.participant == one.code && trial.attempt == 0;
                   }));
  }
  std::vector<TrialRecord> trials = all;
  std::erase_if(trials, [&](const TrialRecord& trial) { return trial.simulated != out.simulated; });
  for (const std::string& name : folder.plan().tasks)
    out.tasks.push_back(analyse_task(folder.task(name), trials, folder.plan().design.seed));
  for (const TaskAnalysis& deep : out.tasks) {
    const auto flat =
        std::ranges::find_if(out.tasks, [&](const TaskAnalysis& t) { return t.info.name == deep.info.pair; });
    if (deep.info.flat || flat == out.tasks.end()) continue;
    for (const bool guided : {false, true}) {
      const auto [a, b] = common_of(deep, *flat, guided);
      out.dimensions.push_back({deep.info.title, guided, paired_test(a, b)});
    }
  }
  return out;
}

}  // namespace palpate
