#include "loaders/hdf/cgns_file.h"

#include <array>

#include <hdf5.h>

namespace palpate {

static_assert(sizeof(hid_t) == sizeof(std::int64_t));

namespace {

/// What `use` makes of a node's data set and its space; `none` where there are none.
template <class Result, class Use>
Result of_data(hid_t file, const std::string& node, Result none, const Use& use) {
  const std::string data = node + "/ data";
  if (H5Lexists(file, data.c_str(), H5P_DEFAULT) <= 0) return none;
  const hid_t set = H5Dopen2(file, data.c_str(), H5P_DEFAULT);
  if (set < 0) return none;
  const hid_t space = H5Dget_space(set);
  Result found = use(set, space);
  H5Sclose(space);
  H5Dclose(set);
  return found;
}

}  // namespace

CgnsFile::CgnsFile(const std::string& file) : file_(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT)) {}

CgnsFile::~CgnsFile() {
  if (file_ >= 0) H5Fclose(file_);
}

bool CgnsFile::has(const std::string& node) const { return H5Lexists(file_, node.c_str(), H5P_DEFAULT) > 0; }

std::string CgnsFile::label(const std::string& node) const {
  constexpr std::size_t kLength = 33;
  if (H5Aexists_by_name(file_, node.c_str(), "label", H5P_DEFAULT) <= 0) return {};
  const hid_t attribute = H5Aopen_by_name(file_, node.c_str(), "label", H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, kLength);
  std::array<char, kLength + 1> text{};
  H5Aread(attribute, type, text.data());
  H5Tclose(type);
  H5Aclose(attribute);
  return text.data();
}

std::uint64_t CgnsFile::count(const std::string& node) const {
  return of_data(file_, node, std::uint64_t{0}, [](hid_t, hid_t space) {
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    return count < 0 ? 0 : static_cast<std::uint64_t>(count);
  });
}

int CgnsFile::axes(const std::string& node) const {
  return of_data(file_, node, 0, [](hid_t, hid_t space) { return H5Sget_simple_extent_ndims(space); });
}

std::vector<std::int64_t> CgnsFile::numbers(const std::string& node, std::uint64_t most) const {
  return of_data(file_, node, std::vector<std::int64_t>(), [&](hid_t set, hid_t space) {
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (count <= 0 || static_cast<std::uint64_t>(count) > most) return std::vector<std::int64_t>();
    std::vector<std::int64_t> out(static_cast<std::size_t>(count));
    const bool read = H5Dread(set, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) >= 0;
    return read ? out : std::vector<std::int64_t>();
  });
}

std::vector<std::string> CgnsFile::children(const std::string& node) const {
  std::vector<std::string> names;
  const hid_t group = H5Gopen2(file_, node.c_str(), H5P_DEFAULT);
  if (group < 0) return names;
  H5Literate(
      group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr,
      [](hid_t, const char* name, const H5L_info_t*, void* data) -> herr_t {
        static_cast<std::vector<std::string>*>(data)->emplace_back(name);
        return 0;
      },
      &names);
  H5Gclose(group);
  return names;
}

std::string CgnsFile::word(const std::string& node) const {
  std::string text;
  for (const std::int64_t c : numbers(node)) text += static_cast<char>(c);
  return text;
}

}  // namespace palpate
