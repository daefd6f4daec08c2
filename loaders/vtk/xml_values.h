/// Values as VTK XML files hold them, as text or as bytes behind a header: how many there are. VTK takes what
/// it needs of them, so that one too many shifts all that follow, and says nothing.
///
/// File format: "VTK File Formats for VTK Version 4.2", "XML File Formats".
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// Numbers that stand in text.
struct TextValues {
  std::uint64_t count = 0;
  std::uint64_t largest = 0;  ///< of whole numbers, at least 0: where a list of offsets ends
  std::string wrong;          ///< the first word that is no number of the type, or empty; counting ends there
};

/// Bytes of one number of a type ("Float32"); 1 where the type is not known.
[[nodiscard]] std::uint64_t bytes_of_xml_type(const std::string& type);

/// Whether the values of a type are numbers: not text, nor bits.
[[nodiscard]] bool is_xml_number(const std::string& type);

/// Counts the numbers of `text`. A plus sign may precede them; NaN and infinity are numbers of a Float type.
/// What a type cannot hold is none: VTK stops there. @pre is_xml_number(type).
[[nodiscard]] TextValues text_values(std::string_view text, const std::string& type);

/// How the bytes of binary arrays stand in the file.
struct BinaryHeader {
  bool big_endian = false;
  bool compressed = false;
  bool base64 = false;             ///< four characters for three bytes
  std::uint64_t number_bytes = 4;  ///< of the numbers of a header
};

/// A binary array: what its header says, and what of it is there.
struct BinaryArray {
  std::uint64_t values =
      0;                   ///< bytes of the values, uncompressed, by the header; kHuge where that is cut off
  std::uint64_t size = 0;  ///< bytes, or characters of base64, of header and values as they stand in the file
  bool whole = false;      ///< all of these are there
  std::uint64_t block = 0;  ///< bytes of each compressed part but the last one; 0: there is one part at most
};
/// Of the array that begins at `data[0]`.
[[nodiscard]] BinaryArray binary_array(std::string_view data, const BinaryHeader& header);

}  // namespace palpate
