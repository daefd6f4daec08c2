/// A scalar of a flow as a volume, around its lines: what `--volume` and `--resample` mean.
///
/// `--volume NAME,...` names scalars of the flow, the first one to be seen, the others for lenses
/// (volume_fields.h): the speed, a measure of the velocity gradient (measure_of()), or a scalar of the file.
/// An array on an image is drawn from its own voxels, what is derived from values at the image's own points.
/// Any other grid, and a formula, is resampled where `--resample N` or N,N,N asks for it: at N points along
/// the longest edge of its box, or so many an axis.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/compose/taken_scalar.h"
#include "common/compose/volume_scene.h"
#include "common/field/scalar_lattice.h"
#include "common/field/vector_field.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"

namespace palpate {

/// What `--volume` can name of `input`.
[[nodiscard]] std::vector<std::string> flow_scalars(const Input& input);

/// Whether the scalars of `field` are drawn as a volume only where they are resampled.
[[nodiscard]] bool needs_resampling(const VectorField& field);

/// The names of `--volume` and then those of lenses, each once; none where there is no volume.
/// @throws Error (usage) for a name that is neither a scalar of the input nor a file, and for more than a
/// picture can have.
[[nodiscard]] std::vector<std::string> flow_volume_names(const Input& input, const VolumeOptions& options);
/// Those of the arrays of the file among them.
[[nodiscard]] std::vector<std::string> flow_volume_arrays(const Input& input, const VolumeOptions& options);

/// Checks what can be checked before anything is read: also that nothing is said of a volume that is not
/// there. @throws Error (usage).
void check_flow_volume(const VolumeOptions& options);

/// A scalar of the flow at any place.
/// @param name a scalar of flow_scalars(), not of another file. @throws Error, Cancelled where it is read.
[[nodiscard]] ScalarSampler flow_sampler(const std::string& name, Input& input,
                                         const std::shared_ptr<const VectorField>& field, int threads,
                                         Progress* progress);

struct FlowVolume {
  TangibleVolume voxels;           ///< those of the first name as `image`; nothing of it is felt
  std::vector<TakenScalar> taken;  ///< those that were resampled or derived
};
/// @param names of flow_volume_names(), at least one. @param field that the flow is traced through.
/// @throws Error (usage) where a scalar has to be resampled and nothing asks for it; Cancelled.
[[nodiscard]] FlowVolume load_flow_volume(Input& input, const std::shared_ptr<const VectorField>& field,
                                          const std::vector<std::string>& names, const std::string& resample,
                                          int threads, Progress* progress);

}  // namespace palpate
