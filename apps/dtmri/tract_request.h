/// What the options of tracts mean: seeds, regions and limits.
///
///   region    region_text.h
///   seeds     a region, or fa:T, cl:T: the voxels that it takes the centres of; of a mask its own voxels
///             grid:, random: between the outer centres of an image's voxels
///             peaks: and any of these: from each peak of an image of several directions a voxel
///             whatever parse_seeds() knows that does not depend on a field: file.csv, point:, line:, plane:
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/render/tract/tract_bundle.h"
#include "common/scene/document/document.h"
#include "common/scene/tensor/read_mask.h"
#include "common/trace/tract/trace_tracts.h"

namespace palpate {

/// Limits and regions, and the files of those that are masks.
struct TractRequest {
  TractOptions options;
  std::vector<MaskFile> masks;
};

/// Masks are read. @param left_handed LoadRequest::left_handed, for masks. @throws Error (usage), (bad input) naming a mask; Cancelled.
[[nodiscard]] TractRequest tract_request(const TractTracingOptions& options, bool left_handed, int threads,
                                         Progress* progress = nullptr);

/// Regions as texts have them; files of masks are read into `masks`. @param option the first word of an error.
/// @param left_handed LoadRequest::left_handed. @throws Error (usage), (bad input) naming a mask; Cancelled.
[[nodiscard]] std::vector<TractRegion> read_regions(const std::vector<std::string>& texts,
                                                    const std::string& option, bool left_handed,
                                                    std::vector<MaskFile>& masks, Progress* progress);

/// What the user should know of masks over `image`. @throws Error (bad input) where one lies beside it.
[[nodiscard]] std::vector<std::string> check_regions(const TractRequest& request, const DataSet& image);

/// @param left_handed as tract_request(). @param image that `field` was made of. @param notes as check_regions(), of a mask of seeds; appended.
/// @throws Error (usage) that shows the grammar, (bad input) naming a file; Cancelled.
[[nodiscard]] std::vector<Vec3> tract_seeds(const TractTracingOptions& options, bool left_handed,
                                            std::uint64_t random_seed, const TensorField& field,
                                            const DataSet& image, std::vector<std::string>& notes,
                                            Progress* progress = nullptr);

/// Has lines end, and leaves out seeds, where TractTracingOptions::max_cone says, if it does.
/// @param cones of the voxels of `image` [degrees]; null: its tensors were not fitted. @param notes appended.
/// @throws Error (usage) where no cone is known.
void stop_where_unsure(const TractTracingOptions& options, const UniformTopology& image,
                       const DataArray* cones, TractRequest& request, std::vector<Vec3>& seeds,
                       std::vector<std::string>& notes);

/// Of tracing that gave no line: what became of its seeds and lines, and by which option.
[[nodiscard]] std::string why_no_tract(const TractResult& result, const TractOptions& options);

// Tracts that pictures and windows show: traced from the seeds that options name, or read from a file.

struct ViewTracts {
  std::shared_ptr<const TractBundle> bundle;  ///< not null
  std::size_t seeds = 0;                      ///< none of a file
  double seconds = 0.0;                       ///< that tracing took
  std::string why_none;                       ///< what became of the seeds, where there is no line
  std::string left_out;                       ///< what a picture has no room for; empty: it shows all lines
  std::vector<std::string> notes;             ///< of masks and axes
};

/// Checks what can be checked before anything is read. @throws Error (usage).
void check_view_tracts(const TractTracingOptions& options, const TractAppearance& appearance);

/// The lines of a tractogram. Where they are shown over `field`, a note says if they would fit it better turned:
/// LPS taken for RAS, another image. @param field null: none, or of no image.
/// @throws Error (bad input): not readable, or no line in it; Cancelled.
[[nodiscard]] ViewTracts read_view_tracts(const TractAppearance& appearance, const TensorField* field,
                                          int threads, Progress* progress);

/// Traces through `voxels` as the verb `trace` does. @param cones as stop_where_unsure(). @pre document.tracts.seeds is not empty.
/// @throws Error (usage), (bad input) as tract_options() and tract_seeds(); Cancelled.
[[nodiscard]] ViewTracts trace_view_tracts(const Document& document, const TensorVoxels& voxels,
                                           const DataArray* cones, Progress* progress);

}  // namespace palpate
