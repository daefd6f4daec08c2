/// Who does which trial when: a randomised Latin square (Ikits 2006, sec. 7.1), and whether it is balanced.
#pragma once

#include <cstdint>
#include <vector>

namespace palpate {

struct DesignRequest {
  int participants = 20;
  int tasks = 4;
  int practice = 10;  ///< trials of a task, on stimuli of their own
  int recorded = 20;  ///< likewise, even
  std::uint64_t seed = 1;
};

struct PlannedTrial {
  int participant = 0;
  int place = 0;  ///< of the task in the participant's session, from 0
  int task = 0;
  int trial = 0;  ///< of the task, from 0, practice first
  bool practice = false;
  int stimulus = 0;  ///< recorded ones first: 0 to recorded - 1, then those for practice
  bool guided = false;
};

/// Recorded trials of a task: row r of a cyclic Latin square of n stimuli has at place c the stimulus and the
/// condition
///
///   s = (r + c) mod n,   guided = (c + floor(2 r / n)) mod 2,   n even
///
/// with rows, places, stimuli and the two conditions renumbered at random, for each task and each n
/// participants anew. So each participant has both conditions equally often; and over n participants each
/// stimulus, at each place, is seen once, each stimulus in both conditions equally often where n is a multiple of
/// four (else up to one more), and each place has both equally often. Tasks follow each other by a Latin square
/// likewise. All in the order in which they are done.
/// @throws Error (usage) where `recorded` is odd or a number is too small.
[[nodiscard]] std::vector<PlannedTrial> make_design(const DesignRequest& request);

/// How far the recorded trials are from equal numbers: the largest difference of two counts.
struct DesignBalance {
  int conditions_of_participant = 0;  ///< guided less unguided, of a participant in a task
  int conditions_of_stimulus = 0;     ///< likewise of a stimulus
  int conditions_of_place = 0;        ///< likewise of the trials at one place of a task
  int stimuli_at_place = 0;           ///< between stimuli at one place of a task
  int tasks_at_place = 0;             ///< between tasks at one place of the session
};
[[nodiscard]] DesignBalance balance_of(const std::vector<PlannedTrial>& design);

}  // namespace palpate
