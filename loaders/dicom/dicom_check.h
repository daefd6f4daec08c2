/// What a DICOM file claims, held against its size: GDCM allocates what a length says.
#pragma once

#include <cstdint>
#include <string>

namespace palpate {

/// Walks all data elements, nested ones included (PS3.5 section 7), without keeping any value.
/// @throws Error (bad input) naming the byte: cut off, a length that reaches beyond the file or out of the
/// sequence around it, nested too deeply, no DICOM file, or one that is deflated as a whole.
void check_dicom(const std::string& file);

}  // namespace palpate
