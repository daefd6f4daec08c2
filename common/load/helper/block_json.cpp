#include "common/load/helper/block_json.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>

#include "common/base/index.h"

namespace palpate::message {
namespace {

/// Components of one array: a tensor has 9, a histogram some hundreds.
constexpr int kMaxComponents = 4096;

constexpr std::array kTypes{
    ScalarType::kInt8,   ScalarType::kUint8, ScalarType::kInt16,  ScalarType::kUint16,  ScalarType::kInt32,
    ScalarType::kUint32, ScalarType::kInt64, ScalarType::kUint64, ScalarType::kFloat32, ScalarType::kFloat64};

/// The number of points of a structured block. Three counts below 2^31 can pass 2^64, so it is checked.
std::uint64_t points_of(const Index3& index, const char* key) {
  std::uint64_t points = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (index[axis] < 1) malformed(std::string("'") + key + "' has an empty axis");
    points *= static_cast<std::uint64_t>(index[axis]);
    if (points > kMaxCount) malformed(std::string("'") + key + "' is too large");
  }
  return points;
}

Json encode_array(const DataArray& array, MemoryFile& memory) {
  Json object =
      encode_array_info({array.name, array.association, array.components, array.type, array.tuples});
  if (array.sparse) {
    object["tree_bytes"] = array.sparse->bytes().size();
    object["points"] = counts_json(array.sparse->points());
    object["shift"] = counts_json(array.sparse->shift());
  }
  object["offset"] = memory.append(array.sparse ? array.sparse->bytes() : array.bytes);
  return object;
}

/// What the blocks of an answer point into.
struct Memory {
  std::span<const std::byte> bytes;
  const std::shared_ptr<const void>& owner;

  /// `count` numbers of `size` bytes at `offset`. count <= 2^46 and size <= 2^15, so no product wraps.
  [[nodiscard]] std::span<const std::byte> at(std::uint64_t offset, std::uint64_t count,
                                              std::uint64_t size) const {
    if (offset % MemoryFile::kAlignment != 0) malformed("an array is not aligned");
    if (offset > bytes.size() || count > (bytes.size() - offset) / size)
      malformed("an array lies outside its memory");
    return bytes.subspan(offset, count * size);
  }

  template <typename T>
  [[nodiscard]] std::vector<T> copy(std::uint64_t offset, std::uint64_t count) const {
    const std::span<const std::byte> source = at(offset, count, sizeof(T));
    std::vector<T> values(count);
    if (count > 0) std::memcpy(values.data(), source.data(), source.size());
    return values;
  }
};

std::shared_ptr<const SparseNumbers> decode_sparse(const Json& object, const Memory& memory) {
  const auto bytes = memory.at(count_at(object, "offset"), count_at(object, "tree_bytes"), 1);
  try {
    return std::make_shared<const SparseNumbers>(bytes, memory.owner, index_at(object, "shift"),
                                                 index_at(object, "points"));
  } catch (const std::invalid_argument& problem) {
    malformed(problem.what());
  }
}

DataArray decode_array(const Json& object, const Memory& memory) {
  ArrayInfo info = decode_array_info(object);
  DataArray array;
  array.name = std::move(info.name);
  array.association = info.association;
  array.components = info.components;
  array.type = info.type;
  array.tuples = info.tuples;
  if (object.contains("tree_bytes")) {
    array.sparse = decode_sparse(object, memory);
    const bool plain = array.components == 1 && array.type == ScalarType::kFloat32 &&
                       array.association == Association::kPoint;
    if (!plain) malformed("a sparse array holds more than one number a point");
    return array;
  }
  array.bytes = memory.at(count_at(object, "offset"), info.tuples,
                          static_cast<std::uint64_t>(info.components) * byte_size(info.type));
  array.owner = memory.owner;
  return array;
}

DataArray decode_positions(const Json& object, const Memory& memory) {
  DataArray positions = decode_array(member(object, "positions"), memory);
  if (positions.sparse) malformed("positions are sparse");
  const bool real = positions.type == ScalarType::kFloat32 || positions.type == ScalarType::kFloat64;
  if (positions.components != 3 || positions.association != Association::kPoint || !real) {
    malformed("positions are not three floats a point");
  }
  return positions;
}

template <typename T>
std::uint64_t append(const std::vector<T>& values, MemoryFile& memory) {
  return memory.append(std::as_bytes(std::span(values)));
}

struct TopologyEncoder {
  MemoryFile& memory;

