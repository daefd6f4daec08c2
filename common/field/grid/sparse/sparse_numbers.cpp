#include "common/field/grid/sparse/sparse_numbers.h"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>

#include "common/base/index.h"
#include "common/field/grid/sparse/nano_tree.h"

namespace palpate {
namespace {

constexpr std::uint64_t kTreePlace = sizeof(nanovdb::GridData);
constexpr std::uint32_t kLowerTiles = 16 * 16 * 16, kUpperTiles = 32 * 32 * 32;
// A box of kMostSparsePoints lies in fewer, and each costs a comparison where a number is looked up.
constexpr std::uint32_t kMostRootTiles = 4096;

[[noreturn]] void refuse(const std::string& what) { throw std::invalid_argument(what); }

// The nodes of one level.
struct NodeArray {
  std::uint64_t first = 0;  ///< byte at which they begin
  std::uint64_t count = 0;
};

// A tree in memory that nothing is known of.
class NanoTree {
 public:
  explicit NanoTree(std::span<const std::byte> bytes) : bytes_(bytes) {
    if (bytes.size() < kTreePlace + sizeof(nano::TreeData)) refuse("a sparse grid is cut off");
    if (reinterpret_cast<std::uintptr_t>(bytes.data()) % NANOVDB_DATA_ALIGNMENT != 0)
      refuse("a sparse grid is not aligned");
    const auto& grid = *at<nanovdb::GridData>(0);
    if (grid.mMagic != NANOVDB_MAGIC_NUMBER) refuse("a sparse grid does not begin as one");
    if (grid.mVersion.getMajor() != NANOVDB_MAJOR_VERSION_NUMBER)
      refuse("a sparse grid is of another version of NanoVDB");
    if (grid.mGridType != nanovdb::GridType::Float) refuse("a sparse grid holds no floats");
    const auto& tree = *at<nano::TreeData>(kTreePlace);
    root_ = nodes<nano::RootData>(tree.mNodeOffset[3], 1).first;
    tiles_ = at<nano::RootData>(root_)->mTableSize;
    if (tiles_ > kMostRootTiles ||
        tiles_ * sizeof(nano::RootData::Tile) >
            bytes_.size() - root_ - sizeof(nano::RootData))  // the root lies in there
      refuse("a sparse grid's root has too many tiles");
    uppers_ = nodes<nano::UpperData>(tree.mNodeOffset[2], tree.mNodeCount[2]);
    lowers_ = nodes<nano::LowerData>(tree.mNodeOffset[1], tree.mNodeCount[1]);
    leaves_ = nodes<nano::LeafData>(tree.mNodeOffset[0], tree.mNodeCount[0]);
  }

  // Each node leads to nodes of the level below, if anywhere.
  void check() const {
    for (std::uint32_t t = 0; t < tiles_; ++t) {
      const nano::RootData::Tile& tile = *at<nano::RootData>(root_)->tile(t);
      if (tile.isChild()) check_child<nano::UpperData>(root_, tile.child, uppers_);
    }
    check_children<nano::UpperData, nano::LowerData>(uppers_, kUpperTiles, lowers_);
    check_children<nano::LowerData, nano::LeafData>(lowers_, kLowerTiles, leaves_);
  }

  [[nodiscard]] const nano::RootData* root() const { return at<nano::RootData>(root_); }

  // @pre the bytes may be written.
  void map(const std::function<float(float)>& f) const {
    auto* root = writable<nano::RootData>(root_);
    root->mBackground = f(root->mBackground);
    for (std::uint32_t t = 0; t < tiles_; ++t) root->tile(t)->value = f(root->tile(t)->value);
    map_tiles<nano::UpperData>(uppers_, kUpperTiles, f);
    map_tiles<nano::LowerData>(lowers_, kLowerTiles, f);
    for (std::uint64_t i = 0; i < leaves_.count; ++i) {
      for (float& number : writable<nano::LeafData>(leaves_.first + i * sizeof(nano::LeafData))->mValues)
        number = f(number);
    }
  }

 private:
  template <typename T>
  [[nodiscard]] const T* at(std::uint64_t place) const {
    return reinterpret_cast<const T*>(bytes_.data() + place);
  }
  template <typename T>
  [[nodiscard]] T* writable(std::uint64_t place) const {
    return const_cast<T*>(at<T>(place));
  }

  template <typename Node>
  [[nodiscard]] NodeArray nodes(std::uint64_t offset, std::uint64_t count) const {
    if (count == 0) return {};
    const std::uint64_t first = kTreePlace + offset;  // may wrap round, and is too small then
    if (first < kTreePlace || first > bytes_.size() || count > (bytes_.size() - first) / sizeof(Node) ||
        first % NANOVDB_DATA_ALIGNMENT != 0)
      refuse("a node of a sparse grid lies outside its memory");
    return {first, count};
  }

  template <typename Child>
  static void check_child(std::uint64_t parent, std::int64_t offset, const NodeArray& children) {
    // Modulo 2^64: what lies before the first child is far behind the last.
    const std::uint64_t place = parent + static_cast<std::uint64_t>(offset) - children.first;
    if (place % sizeof(Child) != 0 || place / sizeof(Child) >= children.count)
      refuse("a node of a sparse grid leads nowhere");
  }

