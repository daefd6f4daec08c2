/// A file that keeps what took time to make of an input, such as layers and meshes, for the next opening.
///
/// It lies in $XDG_CACHE_HOME/palpate/hearts (~/.cache where the variable is not set), named after the input and its
/// place, and may be deleted at any time; its first line says what it is of. It belongs to one thing: the version of the method and a digest of all that the thing was made from stand
/// first, so that other options, an input that has changed and a newer program find nothing in it and write
/// it anew. The checksum of all before it stands at its end: what is damaged or cut off counts as nothing,
/// too.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/mapped_file.h"

namespace palpate {

/// auto: what took more than half a second to make; always: all; off: none is looked for or kept.
enum class Keeping : std::uint8_t { kAuto, kAlways, kOff };

/// "auto", "always", "off". @throws Error (usage) for another word.
[[nodiscard]] Keeping keeping_from_name(const std::string& name);

class CachedFile {
 public:
  /// What is kept, in words.
  struct Kind {
    const char* what;     ///< "layers": named in notes, and the ending of the file
    const char* version;  ///< one line; goes up with every change of how they are made
  };

  /// @param input the file that is opened: "heart.pts" keeps its layers in "heart-8f2c….palpate.layers".
  /// @param threads that sum up, as parallel_for(); they change nothing.
  CachedFile(const std::filesystem::path& input, const Kind& kind, Keeping keeping, int threads);

  /// Whether there is a file that find() would look into; a key need not be made else.
  [[nodiscard]] bool there() const;
  /// What `decode` makes of the body that is kept under `key`; nothing where it is another's or damaged, or
  /// `decode` gives nothing. notes() says which. @param key one line. @param decode from std::string_view to
  /// a std::optional.
  template <typename Decode>
  auto find(const std::string& key, const Decode& decode) {
    decltype(decode(std::string_view())) found;
    const std::unique_ptr<const MappedFile> mapped = map();
    if (!mapped) return found;
    if (const auto body = body_of(*mapped, key)) found = decode(*body);
    note_found(found.has_value());
    return found;
  }

  /// Whether what took that long [s] is to be kept. Where there is no folder for it, or a read-only one, it is not, and
  /// notes() says so.
  [[nodiscard]] bool wants(double seconds);
  /// Where the disk refuses, notes() says so. @pre wants().
  void keep(const std::string& key, std::string_view body);

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// What was taken or kept, or why not, for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  /// Null where it cannot be read.
  [[nodiscard]] std::unique_ptr<const MappedFile> map() const;
  [[nodiscard]] std::optional<std::string_view> body_of(const MappedFile& mapped,
                                                        const std::string& key) const;
  void note_found(bool found);

  std::filesystem::path file_;  ///< empty: the user has no folder
  std::string from_;            ///< its first line
  Kind kind_;
  Keeping keeping_;
  int threads_;
  std::vector<std::string> notes_;
};

/// Takes a line off the front of `text`; nothing where it has no end.
[[nodiscard]] std::optional<std::string_view> take_line(std::string_view& text);

/// Numbers as they lie in memory.
template <typename T>
[[nodiscard]] std::string_view bytes_of(std::span<const T> numbers) {
  return {reinterpret_cast<const char*>(numbers.data()), numbers.size_bytes()};
}

}  // namespace palpate