  Json operator()(const UniformTopology& t) const {
    Json axes = Json::array();
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) axes.push_back(t.axes[c][r]);
    }
    return {{"kind", "uniform"},
            {"points", counts_json(t.points)},
            {"origin", vector_json(t.origin)},
            {"axes", axes}};
  }
  Json operator()(const RectilinearTopology& t) const {
    const auto& [x, y, z] = t.coordinates;
    return {{"kind", "rectilinear"},
            {"counts", {x.size(), y.size(), z.size()}},
            {"x", append(x, memory)},
            {"y", append(y, memory)},
            {"z", append(z, memory)}};
  }
  Json operator()(const StructuredTopology& t) const {
    return {{"kind", "curvilinear"},
            {"points", counts_json(t.points)},
            {"positions", encode_array(t.positions, memory)}};
  }
  Json operator()(const UnstructuredTopology& t) const {
    return {{"kind", "unstructured"},
            {"positions", encode_array(t.positions, memory)},
            {"cells", t.types.size()},
            {"types", append(t.types, memory)},
            {"offsets", append(t.offsets, memory)},
            {"connectivity", append(t.connectivity, memory)},
            {"connectivity_count", t.connectivity.size()}};
  }
};

UniformTopology decode_uniform(const Json& object) {
  UniformTopology t;
  t.points = index_at(object, "points");
  points_of(t.points, "points");
  t.origin = vector_at(object, "origin");
  const Json& axes = array_at(object, "axes", 9);
  std::size_t next = 0;
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) t.axes[c][r] = number_of(axes[next++], "axes");
  }
  return t;
}

RectilinearTopology decode_rectilinear(const Json& object, const Memory& memory) {
  RectilinearTopology t;
  const Index3 counts = index_at(object, "counts");
  points_of(counts, "counts");
  const std::array keys{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = as_size(axis);
    t.coordinates[a] =
        memory.copy<double>(count_at(object, keys[a]), static_cast<std::uint64_t>(counts[axis]));
    const auto& x = t.coordinates[a];
    const bool finite = std::all_of(x.begin(), x.end(), [](double value) { return std::isfinite(value); });
    const bool rise = std::adjacent_find(x.begin(), x.end(), std::greater_equal<>()) == x.end();
    const bool fall = std::adjacent_find(x.begin(), x.end(), std::less_equal<>()) == x.end();
    if (!finite || (!rise && !fall)) malformed("rectilinear coordinates neither rise nor fall");
  }
  return t;
}

StructuredTopology decode_curvilinear(const Json& object, const Memory& memory) {
  StructuredTopology t;
  t.points = index_at(object, "points");
  t.positions = decode_positions(object, memory);
  if (t.positions.tuples != points_of(t.points, "points"))
    malformed("positions do not match the block's points");
  return t;
}

constexpr std::uint8_t kPolyhedron = 42;  // of the VTK file format

/// Checks a polyhedron's face stream: face count, then for each face its point count and points.
void check_faces(std::span<const std::int64_t> stream, std::int64_t points) {
  std::size_t at = 0;
  const auto take = [&] {
    if (at >= stream.size()) malformed("a polyhedron's faces are cut off");
    return stream[at++];
  };
  const std::int64_t faces = take();
  if (faces < 0 || static_cast<std::uint64_t>(faces) > stream.size()) malformed("a polyhedron's face count");
  for (std::int64_t face = 0; face < faces; ++face) {
    const std::int64_t corners = take();
    if (corners < 0 || static_cast<std::uint64_t>(corners) > stream.size() - at)
      malformed("a polyhedron's face");
    for (std::int64_t corner = 0; corner < corners; ++corner) {
      const std::int64_t point = take();
      if (point < 0 || point >= points) malformed("a polyhedron names a point that is not there");
    }
  }
  if (at != stream.size()) malformed("a polyhedron's faces are followed by something else");
}

UnstructuredTopology decode_unstructured(const Json& object, const Memory& memory) {
  UnstructuredTopology t;
  t.positions = decode_positions(object, memory);
  const std::uint64_t cells = count_at(object, "cells");
  t.types = memory.copy<std::uint8_t>(count_at(object, "types"), cells);
  t.offsets = memory.copy<std::int64_t>(count_at(object, "offsets"), cells + 1);
  t.connectivity =
      memory.copy<std::int64_t>(count_at(object, "connectivity"), count_at(object, "connectivity_count"));
  if (t.offsets.front() != 0 || t.offsets.back() != static_cast<std::int64_t>(t.connectivity.size()) ||
      !std::is_sorted(t.offsets.begin(), t.offsets.end())) {
    malformed("cell offsets do not increase from 0 to the end of the connectivity");
  }
  const auto points = static_cast<std::int64_t>(t.positions.tuples);
  for (std::size_t cell = 0; cell < t.types.size(); ++cell) {
    const auto first = as_size(t.offsets[cell]);
    const auto last = as_size(t.offsets[cell + 1]);
    const std::span<const std::int64_t> corners =
        std::span<const std::int64_t>(t.connectivity).subspan(first, last - first);
    if (t.types[cell] == kPolyhedron) {
      check_faces(corners, points);
    } else if (std::any_of(corners.begin(), corners.end(),
                           [points](std::int64_t point) { return point < 0 || point >= points; })) {
      malformed("cell " + std::to_string(cell) + " names a point that is not there");
    }
  }
  return t;
}

