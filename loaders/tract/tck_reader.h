/// MRtrix tracks. A text header of "key: value" lines up to END, then points of three numbers (Float32 or
/// Float64, either byte order) in RAS+ millimetres; three NaN close a line, three infinities the file.
/// MRtrix3 manual, "MRtrix Tracks file format (.tck)".
///
/// MRtrix takes a file that breaks off for complete, and drops a line that is not closed; here both are
/// errors.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/tractogram.h"

namespace palpate {

/// @param bytes of the whole file.
/// @param notes what the user should know of it.
/// @throws Error (bad input) with `file`: a header without its end, datatype or place of the points, points
/// that are not finite, a line or file that is not closed.
[[nodiscard]] Tractogram read_tck(const std::string& file, std::string_view bytes,
                                  std::vector<std::string>& notes);

}  // namespace palpate
