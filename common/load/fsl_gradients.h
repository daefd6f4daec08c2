/// Gradients as FSL writes them: a text file of b-values and one of directions (.bval, .bvec).
///
/// Directions are in the image's axes, the first one turned around where the image is right-handed
/// (gradient_table.h). They stand in three lines or in three columns; b-values on a line or one a line. What FSL's
/// eddy turned with the volumes (.eddy_rotated_bvecs) comes before what it was made of. MRtrix's table in one file (.b)
/// has x, y, z and b in each line, in scanner axes.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/field/tensor/gradient_table.h"
#include "common/field/tensor/vector_frame.h"
#include "common/load/load.h"

namespace palpate {

struct FslGradientFiles {
  std::string weightings;  ///< .bval
  std::string directions;  ///< .bvec; a file of MRtrix is both

  /// In which they stand.
  [[nodiscard]] VectorFrame frame() const;
};

/// The files that `request` names, or those beside `file` whose names go with it: "NAME.bval", "NAME.bvals",
/// or "bvals" in the same folder, and likewise the directions, or "NAME.b". None where there is no such pair.
/// @throws Error (bad input) where one of the two is missing.
[[nodiscard]] std::optional<FslGradientFiles> find_fsl_gradients(const std::string& file,
                                                                 const DiffusionRequest& request);

/// What find_fsl_gradients() looks for, for messages: "dwi.bval, dwi.bvec or dwi.b".
[[nodiscard]] std::string gradient_names(const std::string& file);

/// Reads both; directions come out in RAS, of the length that they have, zero where there is none.
/// @param axes steps of the image in RAS along i, j, k, as columns.
/// @param notes what was taken how.
/// @throws Error (bad input) naming the file where it is no table of `volumes` numbers.
[[nodiscard]] GradientTable read_fsl_gradients(const FslGradientFiles& files, std::size_t volumes,
                                               const Mat3& axes, std::vector<std::string>& notes);

struct NamedGradients {
  GradientTable table;
  VectorFrame frame = VectorFrame::kImage;  ///< in which the files have them
};
/// The table of the files that `request` names; nothing where it names none. They win over what the image holds.
/// @throws Error (bad input) as find_fsl_gradients() and read_fsl_gradients().
[[nodiscard]] std::optional<NamedGradients> named_fsl_gradients(const std::string& file,
                                                                const DiffusionRequest& request,
                                                                std::size_t volumes, const Mat3& axes,
                                                                std::vector<std::string>& notes);

/// "V1" to "V3", "L1" to "L3" or "FA" where the file's name is that, alone or after a "_".
[[nodiscard]] std::optional<std::string> fsl_image_name(const std::string& file);

/// The others of these beside `file` under the same prefix: name and path. @pre fsl_image_name(file).
[[nodiscard]] std::vector<std::pair<std::string, std::string>> fsl_images_beside(const std::string& file);

/// The file's name without .nii, .nii.gz, .hdr or .img.
[[nodiscard]] std::string nifti_stem(const std::string& file);

}  // namespace palpate
