/// The numbers of DICOM images: as they stand in the file, or of any packing that GDCM decodes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/dicom/dicom_series.h"

namespace palpate {

/// The type that numbers have: as stored where nothing is rescaled, whole numbers of 16 bits where all rescaled ones
/// are, else floating-point numbers that hold them; floating-point ones, too, where slices are missing. Where the bits
/// of a pixel may hold more than 16 bits take and pixels are not packed, these are looked at.
/// @throws Error (bad input) where a file that is looked at cannot be read.
[[nodiscard]] ScalarType dicom_value_type(const DicomSeries& series);

/// Numbers of a pixel: 3 of colours.
[[nodiscard]] int dicom_components(const DicomSeries& series) noexcept;

/// Missing slices are NaN.
/// @param type dicom_value_type(series). @param volumes component c of a tuple is volume volumes[c], each below series.volumes; one of colours.
/// @param room gives memory for them, zeros; may be empty.
/// @throws Error (bad input) where pixels cannot be decoded or are not as many as the header says.
[[nodiscard]] DataArray read_dicom_values(
    const DicomSeries& series, ScalarType type, const std::vector<std::size_t>& volumes,
    const std::function<void(double)>& on_progress,
    const std::function<std::shared_ptr<std::byte>(std::uint64_t)>& room);

}  // namespace palpate
