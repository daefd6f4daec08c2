#include "loaders/vdb/vdb_loader.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <malloc.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <sys/resource.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/grid/sparse/sparse_builder.h"
#include "common/load/find_format.h"
#include "common/load/volume_block.h"

namespace palpate {
namespace {

template <typename T>
constexpr ScalarType scalar_type() {
  if constexpr (std::is_same_v<T, float>) return ScalarType::kFloat32;
  if constexpr (std::is_same_v<T, double>) return ScalarType::kFloat64;
  if constexpr (std::is_same_v<T, std::int32_t>) return ScalarType::kInt32;
  if constexpr (std::is_same_v<T, std::int64_t>) return ScalarType::kInt64;
  return ScalarType::kUint8;  // bool
}

// Calls f(const Grid&) with the grid as what it is; false where it is none of those that are read.
template <typename F>
bool with_grid(const openvdb::GridBase& grid, F f) {
  using Read =
      openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                        openvdb::BoolGrid, openvdb::Vec3SGrid, openvdb::Vec3DGrid>;
  return grid.apply<Read>(f);
}

// Walks over names, metadata and what stands before them: of noise OpenVDB would make thousands of millions of texts, each as
// long as noise says.
class Walk {
 public:
  Walk(std::istream& in, std::int64_t end) : in_(in), end_(end) {}

  std::uint32_t number() {
    std::uint32_t value = 0;
    in_.read(reinterpret_cast<char*>(&value), sizeof(value));
    check(0);
    return value;
  }
  void pass(std::uint32_t bytes) {
    check(bytes);
    in_.seekg(bytes, std::ios::cur);
  }
  void text() { pass(number()); }
  void metadata() {
    for (std::uint32_t left = number(); left > 0; --left) {
      text();  // name
      text();  // type
      text();  // value, with its size before it
    }
  }

 private:
  void check(std::uint32_t bytes) {
    if (!in_ || in_.tellg() + std::int64_t{bytes} > end_)
      throw openvdb::IoError("has names or metadata that go on beyond their end");
  }

  std::istream& in_;
  std::int64_t end_;
};

// A file whose numbers never go beyond their place. Before numbers that are not packed stands their size, negative: OpenVDB 10
// reads as many bytes as it says, and compares it with the place afterwards. The place is a block of memory of its own
// (readCompressedValues() in openvdb/io/Compression.h), which knows how large it is.
class BoundedFile : public std::filebuf {
 protected:
  std::streamsize xsgetn(char* to, std::streamsize bytes) override {
    if (stated_ && bytes == *stated_ && static_cast<std::size_t>(bytes) > ::malloc_usable_size(to))
      throw openvdb::IoError("has more numbers than their place holds");
    const std::streamsize read = std::filebuf::xsgetn(to, bytes);
    stated_.reset();
    std::int64_t size = 0;
    if (read == sizeof(size)) {
      std::memcpy(&size, to, sizeof(size));
      if (size < 0 && size > std::numeric_limits<std::int64_t>::min()) stated_ = -size;
    }
    return read;
  }

 private:
  std::optional<std::int64_t> stated_;  // by the last read
};

// The grids of a file, each read from where its own head says that it stands: OpenVDB's stream takes what follows a damaged grid
// for the head of the next one.
class Grids : private openvdb::io::Archive {
 public:
  // Where the last one ends; nothing where the file ends amid the head of one. @throws openvdb::Exception and others where
  // heads make no sense.
  static std::optional<std::int64_t> end(const std::string& file, std::uint64_t bytes) {
    Grids archive;
    const auto all = static_cast<std::int64_t>(bytes);
    std::ifstream in(file, std::ios::binary);
    archive.readHeader(in);
    archive.setFormatVersion(in);  // what descriptors hold depends on it
    if (!in) return {};
    Walk(in, all).metadata();
    std::int64_t last = in.tellg();
    for (std::int32_t left = readGridCount(in); left > 0; --left) {
      const std::istream::pos_type head = in.tellg();
      Walk names(in, all);
      names.text();  // its own
      names.text();  // its type's
      if (archive.fileVersion() >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING) names.text();
      in.seekg(head);
      openvdb::io::GridDescriptor grid;
      (void)grid.read(in);
      if (!in) return {};
      // Never back: a file whose grids lead to one another would be read for ever.
      if (grid.getEndPos() <= last) throw openvdb::IoError("has grids that overlap");
      last = grid.getEndPos();
      if (last <= all) {
        grid.seekToGrid(in);
        Walk walk(in, last);
        if (archive.fileVersion() >= openvdb::OPENVDB_FILE_VERSION_NODE_MASK_COMPRESSION) (void)walk.number();
        walk.metadata();
        walk.text();  // kind of transform
      }
      grid.seekToEnd(in);
    }
    if (!in) return {};
    return last;
  }

