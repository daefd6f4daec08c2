/// Which elements of a heart's mesh are muscle: meshes of openCARP hold bath, blood and torso, too.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/heart/heart.h"

namespace palpate {

/// The array of elements that numbers regions, by its name ("region", "tag", "material", …); empty: none.
[[nodiscard]] std::string region_array(const std::vector<ArrayInfo>& arrays);

/// Whether an array's name says that it holds fibres: "fibre", "Fibers", "f0", …
[[nodiscard]] bool means_fibre(const std::string& name);

/// What a direction must be as long as, to be one: a millionth of the length that 95 % of `lengths` do not
/// surpass, since files write 1e-12 or so where there is none. Lengths of zero, infinity and NaN do not count;
/// 0 where all are so.
[[nodiscard]] double least_direction_length(std::span<const double> lengths);

struct Tissue {
  /// What is to be said: which regions are hidden, how many elements; a WARNING where many elements have no fibre and no
  /// region tells why, and where all of a region have one direction, while others turn.
  std::vector<std::string> notes;
  std::vector<double> left_out;  ///< regions without fibres, by rising number
};

/// Hides the cells (DataSet::hidden_cells) of regions whose elements have no fibre, all but one in twenty,
/// where another region has them: openCARP's own sign of what is no tissue. Fibres that are missing here and
/// there within a region leave it as it is. Without the arrays of fibres and regions nothing is hidden.
/// Directions shorter than least_direction_length() are taken for what they stand for: none.
Tissue hide_all_but_tissue(DataSet& mesh, const DirectionChoice& fibre);

}  // namespace palpate
