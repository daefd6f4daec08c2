/// Numbers and words of DICOM data sets, found wherever an image keeps them.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <gdcmDataSet.h>

namespace palpate {

/// The data sets in which an attribute of a frame is looked for, the likeliest first: the frame's own item,
/// the one shared by all frames, the file.
using DicomScope = std::vector<const gdcm::DataSet*>;

/// Words with the padding of DICOM taken off; empty where the element is not there. Nested items are
/// searched.
[[nodiscard]] std::string dicom_text(const DicomScope& scope, const gdcm::Tag& tag);

/// The numbers of an element, of whatever type it is; none where it is not there or holds something else.
/// @param binary what the bytes are where the file does not say their type: doubles, else text.
[[nodiscard]] std::vector<double> dicom_numbers(const DicomScope& scope, const gdcm::Tag& tag,
                                                bool binary = false);

/// The first of them.
[[nodiscard]] std::optional<double> dicom_number(const DicomScope& scope, const gdcm::Tag& tag);

}  // namespace palpate
