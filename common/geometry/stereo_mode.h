/// How a display shows two eyes: what a workbench says of a screen, and a picture is made for.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace palpate {

enum class StereoMode : std::uint8_t {
  kNone,          ///< one eye
  kSideBySide,    ///< left eye left; halves with square pixels, not squeezed
  kTopBottom,     ///< left eye on top; likewise
  kRows,          ///< left eye in the first row, right eye in the second, ...
  kColumns,       ///< likewise
  kAnaglyph,      ///< red-cyan, in colour: Dubois 2009
  kAnaglyphGrey,  ///< red-cyan, of luminances: free of rivalry between colours
  kQuadBuffer,    ///< a buffer of the window for each eye, shown in turn; in a file the left eye's on top
};
inline constexpr std::array<std::string_view, 8> kStereoModeNames{
    "none", "side-by-side", "top-bottom", "rows", "columns", "anaglyph", "anaglyph-grey", "quad-buffer"};

}  // namespace palpate
