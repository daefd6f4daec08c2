/// Tables of comma-separated numbers with a header that names the columns.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/line_reader.h"

namespace palpate {

/// Reads the columns that a caller names, wherever they stand; the others may hold anything without a comma.
/// Names are compared without case or quotes. Blank lines and lines that start with '#' are passed over.
class CsvReader {
 public:
  /// Reads the header.
  /// @param required names of columns, lower case; @param optional ones that may be missing.
  /// @param what the file should be: "a CSV file of seeds with the header x,y,z".
  /// @throws Error (bad input) where the file cannot be read, is empty or lacks a required column.
  CsvReader(const std::string& file, std::span<const std::string_view> required,
            std::span<const std::string_view> optional, const std::string& what);

  /// Reads the next row into `values`: the required columns in the order given, then the optional ones, NaN
  /// where the table has no such column. False at the end.
  /// @throws Error (bad input) naming the line of a row that has more or fewer fields than the header, or
  /// whose named columns hold no number.
  bool next(std::span<double> values);

  /// What the current row has in any column, whatever that is; nothing where the table has no such column.
  [[nodiscard]] std::string_view text(std::string_view column) const;

  /// @throws Error (bad input) about the current row, always.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const {
    lines_.refuse(found, expected);
  }

 private:
  static constexpr std::size_t kMissing = std::numeric_limits<std::size_t>::max();
  bool next_line();

  LineReader lines_;
  std::vector<std::string> names_;
  /// Where each name stands; kMissing for an optional one that is not there.
  std::vector<std::size_t> columns_;
  std::string header_;
  std::vector<std::string> header_names_;  ///< a field of each row
};

}  // namespace palpate
