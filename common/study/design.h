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
  int attempt = 0;  ///< 0, or how often it has been repeated: no part of the design
};

/// Recorded trials of a task: row r of a cyclic Latin square of n stimuli has at place c the stimulus and the
/// condition
///
///   s = (r + c) mod n,   guided where (r - c) mod n < n / 2,   n even
///
/// with rows, places and stimuli renumbered at random, for each task and each n participants anew. So each
/// participant has both conditions equally often, in a sequence of conditions that is nobody else's among n. Over n
/// participants each stimulus is seen at each place once, and each place has both conditions equally often: r - c
/// runs through all residues with r and with c. Each stimulus has both equally often where n is a multiple of four,
/// else n / 2 + 1 times the one and n / 2 - 1 times the other: r - c = 2 r - s has the residues of one parity, each
/// twice, and no cyclic square of such an n divides better (Wanless 2002,
/// Electron. J. Combin. 9:R12). Tasks follow each other by a Latin square likewise. Of
/// trials for practice each participant has half in each condition, in an order of their own. All in the order in
/// which they are done.
/// @throws Error (usage) where `recorded` is odd or a number is too small.
[[nodiscard]] std::vector<PlannedTrial> make_design(const DesignRequest& request);

/// Trials of each condition that the analysis needs of a participant, for a deviation.
inline constexpr int kLeastOfCondition = 2;

/// How far the recorded trials are from equal numbers: the largest difference of two counts.
struct DesignBalance {
  int conditions_of_participant = 0;  ///< guided less unguided, of a participant in a task
  int conditions_of_stimulus = 0;     ///< likewise of a stimulus
  int conditions_of_place = 0;        ///< likewise of the trials at one place of a task
  int stimuli_at_place = 0;           ///< between stimuli at one place of a task
  int tasks_at_place = 0;             ///< between tasks at one place of the session
  int sequences =
      0;  ///< different sequences of conditions that participants have, in the task with the fewest
};
[[nodiscard]] DesignBalance balance_of(const std::vector<PlannedTrial>& design);

}  // namespace palpate
