#include "common/study/design.h"

#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate::test {
namespace {

TEST(Design, OfTheReferencesNumbersIsBalancedInAllCounts) {
  for (const std::uint64_t seed : {1U, 2U, 99U}) {
    DesignRequest request;
    request.seed = seed;
    const auto design = make_design(request);
    EXPECT_EQ(design.size(), 20U * 4U * 30U);
    const DesignBalance balance = balance_of(design);
    EXPECT_EQ(balance.conditions_of_participant, 0);
    EXPECT_EQ(balance.conditions_of_stimulus, 0);
    EXPECT_EQ(balance.conditions_of_place, 0);
    EXPECT_EQ(balance.stimuli_at_place, 0);
    EXPECT_EQ(balance.tasks_at_place, 0);
    EXPECT_EQ(balance.sequences, 20) << "nobody has the conditions in the order of somebody else";
  }
}

/// Counted here by hand, apart from balance_of(): both versions of each trial, and each place of the order.
TEST(Design, HasBothVersionsOfEachTrialEquallyOftenAmongParticipants) {
  for (const int n : {4, 8, 12, 20, 28}) {
    std::map<std::pair<int, int>, int> versions, places;
    std::map<std::pair<int, int>, std::vector<bool>> sequences;
    for (const PlannedTrial& t :
         make_design({.participants = 2 * n, .tasks = 2, .practice = 3, .recorded = n, .seed = 6})) {
      if (t.practice) continue;
      versions[{t.task, t.stimulus}] += t.guided ? 1 : -1;
      places[{t.task, t.trial}] += t.guided ? 1 : -1;
      sequences[{t.task, t.participant}].push_back(t.guided);
    }
    for (const auto& counts : {versions, places}) {
      EXPECT_EQ(counts.size(), 2U * static_cast<unsigned>(n));
      for (const auto& [what, difference] : counts) EXPECT_EQ(difference, 0) << n << " " << what.second;
    }
    std::set<std::vector<bool>> of_first_square;
    for (int participant = 0; participant < n; ++participant)
      of_first_square.insert(sequences.at({0, participant}));
    EXPECT_EQ(of_first_square.size(), static_cast<unsigned>(n));
  }
}

/// A square of twice an odd number has no such half: one more of one version, one less of the other.
TEST(Design, OfTwiceAnOddNumberIsAsNearToBalanceAsItCanBe) {
  for (const int n : {2, 6, 10, 18}) {
    const DesignBalance balance = balance_of(make_design({.participants = n, .tasks = 1, .recorded = n}));
    EXPECT_EQ(balance.conditions_of_participant, 0);
    EXPECT_EQ(balance.conditions_of_place, 0);
    EXPECT_EQ(balance.stimuli_at_place, 0);
    EXPECT_EQ(balance.conditions_of_stimulus, 2);
    EXPECT_EQ(balance.sequences, n);
  }
}

TEST(Design, HasPracticeInBothConditions) {
  std::map<int, int> sides;
  for (const PlannedTrial& t : make_design({.participants = 9, .tasks = 1, .practice = 10})) {
    if (t.practice) sides[t.participant] += t.guided ? 1 : -1;
  }
  ASSERT_EQ(sides.size(), 9U);
  for (const auto& [who, difference] : sides) EXPECT_EQ(difference, 0) << who;
}

TEST(Design, GivesEachParticipantEachStimulusOnceInATask) {
  std::map<std::pair<int, int>, std::multiset<int>> seen;
  for (const PlannedTrial& t : make_design({.participants = 7, .tasks = 3, .practice = 4, .recorded = 6})) {
    seen[{t.participant, t.task}].insert(t.stimulus);
    EXPECT_EQ(t.practice, t.stimulus >= 6);
    EXPECT_EQ(t.practice, t.trial < 4);
  }
  ASSERT_EQ(seen.size(), 21U);
  for (const auto& [who, stimuli] : seen)
    EXPECT_EQ(stimuli, (std::multiset<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(Design, SaysHowFarItIsFromBalance) {
  std::vector<PlannedTrial> design = make_design({});
  for (PlannedTrial& t : design) t.guided = t.guided || t.stimulus == 3;
  const DesignBalance balance = balance_of(design);
  EXPECT_EQ(balance.conditions_of_stimulus, 20);
  EXPECT_GT(balance.conditions_of_participant, 0);
  EXPECT_EQ(balance_of(make_design({.participants = 19})).stimuli_at_place, 1) << "one row is missing";
}

TEST(Design, DependsOnTheSeedAlone) {
  const auto order = [](std::uint64_t seed) {
    std::vector<int> out;
    for (const PlannedTrial& t : make_design({.seed = seed}))
      out.push_back(2 * t.stimulus + (t.guided ? 1 : 0));
    return out;
  };
  EXPECT_EQ(order(5), order(5));
  EXPECT_NE(order(5), order(6));
}

TEST(Design, RefusesOddNumbersOfTrials) { EXPECT_THROW((void)make_design({.recorded = 7}), Error); }

}  // namespace
}  // namespace palpate::test
