/// What a column of a table holds, for those who read it: a line of its data dictionary.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace palpate {

struct DataColumn {
  std::string name;         ///< in the table's first line
  std::string description;  ///< a phrase
  std::string units = {};   ///< "mm"; empty: none
};

/// The dictionary of a table as BIDS has it: an object of one object a column, with `Description` and `Units`. JSON.
[[nodiscard]] std::string data_dictionary(const std::vector<DataColumn>& columns);

/// The names between `separator`, and a line's end: a table's first line.
[[nodiscard]] std::string table_header(const std::vector<DataColumn>& columns, char separator);

/// Columns NAME_x, NAME_y, NAME_z of a place [m] in the workspace, or of a direction. @param what "where it begins".
[[nodiscard]] std::vector<DataColumn> vector_columns(std::string_view name, const std::string& what,
                                                     const std::string& units);

}  // namespace palpate
