/// The verbs of diffusion tensors.
#pragma once

#include <vector>

#include "common/cli/explorer.h"

namespace palpate {

/// Tracts, written as a file.
[[nodiscard]] Verb trace_tracts_verb(std::vector<UsageExample> examples);
/// A picture.
[[nodiscard]] Verb tensor_render_verb(std::vector<UsageExample> examples);
/// Slices side by side: what a window shows in panes, in a picture.
[[nodiscard]] Verb tensor_slice_verb(std::vector<UsageExample> examples);
/// Fits tensors to diffusion-weighted volumes and writes them: `fit DWI --out tensor.nii.gz`.
[[nodiscard]] Verb fit_verb(std::vector<UsageExample> examples);
/// Writes images of what tensors measure: `measure FILE --measure fa --out fa.nii.gz`.
[[nodiscard]] Verb measure_verb(std::vector<UsageExample> examples);
/// Compares tracts of any program with an image, turns them on request and writes them:
/// `tracts IMAGE --tracts tracts.trk --turn=-x,-y,z --out turned.tck`.
[[nodiscard]] Verb tracts_verb(std::vector<UsageExample> examples);
/// The window.
[[nodiscard]] Verb open_tensors_verb(std::vector<UsageExample> examples);

}  // namespace palpate
