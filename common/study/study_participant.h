/// Who took part in an experiment.
#pragma once

#include <string>
#include <vector>

namespace palpate {

/// One line of participants.tsv.
struct StudyParticipant {
  std::string code;
  int number = 0;  ///< in the design, from 0
  bool simulated = false;
  std::vector<double> traits;  ///< of a simulated one, as trait_columns() has them
};

}  // namespace palpate
