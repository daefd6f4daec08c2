#include "common/render/volume/estimate/image_error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "common/math/power_of_two.h"
#include "common/render/volume/table/preintegration.h"

namespace palpate {

namespace {

constexpr double kSamples = 32.0;
constexpr int kEntries = 512;

}  // namespace

VolumeView converged_view(VolumeView view) {
  view.samples_per_voxel = kSamples;
  for (Lens& lens : view.lenses) lens.samples_per_voxel = kSamples;
  view.far_sampling = 1.0;
  view.context = {};
  // Steps so short show the same from tables of few lengths.
  view.table_entries = kEntries;
  view.table_lengths = static_cast<int>(kLengthGroup);
  view.preintegrate = true;
  view.skip_empty = view.stop_where_opaque = false;
  view.cache_slabs = view.cache_picture = false;
  return view;
}

VolumeView sampled_view(VolumeView view, double context, double focus) {
  view.samples_per_voxel *= context * power_of_two(-view.context.level);
  for (Lens& lens : view.lenses) lens.samples_per_voxel *= focus;
  view.far_sampling = 1.0;
  view.context = {};
  view.cache_slabs = view.cache_picture = false;
  return view;
}

VolumeView finer_view(VolumeView view, int doublings) {
  VolumeView finer = sampled_view(std::move(view), power_of_two(doublings), power_of_two(doublings));
  finer.samples_per_voxel = std::min(finer.samples_per_voxel, kSamples);
  for (Lens& lens : finer.lenses) lens.samples_per_voxel = std::min(lens.samples_per_voxel, kSamples);
  finer.table_entries = std::max(finer.table_entries, kEntries);
  // Of shorter steps fewer lengths lie as densely; a table of all of them takes 64 MB while the picture rests.
  const auto group = static_cast<int>(kLengthGroup);
  finer.table_lengths = std::max(group, (finer.table_lengths >> doublings) / group * group);
  finer.preintegrate = true;
  return finer;
}

int most_doublings(const VolumeView& view) noexcept {
  double fewest = view.samples_per_voxel * power_of_two(-view.context.level);
  for (const Lens& lens : view.lenses) fewest = std::min(fewest, lens.samples_per_voxel);
  return std::max(1, static_cast<int>(std::ceil(std::log2(kSamples / fewest))));
}

bool is_converged(const ImageError& error) noexcept {
  constexpr double kStep = 1.5 / 255.0;  // one, whatever its rounding
  return error.worst < kStep;
}

PixelLattice PixelLattice::of(int width, int height, int round) noexcept {
  const int side =
      static_cast<int>(std::sqrt(static_cast<double>(width) * height / kErrorPixels)) / 2 * 2 + 1;
  const int largest = (std::min(width, height) - 1) / 2 * 2 + 1;
  PixelLattice lattice;
  lattice.step = std::min(side + 2 * round, largest);
  lattice.columns = (width + lattice.step / 2) / lattice.step;
  lattice.rows = (height + lattice.step / 2) / lattice.step;
  return lattice;
}

void ErrorSum::add(const std::array<int, 4>& shown, const std::array<int, 4>& converged) noexcept {
  constexpr double kFull = 255.0;
  double q = 0.0;
  for (std::size_t c = 0; c < 3; ++c) {
    const int off = std::abs(shown[c] - converged[c]);
    worst_ = std::max(worst_, off);
    q += off * off / (3.0 * kFull * kFull);
  }
  ++pixels_;
  sum_ += q;
  squares_ += q * q;
}

ImageError ErrorSum::error() const noexcept {
  ImageError error;
  error.pixels = pixels_;
  error.of_asked_voxels = of_asked_voxels_;
  if (pixels_ == 0) return error;
  const auto n = static_cast<double>(pixels_);
  const double mean = sum_ / n;
  error.rms = std::sqrt(mean);
  error.worst = worst_ / 255.0;
  if (pixels_ > 1 && mean > 0.0)
    error.spread = std::sqrt(std::max(0.0, squares_ / n - mean * mean) / (n - 1.0) / (4.0 * mean));
  return error;
}

}  // namespace palpate
