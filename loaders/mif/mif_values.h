/// The numbers of an MRtrix image, brought into the order of a DataArray.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/mif/mif_header.h"

namespace palpate {

/// The type that numbers have once they are scaled: as stored, or floating-point numbers that hold them where they
/// are scaled, bytes where they are bits.
[[nodiscard]] ScalarType value_type(const MifHeader& header) noexcept;

/// @param volumes component c of a tuple is volume volumes[c], each below header.volumes().
/// @throws Error (bad input) where the data ends before its size.
[[nodiscard]] DataArray read_mif_values(const MifHeader& header, const std::vector<std::uint64_t>& volumes,
                                        const std::function<void(double)>& on_progress);

}  // namespace palpate
