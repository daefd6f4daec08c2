#include "loaders/nifti/nifti_loader.h"

#include <algorithm>
#include <deque>
#include <filesystem>
#include <system_error>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/fsl_gradients.h"
#include "common/load/volume_block.h"
#include "loaders/nifti/nifti_file.h"

namespace palpate {
namespace {

/// Whether the voxels of both lie in the same places, but for what programs round in headers.
bool same_voxels(const UniformTopology& a, const UniformTopology& b) {
  if (a.points != b.points) return false;
  constexpr double kRounding = 0.01;  // of the shortest step
  const double close =
      kRounding * std::min({glm::length(a.axes[0]), glm::length(a.axes[1]), glm::length(a.axes[2])});
  double apart = glm::distance(a.origin, b.origin);
  for (int axis = 0; axis < 3; ++axis)
    apart += glm::distance(a.axes[axis], b.axes[axis]) * (a.points[axis] - 1);
  return apart <= close;
}

class NiftiLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    const std::string file = request.files.front().string();
    check_others(request);
    files_.clear();
    files_.emplace_back(
        file, request.diffusion ? FourthAxis::kComponents : FourthAxis::kTime,
        request.diffusion || request.left_handed ? std::optional(request.left_handed) : std::nullopt);
    const NiftiFile& first = files_.front();

    FileInfo info;
    info.anatomical = first.anatomical();
    info.units = "coordinates in mm";
    info.notes = first.notes();
    info.times = first.times();
    if (request.diffusion) describe_diffusion(file, *request.diffusion, request.left_handed, info);
    info.blocks.push_back(describe_image(first.topology(), first.array()));
    for (std::size_t i = 1; i < files_.size(); ++i) info.blocks.front().arrays.push_back(files_[i].array());
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    DataSet block;
    block.topology = files_.front().topology();
    for (const NiftiFile& file : files_) {
      if (std::find(names.begin(), names.end(), file.array().name) != names.end())
        block.arrays.push_back(file.values(step, on_progress));
    }
    std::vector<DataSet> blocks;
    blocks.push_back(std::move(block));
    return blocks;
  }

 private:
  /// Several files are one input where they are FSL's images of one set, which come along by themselves.
  static void check_others(const LoadRequest& request) {
    const std::string first = request.files.front().string();
    std::vector<std::pair<std::string, std::string>> set;
    if (request.diffusion && fsl_image_name(first)) set = fsl_images_beside(first);
    for (std::size_t f = 1; f < request.files.size(); ++f) {
      const bool known = std::any_of(set.begin(), set.end(), [&](const auto& image) {
        std::error_code ignored;
        return std::filesystem::equivalent(image.second, request.files[f], ignored);
      });
      if (!known) {
        throw input_error({request.files[f].string(), "", "is a second NIfTI file", "one file",
                           "of tensors, V1, V2, V3, L1, L2, L3 and FA of one name are read together"});
      }
    }
  }

  /// Finds out whether the image holds signals with gradients, tensors, or one of FSL's eigen images.
  void describe_diffusion(const std::string& file, const DiffusionRequest& request, bool left_handed,
                          FileInfo& info) {
    NiftiFile& image = files_.front();
    const int volumes = image.array().components;
    info.diffusion.frame = image.stated_frame();
    info.diffusion.layout = image.symmetric_matrix() ? TensorLayout::kLower : TensorLayout::kUnstated;
    if (const auto name = fsl_image_name(file)) {
      image.rename(*name);
      add_eigen_set(file, left_handed, info);
      return;
    }
    const auto gradients = find_fsl_gradients(file, request);
    if (gradients) {
      info.diffusion.gradients =
          read_fsl_gradients(*gradients, as_size(volumes), image.topology().axes, info.notes);
      info.diffusion.gradient_frame = gradients->frame();
      image.rename(kSignalArray);
    } else if (volumes == 6) {
      image.rename("tensors");
    } else if (volumes > 6) {
      info.notes.push_back("no gradients beside the file (" + gradient_names(file) +
                           "): no tensor can be fitted to its " + std::to_string(volumes) + " volumes");
    }
  }

  /// The other eigenvectors, eigenvalues and measures that lie beside `file`, on the same grid.
  void add_eigen_set(const std::string& file, bool left_handed, FileInfo& info) {
    for (const auto& [name, path] : fsl_images_beside(file)) {
      NiftiFile other(path, FourthAxis::kComponents, left_handed);
      if (!same_voxels(files_.front().topology(), other.topology())) {
        info.notes.push_back(path + " lies on another grid, and is left out");
        continue;
      }
      if (name.starts_with('V') && !info.diffusion.frame) info.diffusion.frame = other.stated_frame();
      other.rename(name);
      files_.push_back(std::move(other));
    }
  }

  std::deque<NiftiFile> files_;  ///< one; several where FSL's images go together
};

}  // namespace

std::unique_ptr<Loader> make_nifti_loader() { return std::make_unique<NiftiLoader>(); }

}  // namespace palpate