/// Counts worked out here rather than by DataSet, whose methods expect checked blocks.
struct Counts {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
};

Counts structured_counts(const Index3& n) {
  Counts counts{1, 1};
  for (int axis = 0; axis < 3; ++axis) {
    counts.points *= static_cast<std::uint64_t>(n[axis]);
    counts.cells *= static_cast<std::uint64_t>(std::max(1, n[axis] - 1));
  }
  return counts;
}

struct TopologyCounts {
  Counts operator()(const UniformTopology& t) const { return structured_counts(t.points); }
  Counts operator()(const RectilinearTopology& t) const {
    return structured_counts({static_cast<int>(t.coordinates[0].size()),
                              static_cast<int>(t.coordinates[1].size()),
                              static_cast<int>(t.coordinates[2].size())});
  }
  Counts operator()(const StructuredTopology& t) const { return structured_counts(t.points); }
  Counts operator()(const UnstructuredTopology& t) const { return {t.positions.tuples, t.types.size()}; }
};

}  // namespace

ScalarType scalar_type_at(const Json& object) {
  const std::string name = string_at(object, "type");
  for (const ScalarType type : kTypes) {
    if (name == name_of(type)) return type;
  }
  malformed("unknown number type '" + name + "'");
}

Json encode_array_info(const ArrayInfo& info) {
  return {{"name", text_from_bytes(info.name)},
          {"on", info.association == Association::kPoint ? "point" : "cell"},
          {"components", info.components},
          {"type", name_of(info.type)},
          {"tuples", info.tuples},
          {"sparse_bytes", info.sparse_bytes}};
}

ArrayInfo decode_array_info(const Json& object) {
  ArrayInfo info;
  info.name = string_at(object, "name");
  const std::string on = string_at(object, "on");
  if (on != "point" && on != "cell") malformed("'on' is neither point nor cell");
  info.association = on == "point" ? Association::kPoint : Association::kCell;
  const std::uint64_t components = count_at(object, "components");
  if (components < 1 || components > kMaxComponents)
    malformed("array '" + info.name + "' has no sensible components");
  info.components = static_cast<int>(components);
  info.type = scalar_type_at(object);
  info.tuples = count_at(object, "tuples");
  info.sparse_bytes = count_at(object, "sparse_bytes");
  return info;
}

Json encode_block(const DataSet& block, MemoryFile& memory) {
  Json arrays = Json::array();
  for (const DataArray& array : block.arrays) arrays.push_back(encode_array(array, memory));
  Json object{{"name", text_from_bytes(block.name)},
              {"topology", std::visit(TopologyEncoder{memory}, block.topology)},
              {"arrays", std::move(arrays)}};
  if (!block.visible.empty()) object["visible"] = append(block.visible, memory);
  if (!block.hidden_cells.empty()) object["hidden_cells"] = append(block.hidden_cells, memory);
  return object;
}

DataSet decode_block(const Json& object, std::span<const std::byte> bytes,
                     const std::shared_ptr<const void>& owner) {
  const Memory memory{bytes, owner};
  DataSet block;
  block.name = string_at(object, "name");
  const Json& topology = member(object, "topology");
  const std::string kind = string_at(topology, "kind");
  if (kind == "uniform") {
    block.topology = decode_uniform(topology);
  } else if (kind == "rectilinear") {
    block.topology = decode_rectilinear(topology, memory);
  } else if (kind == "curvilinear") {
    block.topology = decode_curvilinear(topology, memory);
  } else if (kind == "unstructured") {
    block.topology = decode_unstructured(topology, memory);
  } else {
    malformed("unknown topology '" + kind + "'");
  }
  const Counts counts = std::visit(TopologyCounts{}, block.topology);
  for (const Json& value : array_at(object, "arrays")) {
    DataArray array = decode_array(value, memory);
    if (array.tuples != (array.association == Association::kPoint ? counts.points : counts.cells)) {
      malformed("array '" + array.name + "' has " + std::to_string(array.tuples) + " tuples for " +
                std::to_string(counts.points) + " points and " + std::to_string(counts.cells) + " cells");
    }
    if (array.sparse) {
      const auto* uniform = std::get_if<UniformTopology>(&block.topology);
      if (uniform == nullptr || uniform->points != array.sparse->points())
        malformed("sparse array '" + array.name + "' lies on another grid");
    }
    block.arrays.push_back(std::move(array));
  }
  if (object.contains("visible")) {
    block.visible = memory.copy<std::uint8_t>(count_at(object, "visible"), counts.points);
  }
  if (object.contains("hidden_cells")) {
    block.hidden_cells = memory.copy<std::uint8_t>(count_at(object, "hidden_cells"), counts.cells);
  }
  return block;
}

}  // namespace palpate::message
