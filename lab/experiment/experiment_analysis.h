/// What an experiment with participants says (common/study): per participant and condition the mean and the deviation
/// of error and time, and the tests of Ikits 2006, sec. 7.2, on them.
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "common/base/index.h"
#include "common/study/statistics.h"
#include "common/study/study_folder.h"

namespace palpate {

enum class Measure : std::uint8_t { kError, kTime };
inline constexpr std::array kMeasures{Measure::kError, Measure::kTime};

/// A number a participant, without guidance and with it, in the same order.
struct Pairs {
  std::vector<double> free, guided;
};

struct MeasureAnalysis {
  Pairs means, deviations;
  PairedTest of_means, of_deviations;  ///< of free - guided: positive where guidance helps
  InferentialIntervals intervals;      ///< of the means; a: free, b: guided
  NormalityTest normality;             ///< of the differences of means
  SignedRankTest ranks;                ///< of means
  PermutationTest permutation;         ///< of trials, beta of guidance
};

struct TaskAnalysis {
  StudyTaskInfo info;
  std::size_t trials = 0;                 ///< recorded ones, repeats included
  std::size_t repeats = 0;                ///< of them, repeats of a trial with flaws
  std::size_t flawed = 0;                 ///< left out: force or recording failed (TrialFlaws)
  std::size_t too_far = 0;                ///< else for their error
  std::size_t too_slow = 0;               ///< else for their time
  std::array<std::size_t, 2> outliers{};  ///< those for error or time, by condition: free, guided
  std::array<std::size_t, 2> kept{};      ///< those that count, likewise
  std::size_t unreached = 0;              ///< of those that count: the goal was not met
  std::vector<std::string> participants;  ///< who is in the pairs
  std::vector<std::string> lacking;       ///< who has fewer than two good trials in a condition
  std::array<MeasureAnalysis, 2> measures;
  std::array<Correlation, 2> error_with_time;  ///< of means: free, guided

  [[nodiscard]] const MeasureAnalysis& of(Measure m) const { return measures[as_size(m)]; }
};

/// Errors of a task in 3D less those of the same in 2D, over participants that have both.
struct DimensionTest {
  std::string task;  ///< "tracing": the 3D one's title
  bool guided = false;
  PairedTest errors;
};

struct ExperimentAnalysis {
  std::vector<TaskAnalysis> tasks;
  std::vector<DimensionTest> dimensions;
  std::size_t participants = 0;  ///< who is analysed: all people, or all programs
  bool simulated = false;        ///< they are programs
  std::size_t set_aside = 0;     ///< programs beside people: not analysed
  std::size_t missing =
      0;  ///< trials of theirs, practice included, that the design has and the folder has not
};

/// Whether a trial counts: practice does not, nor do errors and times beyond the limits of its task, nor trials in which
/// force or recording failed.
[[nodiscard]] bool counts(const TrialRecord& trial, const StudyTaskInfo& info) noexcept;

/// People and programs are not analysed together: where there are people, they alone are.
/// @throws Error (bad input) for a damaged folder.
[[nodiscard]] ExperimentAnalysis analyse_experiment(const StudyFolder& folder,
                                                    const std::vector<TrialRecord>& trials);

}  // namespace palpate
