/// Checks of data that came from outside, before anything is allocated or read by the sizes it claims.
#pragma once

#include <cstddef>
#include <string>

#include "common/base/error.h"
#include "common/field/data_set.h"

namespace palpate {

/// Points along i, j, k of a structured block of any kind; zeros for an unstructured one.
[[nodiscard]] Index3 structured_points(const DataSet& block) noexcept;

/// An error (bad input) about block `index` of `count`.
[[nodiscard]] Error block_error(const DataSet& block, std::size_t index, std::size_t count,
                                const std::string& file, const std::string& found,
                                const std::string& expected);

/// Refuses a file. @throws Error (bad input), always.
[[noreturn]] void refuse_data(const std::string& file, const std::string& found, const std::string& expected);

/// Arrays have the bytes and tuples that they claim, positions three components, offsets rise within the
/// connectivity; points and cells of a uniform or rectilinear block are backed by an array. Point numbers
/// in the connectivity are checked where they are used.
/// @throws Error (bad input) as block_error() makes it.
void check_block(const DataSet& block, std::size_t index, std::size_t count, const std::string& file);

}  // namespace palpate
