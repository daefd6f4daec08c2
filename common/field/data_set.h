/// Data as a loader hands it over: topology and named arrays, in the data's own units and types.
///
/// A DataSet is immutable and shares the memory of its arrays (mapped from a loader's helper program).
/// Fields (vector_field.h) are made from it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/field/grid/sparse/sparse_numbers.h"
#include "common/math/vec.h"

namespace palpate {

enum class ScalarType : std::uint8_t {
  kInt8,
  kUint8,
  kInt16,
  kUint16,
  kInt32,
  kUint32,
  kInt64,
  kUint64,
  kFloat32,
  kFloat64
};
[[nodiscard]] std::size_t byte_size(ScalarType type) noexcept;
/// Whether single precision would lose digits.
[[nodiscard]] constexpr bool needs_double(ScalarType type) noexcept {
  return type == ScalarType::kFloat64 || type == ScalarType::kInt64 || type == ScalarType::kUint64 ||
         type == ScalarType::kInt32 || type == ScalarType::kUint32;
}
[[nodiscard]] const char* name_of(ScalarType type) noexcept;  ///< "float32"

/// What the tuples of an array belong to.
enum class Association : std::uint8_t { kPoint, kCell };

/// A named array of `tuples` tuples of `components` numbers, tuple by tuple, native byte order, aligned
/// to the number's size; or, where most are alike, as a tree.
struct DataArray {
  std::string name;
  Association association = Association::kPoint;
  int components = 1;
  ScalarType type = ScalarType::kFloat32;
  std::size_t tuples = 0;
  std::span<const std::byte> bytes;   ///< tuples * components * byte_size(type)
  std::shared_ptr<const void> owner;  ///< keeps `bytes` alive
  /// Where not null the numbers stand here, `bytes` are none: one of single precision for each point of a
  /// uniform block.
  std::shared_ptr<const SparseNumbers> sparse;

  /// Of memory that the numbers take.
  [[nodiscard]] std::uint64_t stored_bytes() const noexcept {
    return sparse ? sparse->bytes().size() : bytes.size();
  }
  /// @pre tuple < tuples, component < components.
  [[nodiscard]] double at(std::size_t tuple, int component = 0) const noexcept;
};

/// Makes an array that owns a copy of `values`.
[[nodiscard]] DataArray make_array(std::string name, Association association, int components,
                                   std::span<const float> values);
[[nodiscard]] DataArray make_array(std::string name, Association association, int components,
                                   std::span<const double> values);

/// Points at origin + axes * (i, j, k); point index i + n_x (j + n_y k). The columns of `axes` are the
/// steps from one point to the next along i, j and k.
struct UniformTopology {
  Index3 points{0};
  Vec3 origin{0.0};
  Mat3 axes{1.0};
};

/// Points at (x[i], y[j], z[k]), each strictly rising or falling; same point order.
struct RectilinearTopology {
  std::array<std::vector<double>, 3> coordinates;
};

/// A curvilinear block: `points.x * points.y * points.z` positions, same point order.
struct StructuredTopology {
  Index3 points{0};
  DataArray positions;  ///< 3 components
};

/// Any mix of cells. Cell types are the numbers of the VTK file format (10 tetrahedron, 12 hexahedron,
/// 13 wedge, 14 pyramid, 11 voxel, 24 quadratic tetrahedron, 42 polyhedron, …). Cell c has the points
/// connectivity[offsets[c]] to connectivity[offsets[c + 1] - 1]; a polyhedron has its face stream there:
/// face count, then for each face its point count and points.
struct UnstructuredTopology {
  DataArray positions;                ///< 3 components
  std::vector<std::uint8_t> types;    ///< one a cell
  std::vector<std::int64_t> offsets;  ///< cells + 1
  std::vector<std::int64_t> connectivity;
};

/// One block of a data set.
struct DataSet {
  std::string name;  ///< block name, may be empty
  std::variant<UniformTopology, RectilinearTopology, StructuredTopology, UnstructuredTopology> topology;
  std::vector<DataArray> arrays;
  /// Where not empty: one byte a point, 0 where the point is blanked (PLOT3D iblank, VTK ghost points).
  std::vector<std::uint8_t> visible;
  /// Where not empty: one byte a cell, 1 where nothing is (VTK hidden cells), whatever its points hold.
  std::vector<std::uint8_t> hidden_cells;

  [[nodiscard]] std::size_t point_count() const noexcept;
  [[nodiscard]] std::size_t cell_count() const noexcept;
  /// The array of that name and association, or null.
  [[nodiscard]] const DataArray* find(std::string_view array, Association association) const noexcept;
};

}  // namespace palpate
