#include "common/load/dicom_mark.h"

#include <algorithm>
#include <array>

namespace palpate {

bool has_dicom_preamble(std::string_view head) noexcept {
  constexpr std::size_t kPreamble = 128;
  return head.size() >= kDicomHeadBytes && head.substr(kPreamble, 4) == "DICM";
}

bool has_dicom_type(std::string_view head) noexcept {
  static constexpr std::array<std::string_view, 34> kTypes{
      "AE", "AS", "AT", "CS", "DA", "DS", "DT", "FL", "FD", "IS", "LO", "LT", "OB", "OD", "OF", "OL", "OV",
      "OW", "PN", "SH", "SL", "SQ", "SS", "ST", "SV", "TM", "UC", "UI", "UL", "UN", "UR", "US", "UT", "UV"};
  return std::find(kTypes.begin(), kTypes.end(), head.substr(4, 2)) != kTypes.end();
}

bool is_dicom_start(std::string_view head) noexcept {
  constexpr std::size_t kElement = 8;
  if (has_dicom_preamble(head)) return true;
  if (head.size() < kElement || head[1] != '\0' || head[3] != '\0') return false;
  // Group length, or one of the first attributes of group 8: character set to SOP instance.
  if (head[0] == 2) return head[2] <= 2 && head[2] >= 0 && has_dicom_type(head);
  constexpr char kLastOfStart = 0x18;
  if (head[0] != 8 || head[2] < 0 || head[2] > kLastOfStart) return false;
  if (has_dicom_type(head)) return true;
  // Without a type, four bytes of a small length; a group length (element 0) might as well be two counts of a grid.
  return head[2] != 0 && head[4] != '\0' && head[5] == '\0' && head[6] == '\0' && head[7] == '\0';
}

}  // namespace palpate
