/// HDF5 files whose content is wrong and whose structure is right: HDF5 itself does not survive every damaged structure, which
/// costs a helper and not the explorer. Edits of a file that was read from the folder PALPATE_FUZZ_TEMPLATES.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <hdf5.h>

namespace palpate::test {

using FuzzBytes = std::vector<std::uint8_t>;

/// The files of a folder, by name.
inline std::vector<FuzzBytes> templates_in(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> files;
  for (const auto& file : std::filesystem::directory_iterator(folder)) files.push_back(file.path());
  std::ranges::sort(files);
  std::vector<FuzzBytes> out;
  for (const auto& file : files) {
    std::ifstream stream(file, std::ios::binary);
    out.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  if (out.empty()) std::abort();
  return out;
}

/// A file in memory, edited by six bytes at a time: what, at which node, where in it, by which value.
class Hdf5Edits {
 public:
  explicit Hdf5Edits(FuzzBytes image) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    constexpr std::size_t kGrow = 1U << 16U;
    H5Pset_fapl_core(access, kGrow, false);
    H5Pset_file_image(access, image.data(), image.size());
    file_ = H5Fopen("edited", H5F_ACC_RDWR, access);
    H5Pclose(access);
    if (file_ < 0) std::abort();
    H5Ovisit(file_, H5_INDEX_NAME, H5_ITER_INC, add_node, this);
  }
  ~Hdf5Edits() { H5Fclose(file_); }
  Hdf5Edits(const Hdf5Edits&) = delete;
  Hdf5Edits& operator=(const Hdf5Edits&) = delete;

  void edit(const std::uint8_t* six) {
    if (nodes_.empty()) return;
    const std::string& node = nodes_[six[1] % nodes_.size()];
    const std::size_t where = six[2] + 256U * six[3];
    const std::int64_t value = value_of(six[4], six[5]);
    switch (six[0] % 8) {
      case 0:
        H5Ldelete(file_, node.c_str(), H5P_DEFAULT);
        break;
      case 1:
        H5Lmove(file_, node.c_str(), file_, nodes_[where % nodes_.size()].c_str(), H5P_DEFAULT, H5P_DEFAULT);
        break;
      case 2:
        replace(node, where, six[4] % 4, six[5]);
        break;
      case 3:
      case 4:
        edit_attribute(node, where, value, six[5] == 0);
        break;
      default:
        edit_number(node, where, value);
    }
  }

  [[nodiscard]] FuzzBytes image() const {
    H5Fflush(file_, H5F_SCOPE_GLOBAL);
    FuzzBytes out(static_cast<std::size_t>(std::max<ssize_t>(0, H5Fget_file_image(file_, nullptr, 0))));
    H5Fget_file_image(file_, out.data(), out.size());
    return out;
  }

 private:
  static herr_t add_node(hid_t, const char* name, const H5O_info_t*, void* to) {
    if (std::string(name) != ".") static_cast<Hdf5Edits*>(to)->nodes_.emplace_back(name);
    return 0;
  }

  /// Small ones, negative ones, and those at the ends of their types.
  static std::int64_t value_of(std::uint8_t kind, std::uint8_t number) {
    constexpr std::array<std::int64_t, 6> kEnds{INT64_MAX,  INT64_MIN,  INT32_MAX,
                                                1LL << 32U, 1LL << 62U, INT64_MAX / 8};
    if (kind % 4 == 0) return kEnds[number % kEnds.size()];
    return kind % 4 == 1 ? -static_cast<std::int64_t>(number) : number;
  }

  static hid_t type_of(hid_t type) {
    return H5Tget_class(type) == H5T_INTEGER ? H5T_NATIVE_INT64
           : H5Tget_class(type) == H5T_FLOAT ? H5T_NATIVE_DOUBLE
                                             : hid_t{-1};
  }
  static constexpr std::size_t kMost = 1U << 14U;

  template <typename T>
  static void change(std::vector<std::uint64_t>& numbers, std::size_t where, T value) {
    static_assert(sizeof(T) == sizeof(std::uint64_t));
    reinterpret_cast<T*>(numbers.data())[where % numbers.size()] = value;
  }

  void edit_number(const std::string& node, std::size_t where, std::int64_t value) const {
    const hid_t set = H5Dopen2(file_, node.c_str(), H5P_DEFAULT);
    if (set < 0) return;
    const hid_t type = H5Dget_type(set), space = H5Dget_space(set), as = type_of(type);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    if (as >= 0 && count > 0 && static_cast<std::size_t>(count) <= kMost) {
      std::vector<std::uint64_t> numbers(static_cast<std::size_t>(count));
      H5Dread(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
      if (as == H5T_NATIVE_DOUBLE) {
        change(numbers, where, static_cast<double>(value));
      } else {
        change(numbers, where, value);
      }
      H5Dwrite(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
    }
    H5Sclose(space);
    H5Tclose(type);
    H5Dclose(set);
  }

  void edit_attribute(const std::string& node, std::size_t where, std::int64_t value, bool gone) const {
    const hid_t object = H5Oopen(file_, node.c_str(), H5P_DEFAULT);
    if (object < 0) return;
    const int count = H5Aget_num_attrs(object);
    const hid_t attribute =
        count > 0 ? H5Aopen_by_idx(object, ".", H5_INDEX_NAME, H5_ITER_INC,
                                   where % static_cast<hsize_t>(count), H5P_DEFAULT, H5P_DEFAULT)
                  : hid_t{-1};
    if (attribute >= 0) {
      const hid_t type = H5Aget_type(attribute), space = H5Aget_space(attribute), as = type_of(type);
      const hssize_t numbers_there = H5Sget_simple_extent_npoints(space);
      std::array<char, 256> name{};
      H5Aget_name(attribute, name.size(), name.data());
      if (as >= 0 && numbers_there > 0 && static_cast<std::size_t>(numbers_there) <= kMost) {
        std::vector<std::uint64_t> numbers(static_cast<std::size_t>(numbers_there));
        H5Aread(attribute, as, numbers.data());
        if (as == H5T_NATIVE_DOUBLE) {
          change(numbers, where / 16, static_cast<double>(value));
        } else {
          change(numbers, where / 16, value);
        }
        H5Awrite(attribute, as, numbers.data());
      }
      H5Sclose(space);
      H5Tclose(type);
      H5Aclose(attribute);
      if (gone) H5Adelete(object, name.data());
    }
    H5Oclose(object);
  }

  /// Another data set of that name: other counts, another type.
  void replace(const std::string& node, std::size_t where, int rank, std::uint8_t of_type) const {
    const std::array<hid_t, 6> types{H5T_NATIVE_INT64, H5T_NATIVE_DOUBLE, H5T_NATIVE_INT8,
                                     H5T_NATIVE_FLOAT, H5T_NATIVE_UINT16, H5T_C_S1};
    std::array<hsize_t, 4> counts{};
    std::size_t all = 1;
    for (int axis = 0; axis < rank; ++axis) {
      counts[static_cast<std::size_t>(axis)] = where >> (4U * static_cast<unsigned>(axis)) & 15U;
      all *= counts[static_cast<std::size_t>(axis)];
    }
    H5Ldelete(file_, node.c_str(), H5P_DEFAULT);
    const hid_t space = rank > 0 ? H5Screate_simple(rank, counts.data(), nullptr) : H5Screate(H5S_SCALAR);
    const hid_t type = types[of_type % types.size()];
    const hid_t set = H5Dcreate2(file_, node.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (set >= 0) {
      const std::vector<std::uint64_t> numbers(all + 1, of_type < 128 ? 0 : 3);
      H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, numbers.data());
      H5Dclose(set);
    }
    H5Sclose(space);
  }

  hid_t file_ = -1;
  std::vector<std::string> nodes_;
};

/// The template that the first byte names, with the edits of the others.
inline FuzzBytes edited_template(const std::vector<FuzzBytes>& templates, const std::uint8_t* data,
                                 std::size_t size) {
  constexpr std::size_t kEdit = 6, kMostEdits = 24;
  Hdf5Edits edits(templates[size > 0 ? data[0] % templates.size() : 0]);
  for (std::size_t i = 0; i < kMostEdits && 1 + (i + 1) * kEdit <= size; ++i)
    edits.edit(data + 1 + i * kEdit);
  return edits.image();
}

}  // namespace palpate::test
