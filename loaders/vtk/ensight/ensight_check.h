/// A check of EnSight variable files: VTK's readers take what is there of a truncated one.
#pragma once

#include <cstddef>
#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/vtk/ensight/ensight_counts.h"

namespace palpate {

/// One line of a case file's section VARIABLE: "vector per node: 1 velocity flow.vel***".
struct EnsightVariable {
  std::string name;
  Association association = Association::kPoint;
  std::string pattern;  ///< file name, with asterisks for the number of the step
};

/// The variables that the text of a case file lists.
[[nodiscard]] std::vector<EnsightVariable> ensight_variables(std::string_view case_text);

/// The case file `text` as VTK's reader, which knows neither quotes nor lost files, can read it from another
/// folder: file names without quotes and absolute, behind `prefix`; lines of variables whose files are not
/// there left out, as what ensight_unused() names.
/// @param case_file where the text is from. @param lost gets the names of variables whose files are not there, and
/// `notes` a sentence for each.
/// @throws Error (bad input) where a file name holds blanks, or the geometry is not there.
[[nodiscard]] std::string ensight_case_for_vtk(std::string_view text, const std::string& case_file,
                                               const std::string& prefix, std::set<std::string>& lost,
                                               std::vector<std::string>& notes);

/// Whether the case is of EnSight 6, where all parts share one list of nodes.
[[nodiscard]] bool is_ensight6(std::string_view case_text);

/// Checks that the file of a variable at time step `step` of `steps` is large enough for `values` numbers: 12
/// characters each in text, 4 bytes in binary (EnSight User Manual, ch. 9). Of these the file need not hold
/// `missing` ones, those that were read as NaN, where it has a block "partial". And that its parts have as many as `due` says.
/// @throws Error (bad input).
void check_ensight_values(const std::string& case_file, const std::string& variable, const EnsightCounts& due,
                          std::size_t values, std::size_t missing, std::size_t step, std::size_t steps);

}  // namespace palpate
