/// Which elements of a heart's mesh are muscle: meshes of openCARP hold bath, blood and torso, too.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/heart/heart.h"

namespace palpate {

/// The array of elements that numbers regions, by its name ("region", "tag", "material", …); empty: none.
[[nodiscard]] std::string region_array(const std::vector<ArrayInfo>& arrays);

/// Whether an array's name says that it holds fibres: "fibre", "Fibers", "f0", …
[[nodiscard]] bool means_fibre(const std::string& name);

/// Hides the cells (DataSet::hidden_cells) of regions whose elements have no fibre, all but one in twenty,
/// where another region has them: openCARP's own sign of what is no tissue. Fibres that are missing here and
/// there within a region leave it as it is. Without the arrays of fibres and regions nothing is hidden.
/// Directions a million times shorter than the others are taken for what they stand for: none.
/// @return what is to be said: which regions, how many elements; a WARNING where many elements have no fibre
/// and no region tells why.
std::vector<std::string> hide_all_but_tissue(DataSet& mesh, const DirectionChoice& fibre);

}  // namespace palpate
