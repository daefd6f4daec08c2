/// Words, numbers and bytes of a file of meshes, text or mixed with binary, in memory.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {

class MeshWords {
 public:
  /// @param text outlives this. @param file for messages. @param comment begins what is no text up to the end of its
  /// line; '\0' for none. A byte order mark before it is passed over.
  MeshWords(std::string_view text, std::string file, char comment = '\0')
      : text_(text),
        file_(std::move(file)),
        comment_(comment),
        at_(text.starts_with("\xEF\xBB\xBF") ? 3 : 0) {}

  /// Whether nothing but blanks and comments is left.
  [[nodiscard]] bool done();
  /// The next word, which ends at blanks and commas; empty at the end. In quotes: all between them, without these.
  std::string_view word();
  [[nodiscard]] std::string_view peek();
  [[nodiscard]] bool quoted() const noexcept { return quoted_; }
  /// The rest of this line, without blanks around it; the next word is of the next line.
  std::string_view rest_of_line();

  /// The next word as written_number() reads it. @param what it should be, for the message.
  /// @throws Error (bad input) where it is none.
  double number(const char* what);
  /// A whole number between `least` and `most`.
  std::int64_t integer(const char* what, std::int64_t least, std::int64_t most);
  /// The number of things of which each takes `least_bytes` of what is left of the file at least.
  std::size_t count(const char* what, std::size_t least_bytes);

  /// @name Binary parts, which begin behind the end of the line that was read last
  /// @{
  void end_line();
  /// @throws Error (bad input) where the file ends.
  std::string_view bytes(std::size_t count, const char* what);
  template <typename T>
  T take(bool swapped, const char* what) {
    const std::string_view raw = bytes(sizeof(T), what);
    std::array<char, sizeof(T)> copy{};
    std::memcpy(copy.data(), raw.data(), sizeof(T));
    if (swapped) std::reverse(copy.begin(), copy.end());
    return std::bit_cast<T>(copy);
  }
  /// @}
  /// Goes behind the next place where `word` stands. @throws Error (bad input) where it does not.
  void skip_behind(std::string_view word);

  [[nodiscard]] std::size_t left() const noexcept { return text_.size() - at_; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// @throws Error (bad input) about the line of the last word, always.
  [[noreturn]] void refuse(const std::string& found, const std::string& expected,
                           const std::string& remedy = "") const;

 private:
  void skip();

  std::string_view text_;
  std::string file_;
  char comment_;
  std::size_t at_ = 0;
  std::size_t last_ = 0;  ///< where the last word begins
  bool quoted_ = false;
};

}  // namespace palpate
