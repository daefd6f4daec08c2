#include "common/field/scalar_lattice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/field/scalar_field.h"
#include "common/math/counter_random.h"

namespace palpate {

Index3 cubic_points(const Box& bounds, int longest) noexcept {
  const Vec3 size = bounds.size();
  const double most = std::max({size.x, size.y, size.z});
  Index3 points{longest};
  for (int axis = 0; axis < 3; ++axis) {
    if (most > 0.0)
      points[axis] = std::max(2, 1 + static_cast<int>(std::lround((longest - 1) * (size[axis] / most))));
  }
  return points;
}

UniformTopology lattice_over(const Box& bounds, const Index3& points) noexcept {
  UniformTopology lattice;
  lattice.points = points;
  lattice.origin = bounds.lower;
  const Vec3 step = bounds.size() / Vec3(points - 1);
  for (int axis = 0; axis < 3; ++axis) {
    lattice.axes[axis] = Vec3(0.0);
    lattice.axes[axis][axis] = step[axis];
  }
  return lattice;
}

DataSet take_scalar(const ScalarSampler& sample, const std::string& name, const UniformTopology& lattice,
                    int threads, Progress* progress) {
  // Rounding must not push points of the border out of the grid: all stand nearer to the middle by so little
  // that no value is another one.
  constexpr double kInwards = 1.0 - 1e-12;
  const Index3 n = lattice.points;
  const auto rows = as_size(n.y) * as_size(n.z);
  const Vec3 middle = 0.5 * Vec3(n - 1);
  std::vector<double> values(rows * as_size(n.x));
  if (progress) progress->begin("resampling " + name, rows);
  parallel_for(rows, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end && !(progress && progress->cancelled()); ++row) {
      CellHint hint;  // of its own for each row: on faces between cells it has a say
      const auto j = static_cast<int>(row % as_size(n.y));
      const auto k = static_cast<int>(row / as_size(n.y));
      for (int i = 0; i < n.x; ++i) {
        const Vec3 g = middle + kInwards * (Vec3(i, j, k) - middle);
        const ScalarSample s = sample(lattice.origin + lattice.axes * g, hint);
        values[row * as_size(n.x) + as_size(i)] =
            s.status == SampleStatus::kOk ? s.value : std::numeric_limits<double>::quiet_NaN();
      }
      if (progress) progress->advance();
    }
  });
  if (progress) progress->check();
  DataSet block;
  block.topology = lattice;
  block.arrays.push_back(make_array(name, Association::kPoint, 1, std::span<const double>(values)));
  return block;
}

LatticeError lattice_error(const ScalarSampler& sample, const DataSet& block, int threads, Progress* progress,
                           std::size_t places) {
  const DataArray& array = block.arrays.front();
  const auto& lattice = std::get<UniformTopology>(block.topology);
  const auto taken = make_scalar_field({block}, {array.name, Association::kPoint, 0}, array.name, threads);

  enum class At : std::uint8_t { kOutside, kHidden, kCompared };
  std::vector<At> at(places);
  std::vector<double> differences(places);
  if (progress) progress->begin("comparing " + array.name, places);
  parallel_for(places, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end && !(progress && progress->cancelled()); ++i) {
      const Vec3 part{uniform_at(3 * i), uniform_at(3 * i + 1), uniform_at(3 * i + 2)};
      const Vec3 x = lattice.origin + lattice.axes * (part * Vec3(lattice.points - 1));
      CellHint hint, taken_hint;
      const ScalarSample s = sample(x, hint), s_h = taken->sample(x, taken_hint);
      if (s.status != SampleStatus::kOk) {
        at[i] = At::kOutside;
      } else if (s_h.status != SampleStatus::kOk) {
        at[i] = At::kHidden;
      } else {
        at[i] = At::kCompared;
        differences[i] = s_h.value - s.value;
      }
      if (progress) progress->advance();
    }
  });
  if (progress) progress->check();

  // In the order of the places, so that threads have no say in the sum. Divided by the range first: squares
  // of what is near 1e200 are not finite.
  const double range = taken->highest() - taken->lowest();
  LatticeError error;
  double squares = 0.0;
  std::size_t outside = 0, hidden = 0;
  for (std::size_t i = 0; i < places; ++i) {
    outside += at[i] == At::kOutside ? 1 : 0;
    hidden += at[i] == At::kHidden ? 1 : 0;
    if (at[i] != At::kCompared) continue;
    ++error.compared;
    if (!(range > 0.0)) continue;
    const double off = std::abs(differences[i]) / range;
    squares += off * off;
    error.worst = std::max(error.worst, off);
  }
  if (error.compared > 0) error.rms = std::sqrt(squares / static_cast<double>(error.compared));
  if (places > 0) error.outside = static_cast<double>(outside) / static_cast<double>(places);
  if (outside < places) error.hidden = static_cast<double>(hidden) / static_cast<double>(places - outside);
  return error;
}

}  // namespace palpate