  template <typename Node, typename Child>
  void check_children(const NodeArray& parents, std::uint32_t tiles, const NodeArray& children) const {
    for (std::uint64_t i = 0; i < parents.count; ++i) {
      const std::uint64_t place = parents.first + i * sizeof(Node);
      const Node& node = *at<Node>(place);
      for (std::uint32_t n = 0; n < tiles; ++n) {
        if (node.isChild(n)) check_child<Child>(place, node.mTable[n].child, children);
      }
    }
  }

  template <typename Node>
  void map_tiles(const NodeArray& nodes, std::uint32_t tiles, const std::function<float(float)>& f) const {
    for (std::uint64_t i = 0; i < nodes.count; ++i) {
      Node& node = *writable<Node>(nodes.first + i * sizeof(Node));
      for (std::uint32_t n = 0; n < tiles; ++n) {
        if (!node.isChild(n)) node.mTable[n].value = f(node.mTable[n].value);
      }
    }
  }

  std::span<const std::byte> bytes_;
  std::uint64_t root_ = 0;
  std::uint64_t tiles_ = 0;  ///< of the root
  NodeArray uppers_, lowers_, leaves_;
};

}  // namespace

SparseNumbers::SparseNumbers(std::span<const std::byte> bytes, std::shared_ptr<const void> owner,
                             const Index3& shift, const Index3& points)
    : bytes_(bytes), owner_(std::move(owner)), shift_(shift), points_(points), size_(1), root_(nullptr) {
  for (int axis = 0; axis < 3; ++axis) {
    if (shift[axis] < 0 || shift[axis] >= kBlockSide) refuse("a sparse grid is shifted by more than a block");
    const auto n = as_size(points[axis]);
    if (points[axis] < 1 || n > kMostSparsePoints / size_) refuse("a sparse grid has no sensible size");
    size_ *= n;
  }
  const NanoTree tree(bytes);
  tree.check();
  root_ = tree.root();
}

float SparseNumbers::background() const noexcept {
  return static_cast<const nano::Root*>(root_)->background();
}

SparseBlock SparseNumbers::block(const Index3& b) const noexcept {
  const nanovdb::Coord voxel(kBlockSide * b.x, kBlockSide * b.y, kBlockSide * b.z);
  const auto& root = *static_cast<const nano::Root*>(root_);
  const auto* tile = root.probeTile(voxel);
  if (tile == nullptr) return {nullptr, root.background()};
  if (!tile->isChild()) return {nullptr, tile->value};
  const nano::Upper& upper = *root.data()->getChild(tile);
  const std::uint32_t in_upper = nano::Upper::CoordToOffset(voxel);
  if (!upper.data()->isChild(in_upper)) return {nullptr, upper.data()->getValue(in_upper)};
  const nano::Lower& lower = *upper.data()->getChild(in_upper);
  const std::uint32_t in_lower = nano::Lower::CoordToOffset(voxel);
  if (!lower.data()->isChild(in_lower)) return {nullptr, lower.data()->getValue(in_lower)};
  return {lower.data()->getChild(in_lower)->data()->mValues, 0.0F};
}

float SparseNumbers::operator[](std::size_t index) const noexcept {
  const auto x = as_size(points_.x), y = as_size(points_.y);
  const Index3 v =
      Index3(static_cast<int>(index % x), static_cast<int>(index / x % y), static_cast<int>(index / x / y)) +
      shift_;
  return block(v / kBlockSide).at(v);
}

void SparseNumbers::copy(const PointBox& box, float* to) const noexcept {
  const Index3 size = box.end - box.first;
  const auto row = as_size(size.x);
  const std::size_t slice = row * as_size(size.y);
  const Index3 first = box.first + shift_, last = box.end + shift_ - 1;
  for (int bz = first.z / kBlockSide; bz <= last.z / kBlockSide; ++bz) {
    for (int by = first.y / kBlockSide; by <= last.y / kBlockSide; ++by) {
      for (int bx = first.x / kBlockSide; bx <= last.x / kBlockSide; ++bx) {
        const Index3 b(bx, by, bz);
        const SparseBlock from = block(b);
        const Index3 start = glm::max(kBlockSide * b, first),
                     end = glm::min(kBlockSide * b + (kBlockSide - 1), last);
        for (int z = start.z; z <= end.z; ++z) {
          for (int y = start.y; y <= end.y; ++y) {
            float* out =
                to + as_size(start.x - first.x) + row * as_size(y - first.y) + slice * as_size(z - first.z);
            for (int x = start.x; x <= end.x; ++x) *out++ = from.at({x, y, z});
          }
        }
      }
    }
  }
}

std::shared_ptr<const SparseNumbers> SparseNumbers::mapped(const std::function<float(float)>& f) const {
  auto chunks = std::make_shared<std::vector<SparseChunk>>((bytes_.size() + sizeof(SparseChunk) - 1) /
                                                           sizeof(SparseChunk));
  std::memcpy(chunks->data(), bytes_.data(), bytes_.size());
  const std::span<const std::byte> bytes = std::as_bytes(std::span(std::as_const(*chunks)));
  NanoTree(bytes).map(f);
  return std::make_shared<const SparseNumbers>(bytes, chunks, shift_, points_);
}

}  // namespace palpate
