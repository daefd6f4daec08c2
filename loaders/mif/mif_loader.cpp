#include "loaders/mif/mif_loader.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/load/fsl_gradients.h"
#include "common/load/volume_block.h"
#include "loaders/mif/mif_values.h"

namespace palpate {
namespace {

/// Steps along the axes in the order and the sense in which they are stored: those of the image that tables of FSL
/// were made with, which MRtrix sorts and turns around towards RAS.
Mat3 stored_axes(const MifHeader& header) {
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&header](int a, int b) { return header.axes[as_size(a)].rank < header.axes[as_size(b)].rank; });
  Mat3 axes;
  for (int c = 0; c < 3; ++c) {
    const int axis = order[as_size(c)];
    axes[c] = (header.axes[as_size(axis)].backwards ? -1.0 : 1.0) * header.topology.axes[axis];
  }
  return axes;
}

class MifLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second MRtrix image", "one file", ""});
    header_ = read_mif_header(request.files.front().string());
    FileInfo info;
    info.anatomical = true;
    info.units = "coordinates in mm";
    info.notes = header_.notes;
    const auto volumes = as_size(header_.volumes());
    tuple_.resize(1);
    array_ = {"scalars", Association::kPoint, 1, value_type(header_), header_.voxels()};
    if (request.diffusion) {
      describe_diffusion(request.files.front().string(), *request.diffusion, volumes, info);
    } else {
      for (std::size_t v = 0; v < volumes && volumes > 1; ++v) info.times.push_back(static_cast<double>(v));
    }
    info.blocks.push_back(describe_image(header_.topology, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    return read_image(header_.topology, array_.name, names, [&] {
      std::vector<std::uint64_t> volumes = tuple_;
      if (volumes.size() == 1) volumes.front() = step;
      return read_mif_values(header_, volumes, on_progress);
    });
  }

 private:
  /// The volumes are signals, a tensor's six numbers, or numbers of a kind that is not known.
  void describe_diffusion(const std::string& file, const DiffusionRequest& request, std::size_t volumes,
                          FileInfo& info) {
    constexpr std::size_t kTensor = 6;
    info.diffusion.layout = TensorLayout::kUnstated;
    if (volumes > kMostGradients) {
      throw input_error({header_.data_file, "", "has " + std::to_string(volumes) + " volumes",
                         std::to_string(kMostGradients) + " at most", ""});
    }
    tuple_.resize(volumes);
    std::iota(tuple_.begin(), tuple_.end(), 0);
    if (const auto named = named_fsl_gradients(file, request, volumes, stored_axes(header_), info.notes)) {
      if (header_.gradients) {
        std::erase(info.notes, kGradientsOfHeader);
        info.notes.emplace_back("dw_scheme of the header left aside for them");
      }
      info.diffusion.gradients = named->table;
      info.diffusion.gradient_frame = named->frame;
      array_.name = kSignalArray;
    } else if (header_.gradients) {
      info.diffusion.gradients = header_.gradients;
      array_.name = kSignalArray;
    } else if (volumes == kTensor) {
      tuple_ = {0, 3, 4, 1, 5, 2};  // xx yy zz xy xz yz, brought into the order of TensorLayout::kData
      info.diffusion.layout = TensorLayout::kData;
      info.notes.emplace_back("tensors taken in MRtrix's order (xx yy zz xy xz yz), along RAS");
      array_.name = "tensors";
    } else if (volumes > 1) {
      info.notes.push_back("no dw_scheme in the header: no tensor can be fitted to its " +
                           std::to_string(volumes) + " volumes");
    }
    array_.components = static_cast<int>(volumes);
  }

  MifHeader header_;
  ArrayInfo array_;
  std::vector<std::uint64_t> tuple_;  ///< which volumes make a tuple; one: that of the time step
};

}  // namespace

std::unique_ptr<Loader> make_mif_loader() { return std::make_unique<MifLoader>(); }

}  // namespace palpate
