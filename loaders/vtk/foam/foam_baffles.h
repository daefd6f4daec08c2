/// Baffles of OpenFOAM's meshes: pairs of boundary faces of the same points, between two cells that share these points
/// and yet no face. A mesh of cells alone, such as VTK's, has a way through there.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "loaders/vtk/foam/foam_boundary.h"

namespace palpate {

class FoamBaffles {
 public:
  FoamBaffles() = default;
  /// Gives points on baffles a copy for each of the groups of cells around them that hang together by other faces; on
  /// the rim of a baffle there is one group, and the point stays one.
  /// What is cyclic lets the flow through (fans, porous baffles).
  /// @param faces all of the mesh. @param owner,neighbour as the files have them. @param points of the mesh.
  /// @pre owners are not negative, neighbours at least -1 (none).
  FoamBaffles(const FoamFaces& faces, std::span<const FoamPatch> patches, std::span<const std::int64_t> owner,
              std::span<const std::int64_t> neighbour, std::size_t points);

  /// Whether there are baffles. @param border the faces from `first` on.
  [[nodiscard]] static bool any(const FoamFaces& border, std::size_t first,
                                std::span<const FoamPatch> patches);

  [[nodiscard]] bool empty() const noexcept { return copies_.empty(); }
  /// How many points there are with the copies.
  [[nodiscard]] std::size_t points() const noexcept { return first_copy_ + copies_.size(); }
  /// The point that a cell has for one of the mesh.
  [[nodiscard]] std::int64_t point_of(std::int64_t cell, std::int64_t point) const;
  /// Puts the copies into a block of that mesh. False where it has other cells or points: it stays as it is.
  [[nodiscard]] bool split(DataSet& block) const;

 private:
  std::size_t first_copy_ = 0, cells_ = 0;
  std::vector<std::int64_t> copies_;                                        ///< of which points
  std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> point_of_;  ///< by cell and point
};

}  // namespace palpate
