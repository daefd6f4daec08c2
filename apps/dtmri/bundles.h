/// The bundles of a document, made: traced, read, edited, measured, and put together for the picture.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "apps/dtmri/bundle_text.h"
#include "common/base/progress.h"
#include "common/compose/bundle_view.h"
#include "common/field/data_set.h"
#include "common/render/slice/slice_view.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/render/tract/tract_bundle.h"
#include "common/scene/document/document.h"

namespace palpate {

/// What bundles are made in.
struct BundleGround {
  const Document& document;           ///< bundles are taken from it, and how its image is read
  const TensorVoxels& voxels;         ///< their image; without a field nothing can be traced
  const DataArray* cones = nullptr;   ///< as trace_view_tracts()
  const BundleSet* before = nullptr;  ///< of the same image, read in the same way; null: none
  Progress* progress = nullptr;
};

/// The image that lines lie in where there is no other: that of their file, or voxels of 1 mm and more about them.
/// @pre a point is finite.
[[nodiscard]] std::shared_ptr<const TensorVoxels> lattice_of_lines(const Tractogram& lines);

/// The lines of one bundle. What its files and traces gave is taken from `set.sources`, and kept there.
/// @param notes get what was left out, said of the bundle's name. @throws Error as tracing and reading; Cancelled.
[[nodiscard]] std::shared_ptr<const Tractogram> make_bundle_lines(const BundleText& bundle,
                                                                  const BundleGround& ground, BundleSet& set,
                                                                  std::vector<std::string>& notes);

/// All bundles of the document; null where it has none. What is the same as in `ground.before` is taken from there.
/// @param images that profiles may be of, by name. @param notes as above; appended.
[[nodiscard]] std::shared_ptr<const BundleSet> make_bundles(const BundleGround& ground,
                                                            const std::vector<SliceImage>& images,
                                                            std::vector<std::string>& notes);

/// `tracts`, which may be null, and all shown bundles in their colours, as one for the picture; null: nothing is there.
/// @param images that colours may stand for, by name. @param notes get what has no such colour.
[[nodiscard]] std::shared_ptr<const TractBundle> drawn_together(
    const std::shared_ptr<const TractBundle>& tracts, const BundleSet& set,
    const std::vector<SliceImage>& images, std::vector<std::string>& notes);

}  // namespace palpate
