/// What OpenFOAM's fields are on the patches of the boundary, which VTK's reader does not tell from what it copies
/// from the cells.
///
/// A face has the values listed for its patch: those of patches of fixed value (fixedValue and its kin, noSlip,
/// movingWallVelocity), and those listed face by face for any other type but zeroGradient and the constraints (empty,
/// wedge, cyclic, processor). Of slip and symmetry it is known that nothing of a vector goes through. A patch without an
/// entry is what its constraint in the mesh says. OpenFOAM User Guide, "Boundaries" and "Mesh description".
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "loaders/vtk/foam/foam_scope.h"

namespace palpate {

/// A patch of a mesh, from polyMesh/boundary.
struct FoamPatch {
  std::string name;
  std::vector<std::string> groups;
  std::size_t faces = 0;
  std::size_t first_face = 0;
  std::string type = {};
};

/// The numbers of a patch: one tuple, or one a face.
struct FoamPatchValues {
  std::vector<double> numbers;
  bool uniform = false;
  bool slides = false;  ///< no numbers: nothing of a vector goes through (slip, symmetry)
};

/// What the text of an entry says of values, "uniform …" or "nonuniform List<…> …". $name stands for what `scope` says.
/// @throws FoamMalformed.
[[nodiscard]] FoamPatchValues read_foam_values(std::string_view text, const FoamStorage& storage,
                                               const FoamScope& scope, std::size_t components);

/// The patches of a file polyMesh/boundary. @throws Error (bad input) with `file`.
[[nodiscard]] std::vector<FoamPatch> read_foam_patches(std::string_view text, const std::string& file);

/// The points of the faces from `first` on, from a file polyMesh/faces (text or binary): those of face first + i stand
/// from begin[i] to begin[i + 1].
struct FoamFaces {
  std::vector<std::size_t> begin{0};
  std::vector<std::int64_t> points;
};
/// @throws Error (bad input) with `file`.
[[nodiscard]] FoamFaces read_foam_faces(std::string_view text, std::size_t first, const std::string& file);

/// A file of numbers of cells (owner, neighbour; text or binary). @throws Error (bad input) with `file`.
[[nodiscard]] std::vector<std::int64_t> read_foam_labels(std::string_view text, const std::string& file);

/// The values given for patches in the boundaryField of a field of `components` numbers, by patch. An entry of a
/// patch's own name goes before those of its groups, and these before patterns; of several the last counts.
/// $name stands for what it does in the file and those it includes.
/// @param problems in words: what could not be read, whose patches have no values.
[[nodiscard]] std::map<std::string, FoamPatchValues> read_foam_boundary(std::string_view text, int components,
                                                                        const std::vector<FoamPatch>& patches,
                                                                        std::vector<std::string>& problems,
                                                                        const FoamInclude& include = {});

/// The number of things in a file of the mesh, which stands before them. @throws Error (bad input) with `file`.
[[nodiscard]] std::size_t read_foam_count(std::string_view text, const std::string& file);

}  // namespace palpate
