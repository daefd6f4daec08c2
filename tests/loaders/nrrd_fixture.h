/// Small NRRD files written by hand, read through the helper program.
#pragma once

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <string>
#include <vector>

#include "common/load/load.h"

namespace palpate::test {

template <typename T>
std::string raw(const std::vector<T>& values) {
  std::string bytes(values.size() * sizeof(T), '\0');
  std::memcpy(bytes.data(), values.data(), bytes.size());
  return bytes;
}

inline std::vector<float> counting(std::size_t count) {
  std::vector<float> values(count);
  for (std::size_t i = 0; i < count; ++i) values[i] = static_cast<float>(i);
  return values;
}

inline const std::string kScalarHead = "NRRD0004\ntype: float\ndimension: 3\nsizes: 2 3 4\nendian: little\n";

inline std::vector<DataSet> read_all(const std::filesystem::path& file) {
  Source source = Source::open({{file}, {}});
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  return source.read(names);
}

}  // namespace palpate::test
