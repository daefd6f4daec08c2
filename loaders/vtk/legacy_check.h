/// A cheap walk through a legacy .vtk file before VTK's reader sees it: every count in it must fit into what
/// is left of the file. VTK would allocate what a count claims.
///
/// File format: "VTK File Formats for VTK Version 4.2" and, for version 5.1, the VTK Examples' note on it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

/// A number put in the place of one that is not finite: VTK's reader of text knows no NaN.
struct LegacyStandIn {
  std::string_view text;
  double number;
};
/// Of NaN, infinity and minus infinity.
inline constexpr std::array<LegacyStandIn, 3> kStandIns{
    {{"1.2764e37", 1.2764e37}, {"1.2874e37", 1.2874e37}, {"1.2984e37", 1.2984e37}}};

/// A word of a text file that is no finite number.
struct LegacyWord {
  std::size_t at = 0;  ///< first byte
  std::size_t size = 0;
  std::size_t kind = 0;  ///< index of its stand-in
};

struct LegacyScan {
  /// What is wrong, with its place ("line 9: POINTS 5000000000 float: …"), or empty.
  std::string problem;
  std::vector<LegacyWord> not_finite;  ///< by rising place
};

/// Walks through the legacy file `text`. Sections that the walk knows of but does not understand end it
/// without complaint: VTK judges them.
[[nodiscard]] LegacyScan scan_legacy(std::string_view text);

/// The time that the field data of a legacy file states: TIME, as VisIt writes it, or TimeValue. `text` may be its
/// beginning alone.
[[nodiscard]] std::optional<double> legacy_time(std::string_view text);

/// `text` with the stand-ins of `words`.
[[nodiscard]] std::string with_stand_ins(std::string_view text, const std::vector<LegacyWord>& words);

}  // namespace palpate
