/// Values of PLOT3D grids beside the five of the manual: function files, and solutions of OVERFLOW.
///
/// Function file: [grids]  dimensions and number of functions of every grid  { every function at all points } of every grid
/// OVERFLOW:      [grids]  dimensions of every grid, NQ, NQC  { conditions, NQ values at all points } of every grid
/// Layouts as in plot3d_layout.h; a function file may be text. Sources: P. P. Walatka et al., PLOT3D User's Manual, NASA
/// TM-101067, 1990, ch. 8; P. G. Buning et al., OVERFLOW user's manual, "Q files".
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/plot3d_layout.h"

namespace palpate {

struct Plot3dValues {
  bool overflow = false;  ///< else functions
  bool big_endian = false, record_marks = false, double_precision = false;
  std::vector<double> text;  ///< all numbers of a text file; empty: binary
  struct Part {
    std::uint64_t first = 0;  ///< of the first value: in bytes, of a text file in numbers
    std::uint64_t points = 0;
    std::uint64_t count = 0;  ///< values at a point, each for all points after the other
  };
  std::vector<Part> parts;  ///< one a grid
};

/// The layout under which the size of `file`, the whole of it, fits the dimensions of `grid`; nothing where none does.
[[nodiscard]] std::optional<Plot3dValues> find_plot3d_values(std::string_view file, const Plot3dLayout& grid);

/// "functions, little endian, double precision, record marks"
[[nodiscard]] std::string describe(const Plot3dValues& values);

/// What the arrays of a grid are called: of OVERFLOW Density, Momentum, StagnationEnergy, Gamma, "value 7" and so on; of
/// functions `names` or "function 1" and so on, and each three that follow one another and are not named also as one
/// vector, "functions 1 to 3": the file does not say which they are.
struct Plot3dArray {
  std::string name;
  std::uint64_t first = 0;  ///< among the values at a point
  int components = 1;
};
[[nodiscard]] std::vector<Plot3dArray> arrays_of(const Plot3dValues& values, std::size_t grid, int axes,
                                                 const std::vector<std::string>& names);

/// The numbers of an array of a grid, in double precision. @param file that `values` was found in.
[[nodiscard]] DataArray read_values(std::string_view file, const Plot3dValues& values, std::size_t grid,
                                    const Plot3dArray& array);

}  // namespace palpate
