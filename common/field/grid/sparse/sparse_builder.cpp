#include "common/field/grid/sparse/sparse_builder.h"

#include <algorithm>
#include <bit>
#include <stdexcept>
#include <utility>

#include "common/base/check.h"
#include "common/base/index.h"
#include "common/field/grid/sparse/nano_tree.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

constexpr int kLowerBlocks = 16, kUpperLowers = 32;  // an axis
constexpr int kUpperBlocks = kLowerBlocks * kUpperLowers;

// The very same bits: NaN is itself, and zero is not its negative.
bool same_bits(float a, float b) {
  return std::bit_cast<std::uint32_t>(a) == std::bit_cast<std::uint32_t>(b);
}

template <typename F>
void for_each_index(const Index3& n, F f) {
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) f(Index3(x, y, z));
    }
  }
}

nanovdb::Coord voxel_of(const Index3& block) {
  return {kBlockSide * block.x, kBlockSide * block.y, kBlockSide * block.z};
}

}  // namespace

SparseBuilder::SparseBuilder(const Index3& shift, const Index3& points, float background)
    : shift_(shift), points_(points), blocks_((points + shift + (kBlockSide - 1)) / kBlockSide) {
  std::uint64_t count = 1;
  for (int axis = 0; axis < 3; ++axis) {
    PALPATE_CHECK(shift[axis] >= 0 && shift[axis] < kBlockSide);
    if (points[axis] < 1 || static_cast<std::uint64_t>(points[axis]) > kMostSparsePoints / count)
      throw std::invalid_argument("a sparse grid has no sensible size");
    count *= static_cast<std::uint64_t>(points[axis]);
  }
  ones_.push_back(background);
  contents_.assign(count_of(blocks_), kOne);
}

SparseBuilder::Content SparseBuilder::content_of(float number) {
  if (same_bits(number, ones_.front())) return kOne;
  if (!same_bits(number, ones_.back())) ones_.push_back(number);
  return kOne - static_cast<Content>(ones_.size() - 1);
}

float SparseBuilder::number_of(Content content) const { return ones_[as_size(kOne - content)]; }

SparseBuilder::Content SparseBuilder::at(const Index3& b) const noexcept {
  if (b.x >= blocks_.x || b.y >= blocks_.y || b.z >= blocks_.z) return kOne;
  return contents_[index_in(blocks_, b)];
}

SparseBuilder::Content SparseBuilder::common(const Index3& first, int side) const noexcept {
  const Content all = at(first);
  if (all >= 0) return kMixed;
  const Index3 end = glm::min(first + side, blocks_);
  if (all != kOne && end != first + side) return kMixed;  // beyond the box is the background
  for (int z = first.z; z < end.z; ++z) {
    for (int y = first.y; y < end.y; ++y) {
      for (int x = first.x; x < end.x; ++x) {
        if (contents_[index_in(blocks_, {x, y, z})] != all) return kMixed;
      }
    }
  }
  return all;
}

void SparseBuilder::put(const Index3& b, float number) {
  PALPATE_CHECK(glm::all(glm::greaterThanEqual(b, Index3(0))) && glm::all(glm::lessThan(b, blocks_)));
  contents_[index_in(blocks_, b)] = content_of(number);
}

void SparseBuilder::put(const Index3& b, std::span<const float, kBlockVoxels> numbers) {
  put(b, numbers.front());
  if (std::all_of(numbers.begin(), numbers.end(), [&](float n) { return same_bits(n, numbers.front()); }))
    return;
  contents_[index_in(blocks_, b)] = static_cast<Content>(leaves_.size());
  std::copy(numbers.begin(), numbers.end(), leaves_.emplace_back().begin());
}

