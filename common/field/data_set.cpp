#include "common/field/data_set.h"

#include <algorithm>
#include <cstring>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/base/read_as.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

template <typename T>
DataArray copy_array(std::string name, Association association, int components, ScalarType type,
                     std::span<const T> values) {
  PALPATE_CHECK(components > 0 && values.size() % as_size(components) == 0);
  auto storage = std::make_shared<std::vector<T>>(values.begin(), values.end());
  DataArray array;
  array.name = std::move(name);
  array.association = association;
  array.components = components;
  array.type = type;
  array.tuples = values.size() / as_size(components);
  array.bytes = std::as_bytes(std::span<const T>(*storage));
  array.owner = std::move(storage);
  return array;
}

/// A structured block of one point along an axis has cells of a lower dimension, as in VTK.
std::size_t structured_cells(const Index3& n) noexcept {
  if (count_of(n) == 0) return 0;
  return count_of(glm::max(n - 1, Index3{1}));
}

Index3 points_of(const RectilinearTopology& grid) noexcept {
  return {static_cast<int>(grid.coordinates[0].size()), static_cast<int>(grid.coordinates[1].size()),
          static_cast<int>(grid.coordinates[2].size())};
}

struct PointCount {
  std::size_t operator()(const UniformTopology& t) const noexcept { return count_of(t.points); }
  std::size_t operator()(const RectilinearTopology& t) const noexcept { return count_of(points_of(t)); }
  std::size_t operator()(const StructuredTopology& t) const noexcept { return count_of(t.points); }
  std::size_t operator()(const UnstructuredTopology& t) const noexcept { return t.positions.tuples; }
};

struct CellCount {
  std::size_t operator()(const UniformTopology& t) const noexcept { return structured_cells(t.points); }
  std::size_t operator()(const RectilinearTopology& t) const noexcept {
    return structured_cells(points_of(t));
  }
  std::size_t operator()(const StructuredTopology& t) const noexcept { return structured_cells(t.points); }
  std::size_t operator()(const UnstructuredTopology& t) const noexcept { return t.types.size(); }
};

}  // namespace

std::size_t byte_size(ScalarType type) noexcept {
  switch (type) {
    case ScalarType::kInt8:
    case ScalarType::kUint8:
      return 1;
    case ScalarType::kInt16:
    case ScalarType::kUint16:
      return 2;
    case ScalarType::kInt32:
    case ScalarType::kUint32:
    case ScalarType::kFloat32:
      return 4;
    case ScalarType::kInt64:
    case ScalarType::kUint64:
    case ScalarType::kFloat64:
      return 8;
  }
  return 0;
}

const char* name_of(ScalarType type) noexcept {
  static constexpr std::array<const char*, 10> kNames{"int8",   "uint8", "int16",  "uint16",  "int32",
                                                      "uint32", "int64", "uint64", "float32", "float64"};
  const auto index = as_size(type);
  return index < kNames.size() ? kNames[index] : "unknown";
}

double DataArray::at(std::size_t tuple, int component) const noexcept {
  PALPATE_ASSERT(tuple < tuples && component >= 0 && component < components);
  if (sparse) return static_cast<double>((*sparse)[tuple]);
  const std::size_t index = tuple * as_size(components) + as_size(component);
  switch (type) {
    case ScalarType::kInt8:
      return static_cast<double>(read_as<std::int8_t>(bytes, index));
    case ScalarType::kUint8:
      return static_cast<double>(read_as<std::uint8_t>(bytes, index));
    case ScalarType::kInt16:
      return static_cast<double>(read_as<std::int16_t>(bytes, index));
    case ScalarType::kUint16:
      return static_cast<double>(read_as<std::uint16_t>(bytes, index));
    case ScalarType::kInt32:
      return static_cast<double>(read_as<std::int32_t>(bytes, index));
    case ScalarType::kUint32:
      return static_cast<double>(read_as<std::uint32_t>(bytes, index));
    case ScalarType::kInt64:
      return static_cast<double>(read_as<std::int64_t>(bytes, index));
    case ScalarType::kUint64:
      return static_cast<double>(read_as<std::uint64_t>(bytes, index));
    case ScalarType::kFloat32:
      return static_cast<double>(read_as<float>(bytes, index));
    case ScalarType::kFloat64:
      return read_as<double>(bytes, index);
  }
  return 0.0;
}

DataArray make_array(std::string name, Association association, int components,
                     std::span<const float> values) {
  return copy_array(std::move(name), association, components, ScalarType::kFloat32, values);
}

DataArray make_array(std::string name, Association association, int components,
                     std::span<const double> values) {
  return copy_array(std::move(name), association, components, ScalarType::kFloat64, values);
}

std::size_t DataSet::point_count() const noexcept { return std::visit(PointCount{}, topology); }
std::size_t DataSet::cell_count() const noexcept { return std::visit(CellCount{}, topology); }

const DataArray* DataSet::find(std::string_view array, Association association) const noexcept {
  const auto found = std::ranges::find_if(
      arrays, [&](const DataArray& a) { return a.association == association && a.name == array; });
  return found == arrays.end() ? nullptr : &*found;
}

}  // namespace palpate
