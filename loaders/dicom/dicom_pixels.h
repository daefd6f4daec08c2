/// The numbers of DICOM images, of any transfer syntax that GDCM decodes.
#pragma once

#include <functional>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/dicom/dicom_series.h"

namespace palpate {

/// The type that numbers have: as stored where nothing is rescaled, else single precision.
[[nodiscard]] ScalarType dicom_value_type(const DicomSeries& series) noexcept;

/// @param volumes component c of a tuple is volume volumes[c], each below series.volumes.
/// @throws Error (bad input) where pixels cannot be decoded or are not as many as the header says.
[[nodiscard]] DataArray read_dicom_values(const DicomSeries& series, const std::vector<std::size_t>& volumes,
                                          const std::function<void(double)>& on_progress);

}  // namespace palpate
