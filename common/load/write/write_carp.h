/// Writing meshes and results for openCARP: STEM.pts (micrometres), STEM.elem and, of meshes with fibres, STEM.lon, results as
/// STEM.NAME.dat and STEM.NAME.igb. Formats: openCARP user's manual, "Mesh files" and "IGB files".
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"

namespace palpate {

/// Times as a .igb file states them: evenly apart.
struct IgbTimes {
  double first = 0.0, apart = 1.0;
  std::size_t count = 1;
  std::string unit{};  ///< empty: not known
};

/// @throws Error (bad input) with `file` where they are not rising and evenly apart to a thousandth.
[[nodiscard]] IgbTimes igb_times(const std::vector<double>& times, const std::string& file);

/// Whether all cells are of kinds that .elem has: lines, triangles, quadrilaterals, tetrahedra, pyramids,
/// prisms, hexahedra.
[[nodiscard]] bool all_in_carp(const UnstructuredTopology& cells);

/// Tetrahedra as cells.
[[nodiscard]] UnstructuredTopology cells_of(std::span<const Vec3> points, std::span<const TetMesh::Tet> tets);

/// Regions of cells as .elem takes them.
struct CarpRegions {
  std::vector<int> numbers;
  std::string note;  ///< what became of them; empty: they stay as they are
};
/// Whole numbers of 32 bits stay. Where others are among them, all are numbered from 1 by rising value; what is not
/// finite is 0. @param name of the array, for the note.
[[nodiscard]] CarpRegions carp_regions(std::span<const double> values, const std::string& name);

/// What belongs to inputs of openCARP, beside those that are named: keep_from_outputs().
void keep_carp_inputs(std::span<const std::filesystem::path> files);

/// A set of files; none of them is there under its name before finish().
class CarpOutput {
 public:
  /// @param pts STEM.pts. @param directions whether write_directions() follows: there is no .lon otherwise.
  /// @throws Error as OutputFile does; (usage) where there are no directions and a STEM.lon of another mesh, which
  /// would be taken for this one's.
  CarpOutput(std::filesystem::path pts, bool overwrite, bool directions = true);
  ~CarpOutput();

  /// @param micrometres of a unit of its positions. @param regions one a cell, or none: 1 for all.
  /// @pre all_in_carp(mesh).
  void write_mesh(const UnstructuredTopology& mesh, double micrometres, std::span<const int> regions);
  /// One a cell, of any length; zero or not finite: written as zeros, which mean no direction.
  /// @param sheets as many, or none.
  void write_directions(std::span<const Vec3> fibres, std::span<const Vec3> sheets);
  /// STEM.NAME.dat: numbers of points or of cells. What no file name can hold of NAME becomes '_', and a name
  /// that is taken gets a number.
  void write_values(const std::string& name, std::span<const double> values);
  /// STEM.NAME.igb, whose steps follow by write_step() in their order.
  /// @param tuples points or cells. @param components 1 to 4. @param unit of values; empty: not known. @return its number.
  std::size_t begin_series(const std::string& name, std::size_t tuples, int components, const IgbTimes& times,
                           const std::string& unit = {});
  void write_step(std::size_t series, std::span<const double> values);

  void finish();
  [[nodiscard]] const std::vector<std::filesystem::path>& files() const noexcept { return names_; }

 private:
  class Files;
  [[nodiscard]] std::filesystem::path result(const std::string& name, const char* ending) const;
  std::filesystem::path pts_;
  std::vector<std::filesystem::path> names_;
  std::unique_ptr<Files> files_;
};

}  // namespace palpate
