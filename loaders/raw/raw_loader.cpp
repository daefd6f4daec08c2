#include "loaders/raw/raw_loader.h"

#include <fstream>
#include <span>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/raw_layout.h"
#include "common/load/volume_block.h"
#include "common/load/voxel_bytes.h"

namespace palpate {
namespace {

class RawLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    file_ = request.files.front().string();
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second file of voxels", "one file"});
    if (!request.raw) throw input_error({file_, "", "comes without the layout of its voxels"});
    layout_ = *request.raw;
    const std::uint64_t behind = check_size();

    array_ = {.name = "scalars",
              .association = Association::kPoint,
              .components = 1,
              .type = layout_.type,
              .tuples = 1};
    for (int axis = 0; axis < 3; ++axis) array_.tuples *= as_size(layout_.size[axis]);
    topology_.points = layout_.size;
    topology_.origin = layout_.origin;
    for (int axis = 0; axis < 3; ++axis) {
      topology_.axes[axis] = Vec3{0.0};
      topology_.axes[axis][axis] = layout_.spacing[axis];
    }
    FileInfo info;
    info.notes.emplace_back("no orientation known: coordinates are spacings times indices");
    if (behind > 0) info.notes.push_back(counted(behind, "byte") + " behind the voxels left unread");
    info.blocks.push_back(describe_image(topology_, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    return read_image(topology_, array_.name, names, [this] { return values(); });
  }

 private:
  /// @return how many bytes follow the voxels.
  std::uint64_t check_size() const {
    const std::uint64_t there = read_head(file_, 0).file_size;
    const std::uint64_t wanted = byte_count(layout_);
    if (there >= layout_.skip && there - layout_.skip >= wanted) return there - layout_.skip - wanted;
    const std::string skipped = layout_.skip > 0 ? " behind the first " + std::to_string(layout_.skip) : "";
    throw input_error({file_, "", "has " + std::to_string(there) + " bytes",
                       std::to_string(wanted) + skipped + " for " + std::to_string(layout_.size.x) + " x " +
                           std::to_string(layout_.size.y) + " x " + std::to_string(layout_.size.z) + " of " +
                           name_of(layout_.type),
                       "check size and type"});
  }

  DataArray values() const {
    (void)check_size();
    VoxelMemory memory(byte_count(layout_));
    const std::span<std::byte> bytes = memory.bytes();
    std::ifstream in(file_, std::ios::binary);
    in.seekg(static_cast<std::streamoff>(layout_.skip));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    check_voxel_counts(file_, {.wanted = bytes.size(), .found = static_cast<std::uint64_t>(in.gcount())});
    to_native(bytes, byte_size(layout_.type), layout_.big_endian);
    return std::move(memory).finish(file_, array_.type, 1);
  }

  std::string file_;
  RawLayout layout_;
  UniformTopology topology_;
  ArrayInfo array_;
};

}  // namespace

std::unique_ptr<Loader> make_raw_loader() { return std::make_unique<RawLoader>(); }

}  // namespace palpate
