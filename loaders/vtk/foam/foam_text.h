/// Text of OpenFOAM's files: words, strings, marks, and lists in text or binary. OpenFOAM User Guide, "Basic input/output file
/// format".
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/mapped_file.h"

namespace palpate {

/// The text of a file, or, where there is none of that name, of one with the ending .gz.
class FoamText {
 public:
  /// @throws Error (bad input).
  explicit FoamText(const std::filesystem::path& file);
  [[nodiscard]] std::string_view text() const noexcept { return mapped_ ? mapped_->text() : unpacked_; }

 private:
  std::unique_ptr<MappedFile> mapped_;
  std::string unpacked_;
};

/// Thrown where only the text is known: who knows the file says its name.
struct FoamMalformed {
  std::string found;
};

[[nodiscard]] inline bool is_foam_mark(char c) noexcept {
  return c == '{' || c == '}' || c == '(' || c == ')' || c == ';';
}

/// How the lists of a file are stored.
struct FoamStorage {
  bool binary = false, swapped = false;
  std::size_t label = 4, scalar = 8;  ///< bytes
};

/// Words, strings and marks of dictionaries. What cannot be is thrown as FoamMalformed.
class FoamTokens {
 public:
  FoamTokens(std::string_view text, const FoamStorage& storage) : text_(text), storage_(storage) {}

  [[nodiscard]] bool done();
  /// The mark, word or string that is next, without quotes; empty at the end.
  [[nodiscard]] std::string_view peek();
  std::string_view next();
  /// Whether the last token was in quotes.
  [[nodiscard]] bool quoted() const { return quoted_; }
  [[nodiscard]] const FoamStorage& storage() const { return storage_; }

  void expect(std::string_view mark);
  std::size_t count();
  /// The bytes of a binary list, which follow its bracket at once.
  std::string_view bytes(std::size_t count, std::size_t size);
  /// Over the rest of an entry, up to its semicolon, or the brackets it opens.
  void skip_entry();
  /// The text of the rest of an entry, without its semicolon, with the brackets it opens.
  std::string_view entry();

 private:
  void skip();
  void skip_binary(std::string_view list);

  std::string_view text_;
  FoamStorage storage_;
  std::size_t at_ = 0;
  bool quoted_ = false;
};

/// What the FoamFile dictionary at the head of a file says of its lists.
[[nodiscard]] FoamStorage foam_storage(std::string_view text);
/// Behind that dictionary.
[[nodiscard]] FoamTokens foam_body(std::string_view text);

/// Numbers of an element of a binary list, "List<vector>". @throws FoamMalformed for others.
[[nodiscard]] std::size_t foam_components(std::string_view list);
/// @pre i is in the list.
[[nodiscard]] std::int64_t foam_label(std::string_view bytes, std::size_t i, const FoamStorage& storage);
[[nodiscard]] double foam_scalar(std::string_view bytes, std::size_t i, const FoamStorage& storage);
/// @throws FoamMalformed for what is none.
[[nodiscard]] double foam_number(std::string_view token);
/// "1.5", or "(1 2 3)".
void append_foam_tuple(FoamTokens& tokens, std::size_t components, std::vector<double>& out);

}  // namespace palpate
