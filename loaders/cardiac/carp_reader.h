/// Meshes of openCARP: .pts, .elem and .lon, as text or as numbers (carp_binary.h); which results go with them.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct CarpFiles {
  std::string pts;
  std::string elem;
  std::string lon;                    ///< may be empty
  std::vector<std::string> results;   ///< .igb and .dat (carp_results.h)
  std::vector<std::string> surfaces;  ///< .surf and .vtx (carp_surfaces.h)
};

/// The set that `named` belongs to: files with the same stem beside it, unless they are named themselves; text beside
/// text and numbers beside numbers, where both are there.
/// @throws Error (bad input) where points or elements are missing, or two files play one part.
[[nodiscard]] CarpFiles find_carp_files(const std::vector<std::string>& named);

/// Elements of any of openCARP's types; the region becomes the cell array "region", directions the cell
/// arrays "fibre" and, of orthotropic meshes, "sheet" and "normal", unless all are zero. Coordinates are turned from micrometres
/// into mm. Files of surfaces become the point array "surface".
/// @param notes gets what is to be said.
/// @throws Error (bad input) naming file and line.
[[nodiscard]] DataSet read_carp(const CarpFiles& files, std::vector<std::string>& notes);

}  // namespace palpate
