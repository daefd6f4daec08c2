/// Binary meshes of Chaste: a first line of counts that ends with BIN, rows of numbers (lowest byte first, nodes counted from 0),
/// and perhaps remarks behind them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace palpate {

class ChasteBinary {
 public:
  /// Nothing where the first line is another one.
  /// @throws Error (bad input) for counts that are none.
  [[nodiscard]] static std::optional<ChasteBinary> open(const std::string& file);

  /// A number of the first line; 0 behind the last.
  [[nodiscard]] std::uint64_t count(std::size_t at) const { return at < counts_.size() ? counts_[at] : 0; }

  /// Reads the rows, each of some node numbers and then of some numbers of 8 bytes.
  /// @throws Error (bad input) where the file does not hold as many as its first line says.
  void read(std::size_t nodes_a_row, std::size_t numbers_a_row);
  [[nodiscard]] std::uint32_t node(std::size_t row, std::size_t at) const;
  [[nodiscard]] double number(std::size_t row, std::size_t at) const;

  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

 private:
  std::string file_;
  std::vector<std::uint64_t> counts_;
  std::size_t begin_ = 0, nodes_ = 0, numbers_ = 0;
  std::string bytes_;  ///< of the rows
};

}  // namespace palpate
