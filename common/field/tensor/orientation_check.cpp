#include "common/field/tensor/orientation_check.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/gradient_table.h"
#include "common/math/lattice.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr const char* kAxisNames = "ijk";
/// Below it a main direction is mostly noise.
constexpr double kLeastAnisotropy = 0.2;

/// The half of a voxel's 26 neighbours that makes each pair count once.
std::vector<Index3> half_neighbourhood() {
  std::vector<Index3> offsets;
  for (int k = 0; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      for (int i = -1; i <= 1; ++i) {
        if (k > 0 || j > 0 || (j == 0 && i > 0)) offsets.emplace_back(i, j, k);
      }
    }
  }
  return offsets;
}

}  // namespace

Mat3 AxisTurn::matrix() const noexcept {
  Mat3 m{0.0};
  for (std::size_t row = 0; row < 3; ++row) m[from[row]][static_cast<int>(row)] = flipped[row] ? -1.0 : 1.0;
  return m;
}

bool AxisTurn::is_identity() const noexcept { return matrix() == Mat3{1.0}; }

std::string AxisTurn::words() const {
  std::string permute, flip;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    permute += kAxisNames[from[axis]];
    if (flipped[axis]) flip += kAxisNames[axis];
  }
  std::string text;
  if (permute != kAxisNames) text = "--permute " + permute;
  if (!flip.empty()) text += (text.empty() ? "--flip " : " --flip ") + flip;
  return text;
}

std::vector<AxisTurn> axis_turns() {
  std::vector<AxisTurn> turns;
  std::array<int, 3> from{0, 1, 2};
  do {
    for (int flip = -1; flip < 3; ++flip) {
      AxisTurn turn{from, {}};
      if (flip >= 0) turn.flipped[as_size(flip)] = true;
      turns.push_back(turn);
    }
  } while (std::next_permutation(from.begin(), from.end()));
  return turns;
}

DirectionMap::DirectionMap(std::span<const float> tensors, const UniformTopology& topology, int threads)
    : points_(topology.points), axes_(topology.axes), directions_(tensors.size() / 6) {
  parallel_for(directions_.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t v = first; v < last; ++v) {
      const float* const d = tensors.data() + 6 * v;
      directions_[v] = {};
      if (!std::all_of(d, d + 6, [](float x) { return std::isfinite(x); })) continue;
      const SymmetricEigen eigen =
          symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
      const double fa = fractional_anisotropy(eigen.values);
      // An anisotropy near one is the mark of a negative eigenvalue: noise.
      if (!(fa > kLeastAnisotropy) || has_negative(eigen.values)) continue;
      for (std::size_t axis = 0; axis < 3; ++axis)
        directions_[v][axis] = static_cast<float>(eigen.vectors[0][static_cast<int>(axis)]);
      directions_[v][3] = static_cast<float>(fa);
    }
  });
  count_ = static_cast<std::size_t>(
      std::count_if(directions_.begin(), directions_.end(), [](const auto& d) { return d[3] > 0.0F; }));
}

std::vector<double> DirectionMap::coherence(std::span<const Mat3> turns, int threads) const {
  const std::vector<Index3> offsets = half_neighbourhood();
  // (T d) . o = d . (T^T o).
  std::vector<Vec3> lines;
  for (const Index3& offset : offsets) {
    const Vec3 o = glm::normalize(axes_ * Vec3(offset));
    for (const Mat3& turn : turns) lines.push_back(glm::transpose(turn) * o);
  }
  const auto slices = as_size(points_.z);
  std::vector<double> sums(slices * turns.size(), 0.0);  // a row a slice: the order of sums is fixed
  parallel_for(slices, threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t slice = first; slice < last; ++slice) {
      double* const sum = sums.data() + slice * turns.size();
      const int k = static_cast<int>(slice);
      const auto at = [&](const Index3& p) { return directions_[index_in(points_, p)]; };
      for (int j = 0; j < points_.y; ++j) {
        for (int i = 0; i < points_.x; ++i) {
          const Index3 here{i, j, k};
          const auto u = at(here);
          if (!(u[3] > 0.0F)) continue;
          for (std::size_t n = 0; n < offsets.size(); ++n) {
            const Index3 there = here + offsets[n];
            if (there.x < 0 || there.y < 0 || there.x >= points_.x || there.y >= points_.y ||
                there.z >= points_.z) {
              continue;
            }
            const auto v = at(there);
            if (!(v[3] > 0.0F)) continue;
            const double weight = static_cast<double>(u[3]) * static_cast<double>(v[3]);
            for (std::size_t t = 0; t < turns.size(); ++t) {
              const Vec3& o = lines[n * turns.size() + t];
              const double a = glm::dot(Vec3{u[0], u[1], u[2]}, o), b = glm::dot(Vec3{v[0], v[1], v[2]}, o);
              const double part = a * a * b * b;
              sum[t] += weight * part * part;
            }
          }
        }
      }
    }
  });
  std::vector<double> scores(turns.size(), 0.0);
  for (std::size_t slice = 0; slice < slices; ++slice) {
    for (std::size_t t = 0; t < turns.size(); ++t) scores[t] += sums[slice * turns.size() + t];
  }
  return scores;
}

OrientationVerdict check_orientation(const DirectionMap& directions, const UniformTopology& topology,
                                     int threads) {
  // Fewer voxels are no anatomy; and a gain that chance does not give.
  constexpr std::size_t kLeastVoxels = 200;
  constexpr double kClear = 1.03;
  OrientationVerdict verdict;
  if (directions.size() < kLeastVoxels) return verdict;
  // Where voxels are long, the lines between neighbours crowd around their long axis and favour some turns.
  constexpr double kMostUneven = 2.0;
  const Vec3 steps{glm::length(topology.axes[0]), glm::length(topology.axes[1]),
                   glm::length(topology.axes[2])};
  if (std::max({steps.x, steps.y, steps.z}) > kMostUneven * std::min({steps.x, steps.y, steps.z}))
    return verdict;
  const Mat3 image = image_axes(topology.axes);
  const std::vector<AxisTurn> turns = axis_turns();
  std::vector<Mat3> matrices;
  matrices.reserve(turns.size());
  for (const AxisTurn& turn : turns) matrices.push_back(image * turn.matrix() * glm::transpose(image));
  const std::vector<double> scores = directions.coherence(matrices, threads);
  const auto best = std::max_element(scores.begin(), scores.end());
  if (!(scores.front() > 0.0)) return verdict;
  verdict.best = turns[as_size(best - scores.begin())];
  verdict.gain = *best / scores.front();
  verdict.suspicious = verdict.gain > kClear;
  return verdict;
}

}  // namespace palpate
