#include "common/field/analytic/tensor_sampled.h"

#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include "common/base/check.h"
#include "common/math/counter_random.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// The `index`-th number of mean 0 and standard deviation 1: twelve uniform ones less their mean, so that the
/// bits do not depend on libm.
double normal_at(std::uint64_t index) noexcept {
  constexpr std::uint64_t kTerms = 12;
  double sum = -0.5 * static_cast<double>(kTerms);
  for (std::uint64_t term = 0; term < kTerms; ++term) sum += uniform_at(kTerms * index + term);
  return sum;
}

}  // namespace

DataSet sample_tensors(const AnalyticTensor& formula, const Index3& points, double noise) {
  PALPATE_CHECK(points.x >= 2 && points.y >= 2 && points.z >= 2 && noise >= 0.0);
  constexpr std::size_t kComponents = 6;
  const Box box = formula.bounds();
  const Vec3 spacing = box.size() / Vec3(points - 1);
  std::vector<float> values;
  values.reserve(kComponents * count_of(points));
  const auto add = [&values, noise](double value, double part) {
    const auto index = static_cast<std::uint64_t>(values.size());
    values.push_back(static_cast<float>(noise > 0.0 ? value + noise * part * normal_at(index) : value));
  };
  constexpr double kOff = 1.0 / std::numbers::sqrt2;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        const Mat3 d = formula.tensor(box.lower + spacing * Vec3{i, j, k});
        add(d[0][0], 1.0);
        add(d[0][1], kOff);
        add(d[0][2], kOff);
        add(d[1][1], 1.0);
        add(d[1][2], kOff);
        add(d[2][2], 1.0);
      }
    }
  }
  UniformTopology topology;
  topology.points = points;
  topology.origin = box.lower;
  for (int axis = 0; axis < 3; ++axis) {
    topology.axes[axis] = Vec3{0.0};
    topology.axes[axis][axis] = spacing[axis];
  }
  DataSet image;
  image.name = formula.name();
  image.topology = topology;
  image.arrays.push_back(
      make_array(kTensorArray, Association::kPoint, kComponents, std::span<const float>(values)));
  return image;
}

}  // namespace palpate
