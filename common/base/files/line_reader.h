/// A text file line by line, in bounded memory.
#pragma once

#include <cstddef>
#include <fstream>
#include <memory>
#include <string>
#include <string_view>

namespace palpate {

class LineReader {
 public:
  static constexpr std::size_t kLongestLine = 1U << 16U;  ///< [bytes]; longer ones are no text of ours

  /// @param expected what the file should be, for the message: "a CSV file of seeds".
  /// @throws Error (bad input) where `file` is a folder or cannot be opened.
  LineReader(std::string file, std::string expected);

  /// Goes to the next line; false at the end.
  /// @throws Error (bad input) for a line longer than kLongestLine, or where reading fails.
  bool next();
  /// Without its end, be that LF or CRLF; the byte order mark of a file is left out too. Valid until next().
  [[nodiscard]] std::string_view line() const noexcept { return line_; }
  /// From 1.
  [[nodiscard]] std::size_t number() const noexcept { return number_; }
  /// Whether the line was ended by a newline: the last one of a file that was cut off is not.
  [[nodiscard]] bool complete() const noexcept { return complete_; }

  /// Says what is wrong with the current line. @throws Error (bad input), always.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected) const;

 private:
  std::string file_;
  std::string expected_;
  std::ifstream in_;
  std::unique_ptr<char[]> buffer_;
  std::string_view line_;
  std::size_t number_ = 0;
  bool complete_ = false;
};

}  // namespace palpate
