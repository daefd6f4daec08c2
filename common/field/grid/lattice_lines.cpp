#include "common/field/grid/lattice_lines.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/index.h"

namespace palpate {
namespace {

/// The interval that holds `place`, of numbers that rise; the outermost ones beyond the ends.
std::size_t interval_of(const std::vector<double>& rising, double place) noexcept {
  const auto above = std::upper_bound(rising.begin() + 1, rising.end() - 1, place);
  return static_cast<std::size_t>(above - rising.begin()) - 1;
}

}  // namespace

Vec3 LatticeLines::grid(const Vec3& mean) const noexcept {
  Vec3 g = mean;
  for (int a = 0; a < 3; ++a) {
    const std::vector<double>& x = at[as_size(a)];
    if (x.empty()) continue;
    const std::size_t i = interval_of(x, mean[a]);
    g[a] = static_cast<double>(i) + (mean[a] - x[i]) / (x[i + 1] - x[i]);
  }
  return g;
}

Vec3 LatticeLines::mean(const Vec3& grid) const noexcept {
  Vec3 m = grid;
  for (int a = 0; a < 3; ++a) {
    const std::vector<double>& x = at[as_size(a)];
    if (x.empty()) continue;
    const double last = static_cast<double>(x.size() - 2);
    const double whole = std::clamp(std::floor(grid[a]), 0.0, last);
    const auto i = static_cast<std::size_t>(whole);
    m[a] = x[i] + (grid[a] - whole) * (x[i + 1] - x[i]);
  }
  return m;
}

double LatticeLines::finest(int axis) const noexcept {
  const std::vector<double>& x = at[as_size(axis)];
  double least = 1.0;
  for (std::size_t i = 1; i < x.size(); ++i) least = std::min(least, x[i] - x[i - 1]);
  return least;
}

UnevenLattice uneven_lattice(const RectilinearTopology& grid, double rounding) {
  UnevenLattice lattice;
  LatticeLines lines;
  bool uneven = false;
  for (int a = 0; a < 3; ++a) {
    const std::vector<double>& x = grid.coordinates[as_size(a)];
    const std::size_t n = x.size();
    lattice.mean.points[a] = static_cast<int>(n);
    lattice.mean.origin[a] = n > 0 ? x.front() : 0.0;
    lattice.mean.axes[a] = Vec3{0.0};
    double& step = lattice.mean.axes[a][a];
    step = n > 1 ? (x.back() - x.front()) / static_cast<double>(n - 1) : 1.0;
    std::vector<double> at(n);
    bool even = true;
    for (std::size_t i = 0; i < n; ++i) {
      at[i] = i + 1 < n ? (x[i] - x.front()) / step : static_cast<double>(i);
      even = even && std::abs(at[i] - static_cast<double>(i)) <= rounding;
    }
    uneven = uneven || !even;
    if (!even) lines.at[as_size(a)] = std::move(at);
  }
  if (uneven) lattice.lines = std::make_shared<const LatticeLines>(std::move(lines));
  return lattice;
}

}  // namespace palpate