  // All of them. @pre end() lies within the file. @throws openvdb::Exception and others where it is damaged.
  static openvdb::GridPtrVec read(const std::string& file) {
    Grids archive;
    // Where the file ends early, each read fails at once, in place of as many as noise asks for.
    BoundedFile bytes;
    std::istream in(&bytes);
    if (bytes.open(file, std::ios::in | std::ios::binary) == nullptr)
      throw openvdb::IoError("cannot be opened");
    in.exceptions(std::ios::badbit | std::ios::failbit | std::ios::eofbit);
    archive.readHeader(in);
    openvdb::io::StreamMetadata::Ptr of_stream(new openvdb::io::StreamMetadata);
    openvdb::io::setStreamMetadataPtr(in, of_stream, false);
    archive.setFormatVersion(in);
    archive.setLibraryVersion(in);
    archive.setDataCompression(in);
    openvdb::MetaMap().readMeta(in);
    std::vector<openvdb::io::GridDescriptor> heads;
    openvdb::GridPtrVec grids;
    NamedGridMap by_name;
    for (std::int32_t left = readGridCount(in); left > 0; --left) {
      grids.push_back(heads.emplace_back().read(in));
      heads.back().seekToGrid(in);
      readGrid(grids.back(), heads.back(), in);
      heads.back().seekToEnd(in);
      by_name[heads.back().uniqueName()] = grids.back();
    }
    for (const auto& head : heads) archive.connectInstance(head, by_name);
    return grids;
  }
};

Vec3 vec(const openvdb::Vec3d& v) { return {v.x(), v.y(), v.z()}; }

class VdbLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    file_ = request.files.front().string();
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second OpenVDB file", "one file"});
    openvdb::initialize();
    FileInfo info;
    try {
      check_end();
      for (const openvdb::GridBase::Ptr& grid : Grids::read(file_)) take(grid, info.notes);
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::ios_base::failure&) {
      throw damaged("it ends amid its voxels");
    } catch (const std::exception& error) {
      throw damaged(error.what());
    }
    if (lattices_.empty()) {
      throw input_error({file_, "",
                         "holds no grid with voxels" + (info.notes.empty() ? "" : ": " + info.notes.front()),
                         "numbers or vectors of three on a grid with a linear transform"});
    }
    for (Lattice& lattice : lattices_) place(lattice);
    // Volumes before what has one sample along an axis.
    std::stable_partition(lattices_.begin(), lattices_.end(), [](const Lattice& lattice) {
      const Index3& n = lattice.topology.points;
      return std::min({n.x, n.y, n.z}) > 1;
    });
    for (const Lattice& lattice : lattices_) {
      const auto& grids = lattice.grids;
      info.blocks.push_back(describe_image(lattice.topology, described(*grids.front(), lattice)));
      for (std::size_t i = 1; i < grids.size(); ++i)
        info.blocks.back().arrays.push_back(described(*grids[i], lattice));
      if (lattices_.size() > 1) info.blocks.back().name = names_of(lattice);
    }
    if (lattices_.size() > 1)
      info.notes.push_back("grids lie on " + std::to_string(lattices_.size()) +
                           " lattices: each has its own with --field");
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    std::vector<DataSet> blocks;
    for (const Lattice& lattice : lattices_) {
      DataSet block;
      block.topology = lattice.topology;
      for (const openvdb::GridBase::Ptr& grid : lattice.grids) {
        const ArrayInfo info = described(*grid, lattice);
        if (std::find(names.begin(), names.end(), info.name) != names.end())
          block.arrays.push_back(values_of(*grid, info, lattice));
      }
      // A lattice without the numbers that are asked for is none of theirs.
      if (!block.arrays.empty() || lattices_.size() == 1) blocks.push_back(std::move(block));
    }
    return blocks;
  }

 private:
  /// Grids of one transform, on the box of all that is active in them.
  struct Lattice {
    std::vector<openvdb::GridBase::Ptr> grids;
    openvdb::CoordBBox box;
    UniformTopology topology;
  };

  [[nodiscard]] Error damaged(const std::string& what) const {
    return input_error({file_, "", "OpenVDB cannot read it: " + what, "", "the file may be damaged"});
  }

