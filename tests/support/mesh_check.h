/// Is a set of tetrahedra a proper mesh? Counts what the eye cannot see.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate::test {

struct MeshCheck {
  std::size_t crowded_faces = 0;  ///< shared by more than two tetrahedra, flat ones not counted
  std::size_t border_faces = 0;   ///< of one tetrahedron
  double border_area = 0.0;
  double volume = 0.0;  ///< sum of |volumes|
  double signed_volume = 0.0;
  std::size_t inverted = 0;  ///< negative volumes
  std::vector<std::array<std::uint32_t, 3>> border;
};

[[nodiscard]] MeshCheck check_mesh(std::span<const Vec3> points,
                                   std::span<const std::array<std::uint32_t, 4>> tets);

/// Volume enclosed by triangles that all turn outwards (divergence theorem).
[[nodiscard]] double enclosed_volume(std::span<const std::array<Vec3, 3>> triangles);

}  // namespace palpate::test
