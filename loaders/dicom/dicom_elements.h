/// Numbers and words of DICOM data sets, found wherever an image keeps them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "loaders/dicom/dicom_file.h"

namespace palpate {

/// The data sets in which an attribute of a frame is looked for, the likeliest first: the frame's own item,
/// the one shared by all frames, the file.
using DicomScope = std::vector<const DicomSet*>;

/// The element that is not empty, in the first of the sets that has one; else null. Nested items are searched.
[[nodiscard]] const DicomElement* find_dicom(const DicomScope& scope, DicomTag tag);

/// Words with the padding of DICOM taken off; empty where the element is not there.
[[nodiscard]] std::string dicom_text(const DicomScope& scope, DicomTag tag);

/// The numbers of an element, of whatever type it is; none where it is not there or holds something else.
/// @param binary what the bytes are where neither the file nor the dictionary says their type: doubles, or
/// one float, else text.
[[nodiscard]] std::vector<double> dicom_numbers(const DicomScope& scope, DicomTag tag, bool binary = false);

/// The first of them, where it is finite.
[[nodiscard]] std::optional<double> dicom_number(const DicomScope& scope, DicomTag tag);

}  // namespace palpate
