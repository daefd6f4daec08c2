/// How DICOM files begin, with the preamble of PS3.10 or without it.
#pragma once

#include <cstddef>
#include <string_view>

namespace palpate {

/// Enough of a file for is_dicom_start().
inline constexpr std::size_t kDicomHeadBytes = 132;

/// Whether a file begins as DICOM: with 128 bytes of anything and "DICM", or with an element of group 2 or 8.
[[nodiscard]] bool is_dicom_start(std::string_view head) noexcept;
/// Whether that mark is there, behind which the elements begin.
[[nodiscard]] bool has_dicom_preamble(std::string_view head) noexcept;

/// Whether the element of `head` says its type, as in explicit transfer syntaxes. @pre head.size() >= 6.
[[nodiscard]] bool has_dicom_type(std::string_view head) noexcept;

}  // namespace palpate
