/// The words and numbers of a text file, packed with gzip or not, in bounded memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace palpate {

class TextLines {
 public:
  static constexpr std::size_t kLongestLine = 1U << 16U;  ///< [bytes]; longer ones are no text of ours

  /// @param comment begins what is no text up to the end of its line; '\0' for none.
  /// @throws Error (bad input) where the file cannot be opened.
  explicit TextLines(std::string file, char comment = '\0');
  ~TextLines();
  TextLines(const TextLines&) = delete;
  TextLines& operator=(const TextLines&) = delete;

  /// Goes to the next line; false at the end. A line that was given back comes again.
  /// @throws Error (bad input) for a line that is too long or holds zero bytes, and for damaged gzip data.
  bool next();
  /// Lets next() stay at this line once.
  void give_back() noexcept { given_back_ = true; }
  /// Without blanks and line ends around it. Valid until next().
  [[nodiscard]] std::string_view line() const noexcept { return line_; }

  /// The next word of this line, or of the lines that follow; empty at the end of the file. Words end at
  /// blanks and commas.
  [[nodiscard]] std::string_view word();
  /// The next word of this line only; empty where there is none left.
  [[nodiscard]] std::string_view word_here() noexcept;

  /// The next word as a number. @param what it should be, for the message.
  /// @throws Error (bad input) where it is none or not finite, or the file ends.
  [[nodiscard]] double number(const char* what);
  /// The same for a whole number between `least` and `most`.
  [[nodiscard]] std::int64_t integer(const char* what, std::int64_t least, std::int64_t most);

  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  [[nodiscard]] std::size_t line_number() const noexcept { return number_; }  ///< from 1

  /// @throws Error (bad input) about the current line, always.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected,
                           const std::string& remedy = "") const;

 private:
  struct Unpacker;
  /// The next line as it stands in the file, without its end; false at the end of the file.
  bool take_line(std::string_view& line);

  std::string file_;
  char comment_;
  std::unique_ptr<Unpacker> unpacker_;
  std::unique_ptr<char[]> buffer_;
  std::size_t begin_ = 0, end_ = 0;  ///< what is in the buffer and not taken yet
  std::string_view line_;
  std::string_view rest_;  ///< what word() has not taken of line_
  std::size_t number_ = 0;
  bool given_back_ = false;
};

}  // namespace palpate
