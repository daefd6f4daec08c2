/// A DICOM file as its data elements (PS3.5 section 7). All lengths are held against the file and against the
/// sequences around them; nothing is copied.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/files/mapped_file.h"

namespace palpate {

/// Group and element: 0x00280010.
using DicomTag = std::uint32_t;
inline constexpr DicomTag kDicomPixels = 0x7FE00010U;

struct DicomSet;

struct DicomElement {
  DicomTag tag = 0;
  /// As the file or, where it does not say it, the dictionary has it: "DS"; empty where neither does.
  std::string_view type;
  std::string_view value;  ///< of a sequence, and of packed pixels: empty
  std::vector<DicomSet> items;
  bool big_endian = false;
  bool packed = false;  ///< pixels in fragments
};

struct DicomSet {
  std::vector<DicomElement> elements;  ///< in file order

  /// The element, or null.
  [[nodiscard]] const DicomElement* find(DicomTag tag) const noexcept;
};

class DicomFile {
 public:
  /// Files with a preamble and without it, of the transfer syntax that their first elements show.
  /// @throws Error (bad input) naming the byte: cut off, a length that reaches beyond the file or out of the
  /// sequence around it, nested too deeply, no DICOM file, or one that is deflated as a whole.
  explicit DicomFile(const std::string& file);

  [[nodiscard]] const DicomSet& elements() const noexcept { return elements_; }
  /// Where in the file the pixels stand; none where there are none, or they are packed.
  [[nodiscard]] std::optional<std::uint64_t> pixels_at() const noexcept;

 private:
  MappedFile mapped_;
  DicomSet elements_;
};

}  // namespace palpate
