#include "loaders/nifti/fsl_names.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

namespace palpate {
namespace {

constexpr std::array<std::string_view, 7> kNames{"V1", "V2", "V3", "L1", "L2", "L3", "FA"};
constexpr std::array<std::string_view, 4> kEndings{".nii.gz", ".nii", ".hdr", ".img"};

}  // namespace

std::string nifti_stem(const std::string& file) {
  std::string name = std::filesystem::path(file).filename().string();
  for (const std::string_view ending : kEndings) {
    if (name.size() > ending.size() && name.ends_with(ending))
      return name.substr(0, name.size() - ending.size());
  }
  return name;
}

std::optional<std::string> fsl_image_name(const std::string& file) {
  const std::string stem = nifti_stem(file);
  for (const std::string_view name : kNames) {
    if (stem == name || stem.ends_with("_" + std::string(name))) return std::string(name);
  }
  return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> fsl_images_beside(const std::string& file) {
  const std::string own = fsl_image_name(file).value_or("");
  const std::string stem = nifti_stem(file);
  const std::string prefix = stem.substr(0, stem.size() - own.size());
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::vector<std::pair<std::string, std::string>> found;
  for (const std::string_view name : kNames) {
    if (name == own) continue;
    for (const std::string_view ending : kEndings) {
      const std::filesystem::path path = folder / (prefix + std::string(name) + std::string(ending));
      std::error_code error;
      if (!std::filesystem::is_regular_file(path, error)) continue;
      found.emplace_back(name, path.string());
      break;
    }
  }
  return found;
}

}  // namespace palpate