  void check_end() const {
    const std::uint64_t there = read_head(file_, 0).file_size;
    const std::optional<std::int64_t> end = Grids::end(file_, there);
    if (!end) throw input_error({file_, "", "ends amid the head of a grid", "", "the file may be truncated"});
    if (static_cast<std::uint64_t>(*end) > there) {
      throw input_error({file_, "", "has " + std::to_string(there) + " bytes",
                         std::to_string(*end) + " for its grids", "the file may be truncated"});
    }
  }

  // Keeps the grid, with those of its lattice, where it can be read, else says why not.
  void take(const openvdb::GridBase::Ptr& grid, std::vector<std::string>& notes) {
    const std::string name = "grid \"" + grid->getName() + "\" ";
    const openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
    const auto leave = [&](const std::string& why) { notes.push_back(name + why + ", and is left out"); };
    if (!with_grid(*grid, [](const auto&) {})) return leave("holds " + grid->valueType());
    if (box.empty()) return leave("has no active voxel");
    if (!grid->transform().isLinear()) return leave("has a transform that is not linear (a frustum)");
    if (grid->getGridClass() == openvdb::GRID_STAGGERED)
      return leave("is staggered: its components lie on faces of voxels");
    const auto same_name = [&](const auto& other) { return name_of_array(*other) == name_of_array(*grid); };
    const bool known = std::any_of(lattices_.begin(), lattices_.end(), [&](const Lattice& lattice) {
      return std::any_of(lattice.grids.begin(), lattice.grids.end(), same_name);
    });
    if (known) return leave("has the name of another one");
    if (grid->getGridClass() == openvdb::GRID_LEVEL_SET)
      notes.push_back(name + "is a level set: distances from its surface, below 0 inside");
    auto own = std::find_if(lattices_.begin(), lattices_.end(), [&](const Lattice& lattice) {
      return grid->transform() == lattice.grids.front()->transform();
    });
    if (own == lattices_.end()) own = lattices_.emplace(own);
    own->box.expand(box);
    own->grids.push_back(grid);
  }

  // Where the voxels of the box lie; refuses what is too large for this machine.
  void place(Lattice& lattice) const {
    // In double: corners of hostile boxes are 2^32 apart.
    double count = 1.0;
    for (int axis = 0; axis < 3; ++axis)
      count *=
          1.0 + static_cast<double>(lattice.box.max()[axis]) - static_cast<double>(lattice.box.min()[axis]);
    rlimit limit{};
    ::getrlimit(RLIMIT_AS, &limit);
    double bytes = 0.0;
    for (const auto& grid : lattice.grids) {
      if (!stays_sparse(*grid)) bytes = std::max(bytes, count * static_cast<double>(tuple_bytes(*grid)));
    }
    // Dense numbers are there twice, here and on their way.
    if (2.0 * bytes > static_cast<double>(limit.rlim_cur) || count > static_cast<double>(kMostSparsePoints)) {
      const auto& low = lattice.box.min();
      const auto& high = lattice.box.max();
      const auto side = [&](int axis) {
        return std::to_string(std::int64_t{high[axis]} - std::int64_t{low[axis]} + 1);
      };
      throw input_error({file_, "",
                         "has active voxels in a box of " + side(0) + " x " + side(1) + " x " + side(2) +
                             (bytes > 0.0 ? ", more than this machine's memory holds" : ""),
                         "at most " + std::to_string(kMostSparsePoints >> 30U) +
                             " thousand million voxels, and fewer where they are no single numbers",
                         "cut it, or make its voxels larger, in the program that it is from"});
    }
    const openvdb::math::Transform& transform = lattice.grids.front()->transform();
    const openvdb::Vec3d origin = transform.indexToWorld(lattice.box.min());
    lattice.topology.origin = vec(origin);
    for (int axis = 0; axis < 3; ++axis) {
      lattice.topology.points[axis] = lattice.box.max()[axis] - lattice.box.min()[axis] + 1;
      openvdb::Vec3d step(0.0);
      step[axis] = 1.0;
      lattice.topology.axes[axis] =
          vec(transform.indexToWorld(step) - transform.indexToWorld(openvdb::Vec3d(0.0)));
    }
  }

  static std::string name_of_array(const openvdb::GridBase& grid) {
    return grid.getName().empty() ? "values" : grid.getName();
  }

  static std::string names_of(const Lattice& lattice) {
    std::string names;
    for (const auto& grid : lattice.grids) names += (names.empty() ? "" : ", ") + name_of_array(*grid);
    return names;
  }

