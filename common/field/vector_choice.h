/// Which arrays make the vector field: an array of three components, three named components
/// (velocity_x …, VX VY VZ, u v w), or momentum divided by density.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

/// Name and shape of an array, known before its values are read.
struct ArrayInfo {
  std::string name;
  Association association = Association::kPoint;
  int components = 1;
  ScalarType type = ScalarType::kFloat32;
  std::size_t tuples = 0;
  std::uint64_t sparse_bytes =
      0;  ///< about so many where the numbers stand in a tree (DataArray::sparse); 0: no
};

/// A recipe for a vector field.
struct VectorChoice {
  enum class Kind { kArray, kComponents, kMomentumOverDensity };
  Kind kind = Kind::kArray;
  Association association = Association::kPoint;
  std::vector<std::string> arrays;  ///< one; three components; or momentum(s) and then density last
  std::string label;                ///< how it is called: "velocity", "(VX, VY, VZ)", "Momentum / Density"
};

/// Every vector field that can be made, the one to be taken by default first. The rule: names that mean
/// velocity before others, whole arrays before components before momentum over density, points before
/// cells, then file order.
[[nodiscard]] std::vector<VectorChoice> vector_choices(const std::vector<ArrayInfo>& arrays);

/// The choice whose label or array name is `requested` (the default one where it is empty).
/// @throws Error (usage) naming the known ones, or (bad input) where the file holds no vector field.
[[nodiscard]] VectorChoice choose_vector(const std::vector<ArrayInfo>& arrays, std::string_view requested,
                                         const std::string& file);

}  // namespace palpate
