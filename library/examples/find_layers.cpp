// How deep in the wall of a hollow ball its points lie: a mesh of tetrahedra between two spheres.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include <palpate/hearts.h>

int main() {
  namespace palpate = palpate::api;
  constexpr int kAround = 16, kAcross = 8,
                kDeep = 5;  // points round the axis, from pole to pole, through the wall
  std::vector<double> points;
  for (int d = 0; d < kDeep; ++d) {
    const double radius = 1.0 + 0.25 * d;
    for (int a = 1; a <= kAcross; ++a) {
      for (int r = 0; r < kAround; ++r) {
        const double polar = 3.14159265358979 * a / (kAcross + 1),
                     azimuth = 2 * 3.14159265358979 * r / kAround;
        points.insert(points.end(), {radius * std::sin(polar) * std::cos(azimuth),
                                     radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar)});
      }
    }
  }
  const auto at = [](int d, int a, int r) {
    return (static_cast<std::int64_t>(d) * kAcross + a) * kAround + r % kAround;
  };
  std::vector<std::int64_t> cells;  // six tetrahedra a block, about its diagonal
  for (int d = 0; d + 1 < kDeep; ++d) {
    for (int a = 0; a + 1 < kAcross; ++a) {
      for (int r = 0; r < kAround; ++r) {
        const std::int64_t low = at(d, a, r), high = at(d + 1, a + 1, r + 1);
        const std::int64_t ring[] = {at(d, a, r + 1),     at(d, a + 1, r + 1), at(d, a + 1, r),
                                     at(d + 1, a + 1, r), at(d + 1, a, r),     at(d + 1, a, r + 1)};
        for (int i = 0; i < 6; ++i) cells.insert(cells.end(), {low, ring[i], ring[(i + 1) % 6], high});
      }
    }
  }
  const palpate::Layers wall = palpate::layers({.values = points, .owner = nullptr}, cells);
  double worst = 0.0;  // from (1 - 1/r) / (1 - 1/2), which solves Laplace's equation between spheres
  for (int d = 0; d < kDeep; ++d) {
    const double radius = 1.0 + 0.25 * d, depth = wall.depth[static_cast<std::size_t>(at(d, 4, 0))];
    std::printf("radius %.2f: depth %.3f\n", radius, depth);
    worst = std::max(worst, std::abs(depth - 2.0 * (1.0 - 1.0 / radius)));
  }
  return worst < 0.01 ? 0 : 1;
}
