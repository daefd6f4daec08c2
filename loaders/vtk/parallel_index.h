/// VTK's index files of pieces (.pvti .pvtr .pvts .pvtu .pvtp): which files hold the pieces, and whether
/// these can be what the index claims.
///
/// File format: "VTK File Formats for VTK Version 4.2", "Parallel File Formats".
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loaders/vtk/xml_scan.h"

namespace palpate {

struct ParallelPiece {
  std::filesystem::path file;
  std::string extent;  ///< structured kinds
};

struct ParallelIndex {
  std::string data_type;  ///< "PUnstructuredGrid"
  std::string whole_extent;
  std::vector<XmlArray> arrays;
  std::vector<ParallelPiece> pieces;

  /// Structured pieces make one grid; others are blocks of their own.
  [[nodiscard]] bool structured() const noexcept;
};

/// Reads the index alone. Relative names start from its folder. @throws Error (bad input).
[[nodiscard]] ParallelIndex read_parallel_index(const std::string& file);

/// Checks every piece of a structured index as scan_xml() does, and that together they can fill the whole
/// extent with the arrays of the index: VTK allocates these before it reads the first piece.
/// @return what the index says of the grid and its arrays. @throws Error (bad input).
[[nodiscard]] XmlScan check_parallel(const std::string& file, const ParallelIndex& index);

}  // namespace palpate
