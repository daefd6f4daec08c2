#include "loaders/tract/tract_loader.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/text.h"
#include "common/geometry/tractogram.h"
#include "common/load/gzip_head.h"
#include "loaders/tract/tck_reader.h"
#include "loaders/tract/trk_reader.h"
#include "loaders/tract/trx_reader.h"

namespace palpate {
namespace {

constexpr std::uint8_t kVertex = 1, kPolyLine = 4;  // cell types of the VTK file format

/// Names of arrays are keys: a second "fa" becomes "fa (2)".
void make_unique(std::vector<Tractogram::Column>& columns) {
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const std::string name = columns[c].name;
    const auto taken = [&](const std::string& other) {
      return std::any_of(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(c),
                         [&other](const auto& column) { return column.name == other; });
    };
    for (int n = 2; taken(columns[c].name); ++n) columns[c].name = name + " (" + std::to_string(n) + ")";
  }
}

class TractLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second tractogram", "one file"});
    FileInfo info;
    lines_ = read_file(request.files.front().string(), format, info.notes);
    make_unique(lines_.of_points);
    make_unique(lines_.of_lines);
    info.anatomical = true;
    info.units = "coordinates in mm";

    BlockInfo block;
    block.grid = "lines";
    block.point_count = lines_.points.size();
    block.cell_count = lines_.line_count();
    block.not_volume = "holds lines (a tractogram), not a volume";
    block.bounds = {Vec3{0.0}, Vec3{0.0}};
    if (!lines_.points.empty()) block.bounds = Box{};
    for (const Vec3f& x : lines_.points) block.bounds.include(Vec3{x});
    for (const auto& column : lines_.of_points) block.arrays.push_back(about(column, Association::kPoint));
    for (const auto& column : lines_.of_lines) block.arrays.push_back(about(column, Association::kCell));
    info.blocks.push_back(std::move(block));
    describe_image(info);
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    UnstructuredTopology topology;
    topology.positions = make_array("positions", Association::kPoint, 3, numbers(lines_.points));
    topology.offsets.assign(lines_.starts.begin(), lines_.starts.end());
    for (std::size_t l = 0; l < lines_.line_count(); ++l)
      topology.types.push_back(lines_.line(l).size() == 1 ? kVertex : kPolyLine);
    topology.connectivity.resize(lines_.points.size());
    for (std::size_t p = 0; p < lines_.points.size(); ++p)
      topology.connectivity[p] = static_cast<std::int64_t>(p);

    DataSet block;
    block.topology = std::move(topology);
    const auto wanted = [&names](const std::string& name) {
      return std::find(names.begin(), names.end(), name) != names.end();
    };
    for (const auto& column : lines_.of_points) {
      if (wanted(column.name))
        block.arrays.push_back(make_array(column.name, Association::kPoint, 1, column.values));
    }
    for (const auto& column : lines_.of_lines) {
      if (wanted(column.name))
        block.arrays.push_back(make_array(column.name, Association::kCell, 1, column.values));
    }
    std::vector<DataSet> blocks;
    blocks.push_back(std::move(block));
    if (lines_.image) {
      DataSet image;
      image.topology = UniformTopology{
          .points = lines_.image->voxels, .origin = lines_.image->origin, .axes = lines_.image->axes};
      blocks.push_back(std::move(image));
    }
    return blocks;
  }

 private:
  static Tractogram read_file(const std::string& file, Format format, std::vector<std::string>& notes) {
    if (format == Format::kTrx) return read_trx(file, notes);
    const MappedFile mapped(file);
    std::vector<std::byte> unpacked;
    std::string_view bytes = mapped.text();
    if (is_gzip(bytes)) {
      unpacked = unpack_all(bytes, notes);
      bytes = {reinterpret_cast<const char*>(unpacked.data()), unpacked.size()};
    }
    return format == Format::kTrk ? read_trk(file, bytes, notes) : read_tck(file, bytes, notes);
  }

  /// The image that the header places is a block without values, behind the lines.
  void describe_image(FileInfo& info) {
    if (!lines_.image) return;
    constexpr double kMostVoxels = 0x1p30;
    const Index3& points = lines_.image->voxels;
    double voxels = 1.0;
    for (int axis = 0; axis < 3; ++axis) voxels *= points[axis];
    // Programs that know of no image write none, or one voxel.
    if (voxels > kMostVoxels)
      info.notes.push_back("the header's image, of " + short_number(voxels) + " voxels, is left aside");
    if (voxels <= 1.0 || voxels > kMostVoxels) {
      lines_.image.reset();
      return;
    }
    BlockInfo block;
    block.name = "image of the header";
    block.grid = "uniform";
    block.points = points;
    block.point_count = static_cast<std::uint64_t>(voxels);
    block.not_volume = "is the place of an image, without its values";
    block.bounds = Box{};
    for (unsigned corner = 0; corner < 8; ++corner) {
      Vec3 index{0.0};
      for (int axis = 0; axis < 3; ++axis)
        index[axis] = (corner >> static_cast<unsigned>(axis) & 1U) != 0 ? points[axis] - 1.0 : 0.0;
      block.bounds.include(lines_.image->origin + lines_.image->axes * index);
    }
    info.blocks.push_back(std::move(block));
  }

  /// What a gzip file holds, as far as it goes.
  static std::vector<std::byte> unpack_all(std::string_view packed, std::vector<std::string>& notes) {
    constexpr std::size_t kFirst = std::size_t{1} << 16U, kUsualRatio = 4;
    std::vector<std::byte> bytes(kFirst + kUsualRatio * packed.size());
    Unpacked found = unpack(packed, bytes);
    while (found.more) {
      bytes.resize(2 * bytes.size());
      found = unpack(packed, bytes);
    }
    if (!found.ended) notes.emplace_back("WARNING: the gzip data are damaged or cut off");
    bytes.resize(found.bytes);
    return bytes;
  }

  static ArrayInfo about(const Tractogram::Column& column, Association association) {
    return {column.name, association, 1, ScalarType::kFloat32, column.values.size()};
  }

  static std::span<const float> numbers(const std::vector<Vec3f>& points) {
    static_assert(sizeof(Vec3f) == 3 * sizeof(float));
    return {reinterpret_cast<const float*>(points.data()), 3 * points.size()};
  }

  Tractogram lines_;
};

}  // namespace

std::unique_ptr<Loader> make_tract_loader() { return std::make_unique<TractLoader>(); }

}  // namespace palpate
