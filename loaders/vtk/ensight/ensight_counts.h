/// How many values the parts of an EnSight variable's file have: VTK's readers take one too many or too few for those that follow.
///
/// File format: EnSight User Manual, ch. 9 (Gold: one number a line, or C Binary; EnSight 6: six numbers of 12 characters a line).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// What a part is to have.
struct EnsightCounts {
  Association association = Association::kPoint;
  std::size_t components = 3;
  std::vector<std::size_t>
      tuples;  ///< of the parts that were read, in their order; the file may have others between
};

/// What is wrong with the counts of a file of EnSight Gold, or empty: also where it has what is not followed here (blocks "partial",
/// several steps, Fortran's records).
[[nodiscard]] std::string gold_counts_problem(std::string_view file, bool text, const EnsightCounts& due);

/// The same of values of nodes of EnSight 6, which stand without parts.
[[nodiscard]] std::string ensight6_counts_problem(std::string_view text, std::size_t values);

}  // namespace palpate