  // Numbers of single precision are handed over as the tree that they are.
  static bool stays_sparse(const openvdb::GridBase& grid) { return grid.isType<openvdb::FloatGrid>(); }

  static std::size_t tuple_bytes(const openvdb::GridBase& grid) {
    std::size_t bytes = 0;
    (void)with_grid(grid, [&](const auto& g) {
      using Value = typename std::decay_t<decltype(g)>::ValueType;
      bytes = sizeof(Value);
    });
    return bytes;
  }

  [[nodiscard]] ArrayInfo described(const openvdb::GridBase& grid, const Lattice& lattice) const {
    ArrayInfo info{.name = name_of_array(grid),
                   .association = Association::kPoint,
                   .components = 1,
                   .type = ScalarType::kFloat32,
                   .tuples = 1};
    for (int axis = 0; axis < 3; ++axis) info.tuples *= as_size(lattice.topology.points[axis]);
    if (stays_sparse(grid))
      info.sparse_bytes =
          static_cast<const openvdb::FloatGrid&>(grid).tree().leafCount() * kBlockVoxels * sizeof(float);
    (void)with_grid(grid, [&](const auto& g) {
      using Value = typename std::decay_t<decltype(g)>::ValueType;
      if constexpr (openvdb::VecTraits<Value>::IsVec) {
        info.components = openvdb::VecTraits<Value>::Size;
        info.type = scalar_type<typename Value::ValueType>();
      } else {
        info.type = scalar_type<Value>();
      }
    });
    return info;
  }

  // What lies in the box, leaf by leaf and tile by tile.
  [[nodiscard]] std::shared_ptr<const SparseNumbers> sparse(const openvdb::FloatGrid& grid,
                                                            const Lattice& lattice) const {
    const openvdb::Coord low = lattice.box.min();
    constexpr int kMask = kBlockSide - 1;
    const Index3 shift(low.x() & kMask, low.y() & kMask, low.z() & kMask);
    SparseBuilder builder(shift, lattice.topology.points, grid.background());
    const Index3 origin = Index3(low.x(), low.y(), low.z()) - shift;
    const auto block_of = [&](const openvdb::Coord& voxel) {
      return (Index3(voxel.x(), voxel.y(), voxel.z()) - origin) / kBlockSide;
    };
    using Tree = openvdb::FloatTree;
    for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
      if (!lattice.box.hasOverlap(leaf->getNodeBoundingBox())) continue;
      builder.put(block_of(leaf->origin()),
                  std::span<const float, kBlockVoxels>(leaf->buffer().data(), kBlockVoxels));
    }
    auto tile = grid.tree().cbeginValueAll();
    tile.setMaxDepth(Tree::ValueAllCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) {
      if (*tile == grid.background()) continue;
      openvdb::CoordBBox part = tile.getBoundingBox();
      part.intersect(lattice.box);
      if (part.empty()) continue;
      const Index3 first = block_of(part.min()), last = block_of(part.max());
      for (int z = first.z; z <= last.z; ++z) {
        for (int y = first.y; y <= last.y; ++y) {
          for (int x = first.x; x <= last.x; ++x) builder.put({x, y, z}, *tile);
        }
      }
    }
    return builder.finish();
  }

  [[nodiscard]] DataArray values_of(const openvdb::GridBase& grid, const ArrayInfo& info,
                                    const Lattice& lattice) const {
    DataArray array;
    array.name = info.name;
    array.type = info.type;
    array.components = info.components;
    array.tuples = info.tuples;
    if (stays_sparse(grid)) {
      array.sparse = sparse(static_cast<const openvdb::FloatGrid&>(grid), lattice);
      return array;
    }
    const auto bytes = std::make_shared<std::vector<std::byte>>(info.tuples * tuple_bytes(grid));
    (void)with_grid(grid, [&](const auto& g) {
      using Value = typename std::decay_t<decltype(g)>::ValueType;
      static_assert(sizeof(bool) == 1);
      openvdb::tools::Dense<Value, openvdb::tools::LayoutXYZ> to(lattice.box,
                                                                 reinterpret_cast<Value*>(bytes->data()));
      openvdb::tools::copyToDense(g, to);
    });
    array.bytes = std::as_const(*bytes);
    array.owner = bytes;
    return array;
  }

  std::string file_;
  std::vector<Lattice> lattices_;  ///< in the order of their first grids
};

}  // namespace

std::unique_ptr<Loader> make_vdb_loader() { return std::make_unique<VdbLoader>(); }

}  // namespace palpate
