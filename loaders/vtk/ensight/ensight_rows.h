/// The rows of an EnSight case, "scalar per node: 1 p flow.p***", and which of them nothing is read of.
///
/// File format: EnSight User Manual, ch. 9.
#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// A line of a case file.
struct EnsightRow {
  std::string_view line;
  std::string section;  ///< "VARIABLE"
  std::string kind;     ///< before the colon: "scalar per node"; empty of other lines, comments among them
  std::vector<std::string> words;  ///< behind it; those between double quotes are one, and lose the quotes

  /// Whether it names numbers of nodes or elements that are read.
  [[nodiscard]] bool is_variable() const;
  /// How many words are numbers of a time set and a file set, which may stand before `behind` others.
  [[nodiscard]] std::size_t sets(std::size_t behind) const;
};

/// All lines of a case. @param text lives longer.
[[nodiscard]] std::vector<EnsightRow> ensight_rows(std::string_view text);

/// What a case says and nothing is read of, a sentence for each kind: constants, complex and measured values, materials,
/// bodies that move, names that are no rows.
/// @param offered the names of the variables that can be read, or were left out with a word.
[[nodiscard]] std::vector<std::string> ensight_unused(std::string_view case_text,
                                                      const std::set<std::string>& offered);

}  // namespace palpate
