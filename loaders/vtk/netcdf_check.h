/// A cheap look at a netCDF classic file before its reader sees it: every variable must lie inside the file.
/// The reader itself would allocate what a header claims, and read a truncated file as zeros.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// What is wrong with a netCDF classic file (CDF-1, CDF-2, CDF-5) of `file_size` bytes that begins with
/// `head`, or empty. A file of another kind (HDF5) passes. A header that goes on past `head` is checked as
/// far as it is there. Format: "The NetCDF Classic Format Specification", Unidata.
[[nodiscard]] std::string netcdf_problem(std::string_view head, std::uint64_t file_size);

/// @throws Error (bad input).
void check_netcdf(const std::string& file);

}  // namespace palpate
