#include "loaders/hdf/hdf5_check.h"

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <hdf5.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

/// Deflate makes no more than that of a byte.
constexpr std::uint64_t kMostPacked = 1100;

struct Search {
  std::uint64_t file_size = 0;
  std::string name, problem;
};

/// What is wrong with a data set, or empty.
std::string problem_of(hid_t set, std::uint64_t file_size) {
  const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
  std::uint64_t bytes = H5Tget_size(type);
  std::vector<hsize_t> counts;
  if (const int rank = H5Sget_simple_extent_ndims(space); rank > 0) {
    counts.resize(as_size(rank));
    H5Sget_simple_extent_dims(space, counts.data(), nullptr);
  }
  bool too_many = false;
  for (const hsize_t count : counts) too_many = __builtin_mul_overflow(bytes, count, &bytes) || too_many;
  const std::uint64_t stored = H5Dget_storage_size(set);
  H5Tclose(type);
  H5Sclose(space);
  if (too_many || bytes / kMostPacked > file_size)
    return "claims " + (too_many ? "more numbers than there are" : std::to_string(bytes) + " bytes");
  // An axis of netCDF that has no coordinates is a data set without numbers.
  if (stored == 0 && H5Aexists(set, "CLASS") > 0) return {};
  if (bytes > 0 && stored == 0) return "was never written";
  if (bytes / kMostPacked > stored)
    return "claims " + std::to_string(bytes) + " bytes of " + std::to_string(stored);
  return {};
}

herr_t check_set(hid_t root, const char* name, const H5O_info_t* about, void* data) {
  auto& search = *static_cast<Search*>(data);
  if (about->type != H5O_TYPE_DATASET) return 0;
  const hid_t set = H5Dopen2(root, name, H5P_DEFAULT);
  if (set < 0) {
    search.problem = "cannot be opened";
  } else {
    search.problem = problem_of(set, search.file_size);
    H5Dclose(set);
  }
  search.name = name;
  return search.problem.empty() ? 0 : 1;
}

}  // namespace

void check_hdf5(const std::string& file) {
  const HeadOfFile head = read_head(file, 8);
  if (head.bytes != std::string_view("\x89HDF\r\n\x1a\n", 8)) return;
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const hid_t opened = H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (opened < 0) throw input_error({file, "", "cannot be opened as HDF5", "", "it may be truncated"});
  Search search;
  search.file_size = head.file_size;
  const herr_t result = H5Ovisit(opened, H5_INDEX_NAME, H5_ITER_NATIVE, check_set, &search);
  H5Fclose(opened);
  if (result < 0) throw input_error({file, "", "its groups cannot be read", "", "the file may be damaged"});
  if (!search.problem.empty())
    throw input_error({file, "data set '" + search.name + "'", search.problem, "what the file holds",
                       "the file may be damaged"});
}

}  // namespace palpate
