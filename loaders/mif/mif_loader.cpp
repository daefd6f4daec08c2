#include "loaders/mif/mif_loader.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/load/volume_block.h"
#include "loaders/mif/mif_values.h"

namespace palpate {
namespace {

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
    const auto volumes = static_cast<std::size_t>(header_.volumes());
    tuple_.resize(1);
    array_ = {"scalars", Association::kPoint, 1, value_type(header_), header_.voxels()};
    if (request.diffusion) {
      describe_diffusion(volumes, info);
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
  void describe_diffusion(std::size_t volumes, FileInfo& info) {
    constexpr std::size_t kTensor = 6;
    info.diffusion.layout = TensorLayout::kUnstated;
    if (volumes > kMostGradients) {
      throw input_error({header_.data_file, "", "has " + std::to_string(volumes) + " volumes",
                         std::to_string(kMostGradients) + " at most", ""});
    }
    tuple_.resize(volumes);
    std::iota(tuple_.begin(), tuple_.end(), 0);
    if (header_.gradients) {
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
