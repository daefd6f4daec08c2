/// Writing meshes for Chaste and TetGen: STEM.node and STEM.ele, numbered from 0, with the regions of elements as their
/// attribute; STEM.ortho (fibre, sheet, normal) or STEM.axi (fibres alone) for Chaste. Formats: Chaste's "Cardiac mesh
/// files", TetGen's manual.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/math/vec.h"

namespace palpate {

/// What is written beside points and tetrahedra: of each element, or none.
struct TetgenElements {
  std::span<const int> regions = {};
  std::span<const Vec3> fibres =
      {};  ///< of any length; zero or not finite: written as zeros, which mean no direction
  std::span<const Vec3> sheets = {};  ///< likewise; turned to be perpendicular to the fibre
};

/// @param ele STEM.ele. @return the files.
/// @throws Error as OutputFile does; (usage) where files of STEM lie there that would be taken for a part of this mesh.
std::vector<std::filesystem::path> write_tetgen(const std::filesystem::path& ele,
                                                std::span<const Vec3> points,
                                                std::span<const TetMesh::Tet> tets,
                                                const TetgenElements& elements, bool overwrite);

}  // namespace palpate
