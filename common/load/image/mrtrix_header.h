/// The text header that MRtrix's images and tracks share: a first line that names the kind, lines of "key:
/// value", a line END; where the data lie in another file it may end without. MRtrix3 manual, "MRtrix Image file format", "MRtrix Tracks file format".
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate {

struct MrtrixHeader {
  std::vector<std::pair<std::string, std::string>> entries;  ///< in file order, keys may come several times
  std::size_t end = 0;                                       ///< the first byte behind the header

  /// The last value of `key`, or null.
  [[nodiscard]] const std::string* find(std::string_view key) const noexcept;
  /// All values of `key`.
  [[nodiscard]] std::vector<std::string> all(std::string_view key) const;
};

/// @param bytes from the start of the file, with the whole header in them.
/// @param mark the first line ("mrtrix image").
/// @throws Error (bad input) with `file` where the mark is missing, or the END of a header whose data follow.
[[nodiscard]] MrtrixHeader read_mrtrix_header(const std::string& file, std::string_view bytes,
                                              std::string_view mark);

/// A number type as MRtrix names it ("Float32LE", "UInt16", "Bit"), in lower case and without its byte order.
struct MrtrixNumber {
  std::string type;         ///< "float32"
  bool big_endian = false;  ///< without a word, little
};
[[nodiscard]] MrtrixNumber parse_mrtrix_number(std::string_view datatype);

}  // namespace palpate
