/// What the verb of experiments takes.
#pragma once

#include <filesystem>
#include <string>

namespace palpate {

/// An experiment with participants: the folder that holds it, and what is done with it.
struct StudyOptions {
  std::string action;            ///< make, run, simulate, analyse, replay, sheet; empty: not said
  std::filesystem::path folder;  ///< of the experiment; empty: not said
  std::string tasks;             ///< make: names with commas between; empty: all of the program
  int participants = 20;         ///< make: how many the design is for
  int practice = 10;             ///< make: trials of a task that are not analysed
  int recorded = 20;             ///< make: trials of a task that are, half of them guided
  double guidance = 1.0;         ///< make: factor of the stiffness of what guides the hand
  std::string participant;       ///< run, simulate, replay: anonymous code; empty: the next one, or all
  std::string trial;             ///< replay: TASK/NUMBER; empty: all
};

}  // namespace palpate
