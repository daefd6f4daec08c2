/// The images that FSL's dtifit writes, by their names: "dti_V1.nii.gz", "V1.nii".
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate {

/// "V1" to "V3", "L1" to "L3" or "FA" where the file's name is that, alone or after a "_".
[[nodiscard]] std::optional<std::string> fsl_image_name(const std::string& file);

/// The others of these beside `file` under the same prefix: name and path. @pre fsl_image_name(file).
[[nodiscard]] std::vector<std::pair<std::string, std::string>> fsl_images_beside(const std::string& file);

/// The file's name without .nii, .nii.gz, .hdr or .img.
[[nodiscard]] std::string nifti_stem(const std::string& file);

}  // namespace palpate
