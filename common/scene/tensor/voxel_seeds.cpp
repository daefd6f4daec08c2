#include "common/scene/tensor/voxel_seeds.h"

#include <string>

#include "common/base/error.h"

namespace palpate {
namespace {

/// The finalizer of SplitMix64 (Steele, Lea and Flood 2014): a bijection that scatters neighbours.
std::uint64_t mixed(std::uint64_t x) noexcept {
  x += 0x9e3779b97f4a7c15U;
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9U;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111ebU;
  return x ^ (x >> 31U);
}

/// Uniform in [-1/2, 1/2), of a counter.
double offset(std::uint64_t key, std::uint64_t counter) noexcept {
  return static_cast<double>(mixed(key ^ mixed(counter)) >> 11U) * 0x1p-53 - 0.5;
}

}  // namespace

std::vector<Vec3> voxel_seeds(const UniformTopology& image, const std::function<bool(const Vec3&)>& wanted,
                              int per_voxel, std::uint64_t random_seed, std::size_t most) {
  std::vector<Vec3> seeds;
  const auto each = static_cast<std::uint64_t>(per_voxel);
  const std::uint64_t key = mixed(random_seed);
  std::uint64_t voxel = 0;
  for (int k = 0; k < image.points.z; ++k) {
    for (int j = 0; j < image.points.y; ++j) {
      for (int i = 0; i < image.points.x; ++i, ++voxel) {
        const Vec3 index(i, j, k);
        const Vec3 center = image.origin + image.axes * index;
        if (!wanted(center)) continue;
        if (seeds.size() + each > most) {
          throw usage_error("more than " + std::to_string(most) +
                            " seeds; take fewer a voxel or a smaller region");
        }
        if (per_voxel == 1) {
          seeds.push_back(center);
          continue;
        }
        for (std::uint64_t n = 0; n < each; ++n) {
          const std::uint64_t counter = 3 * (voxel * each + n);
          const double x = offset(key, counter), y = offset(key, counter + 1), z = offset(key, counter + 2);
          seeds.push_back(image.origin + image.axes * (index + Vec3{x, y, z}));
        }
      }
    }
  }
  return seeds;
}

}  // namespace palpate