// In the order of NanoVDB: grid, tree, root with its tiles, upper nodes, lower nodes, leaves. What nothing
// reads (statistics, masks of active voxels, the transform) stays zero.
std::shared_ptr<const SparseNumbers> SparseBuilder::finish() {
  std::vector<Index3> uppers, lowers;  // their first blocks
  for_each_index((blocks_ + (kUpperBlocks - 1)) / kUpperBlocks, [&](const Index3& u) {
    const std::size_t before = lowers.size();
    bool other = false;  // than the background
    // Those within the box: a long thin one has far more beyond it.
    const Index3 inside = (blocks_ - kUpperBlocks * u + (kLowerBlocks - 1)) / kLowerBlocks;
    for_each_index(glm::min(Index3(kUpperLowers), inside), [&](const Index3& l) {
      const Index3 first = kUpperBlocks * u + kLowerBlocks * l;
      const Content all = common(first, kLowerBlocks);
      if (all == kMixed) lowers.push_back(first);
      other = other || all != kOne;
    });
    if (other || lowers.size() > before) uppers.push_back(kUpperBlocks * u);
  });

  const std::uint64_t tree_at = sizeof(nanovdb::GridData);
  const std::uint64_t root_at = tree_at + sizeof(nano::TreeData);
  const std::uint64_t uppers_at =
      root_at + sizeof(nano::RootData) + uppers.size() * sizeof(nano::RootData::Tile);
  const std::uint64_t lowers_at = uppers_at + uppers.size() * sizeof(nano::UpperData);
  const std::uint64_t leaves_at = lowers_at + lowers.size() * sizeof(nano::LowerData);
  const std::uint64_t end = leaves_at + leaves_.size() * sizeof(nano::LeafData);
  auto chunks =
      std::make_shared<std::vector<SparseChunk>>((end + sizeof(SparseChunk) - 1) / sizeof(SparseChunk));
  auto* const start = reinterpret_cast<std::byte*>(chunks->data());

  auto* grid = reinterpret_cast<nanovdb::GridData*>(start);
  grid->mMagic = NANOVDB_MAGIC_NUMBER;
  grid->mVersion = nanovdb::Version();
  grid->mGridCount = 1;
  grid->mGridSize = end;
  grid->mGridClass = nanovdb::GridClass::Unknown;
  grid->mGridType = nanovdb::GridType::Float;
  auto* tree = reinterpret_cast<nano::TreeData*>(start + tree_at);
  const std::array<std::uint64_t, 4> places{leaves_at, lowers_at, uppers_at, root_at};
  const std::array<std::size_t, 3> counts{leaves_.size(), lowers.size(), uppers.size()};
  for (std::size_t level = 0; level < places.size(); ++level)
    tree->mNodeOffset[level] = places[level] - tree_at;
  for (std::size_t level = 0; level < counts.size(); ++level)
    tree->mNodeCount[level] = static_cast<std::uint32_t>(counts[level]);

  auto* root = reinterpret_cast<nano::RootData*>(start + root_at);
  root->mBackground = ones_.front();
  root->mTableSize = static_cast<std::uint32_t>(uppers.size());
  std::size_t lower = 0;
  for (std::size_t u = 0; u < uppers.size(); ++u) {
    auto* upper = reinterpret_cast<nano::Upper*>(start + uppers_at + u * sizeof(nano::UpperData));
    root->tile(static_cast<std::uint32_t>(u))->setChild(voxel_of(uppers[u]), upper, root);
    for_each_index(Index3(kUpperLowers), [&](const Index3& l) {
      const Index3 first = uppers[u] + kLowerBlocks * l;
      const std::uint32_t place = nano::Upper::CoordToOffset(voxel_of(first));
      nano::UpperData* data = upper->data();
      if (lower == lowers.size() || lowers[lower] != first) {
        data->setValue(place, number_of(common(first, kLowerBlocks)));
        return;
      }
      auto* node = reinterpret_cast<nano::Lower*>(start + lowers_at + lower * sizeof(nano::LowerData));
      ++lower;
      data->mChildMask.setOn(place);
      data->setChild(place, node);
      for_each_index(Index3(kLowerBlocks), [&](const Index3& b) {
        const std::uint32_t tile = nano::Lower::CoordToOffset(voxel_of(first + b));
        const Content content = at(first + b);
        if (content < 0) {
          node->data()->setValue(tile, number_of(content));
          return;
        }
        auto* leaf = reinterpret_cast<nano::LeafData*>(
            start + leaves_at + static_cast<std::uint64_t>(content) * sizeof(nano::LeafData));
        node->data()->mChildMask.setOn(tile);
        node->data()->setChild(tile, leaf);
        leaf->mBBoxMin = voxel_of(first + b);
      });
    });
  }
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    auto* leaf = reinterpret_cast<nano::LeafData*>(start + leaves_at + i * sizeof(nano::LeafData));
    std::copy(leaves_[i].begin(), leaves_[i].end(), leaf->mValues);
  }
  leaves_.clear();
  return std::make_shared<const SparseNumbers>(std::as_bytes(std::span(std::as_const(*chunks))).first(end),
                                               chunks, shift_, points_);
}

}  // namespace palpate
