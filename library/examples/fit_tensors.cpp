// Fits tensors to weighted signals of eight voxels, the first isotropic and the others along x, and prints their anisotropy.

#include <cmath>
#include <cstdio>
#include <vector>

#include <palpate/tensors.h>

int main() {
  namespace palpate = palpate::api;
  palpate::WeightedImage image{
      .grid = {.voxels = {2, 2, 2}}, .signals = {}, .weightings = {0}, .directions = {{}}};
  for (const palpate::Point& d : std::vector<palpate::Point>{
           {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.6, 0.8, 0}, {0.6, 0, 0.8}, {0, 0.6, 0.8}, {-0.6, 0.8, 0}}) {
    image.weightings.push_back(1000);
    image.directions.push_back(d);
  }
  std::vector<float> signals;  // of a voxel after the other: 1000 exp(-b d . D d), D in mm^2/s
  for (int voxel = 0; voxel < 8; ++voxel) {
    const double along = voxel == 0 ? 0.7e-3 : 1.7e-3;
    for (std::size_t v = 0; v < image.weightings.size(); ++v) {
      const palpate::Point& d = image.directions[v];
      const double rate = along * d[0] * d[0] + 0.7e-3 * (d[1] * d[1] + d[2] * d[2]);
      signals.push_back(static_cast<float>(1000 * std::exp(-image.weightings[v] * rate)));
    }
  }
  image.signals = {.values = signals, .owner = nullptr};
  const std::vector<float> fa = palpate::fit_tensors(image, {.masked = false}).measure("fa");
  std::printf("FA %.3f and %.3f\n", fa[0], fa[1]);
  const double expected = std::sqrt(1.0 / (1.7 * 1.7 + 2 * 0.7 * 0.7));  // |l1 - l2| / |(l1, l2, l2)|
  return std::abs(fa[0]) < 1e-3 && std::abs(fa[1] - expected) < 1e-3 ? 0 : 1;
}
