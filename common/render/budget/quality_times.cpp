#include "common/render/budget/quality_times.h"

#include <algorithm>
#include <numeric>

namespace palpate {
namespace {

constexpr double kFading = 0.85;  // weight of a change, of the next one's
constexpr double kNewest = 0.5;   // weight of a frame in the mean of its quality
constexpr double kTie = 0.002;
constexpr double kLeast = 0.02;  // no part is nothing
constexpr int kSweeps = 100;

template <std::size_t N>
double dot(const std::array<double, N>& a, const std::array<double, N>& b) noexcept {
  return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
}

}  // namespace

QualityTimes::QualityTimes(bool volume, bool lenses) noexcept {
  if (volume) usual_ = lenses ? Parts{0.05, 0.10, 0.40, 0.45, 0.0} : Parts{0.05, 0.10, 0.85, 0.0, 0.0};
  p_ = usual_;
}

QualityTimes::Parts QualityTimes::parts_of(const FrameQuality& quality) noexcept {
  const double pixels = quality.resolution * quality.resolution;
  return {1.0, pixels, pixels * quality.context * quality.viewport * quality.viewport, pixels * quality.focus,
          quality.detail};
}

double QualityTimes::of(const FrameQuality& quality) const noexcept { return dot(p_, parts_of(quality)); }

void QualityTimes::add(const FrameQuality& quality, double milliseconds) noexcept {
  if (!known() || quality != last_.quality) {
    before_ = last_;
    last_ = {quality, milliseconds};
    if (before_.milliseconds > 0.0) ++change_count_;
  } else {
    last_.milliseconds += kNewest * (milliseconds - last_.milliseconds);
  }
  if (change_count_ > 0) changes_[(change_count_ - 1) % kChanges] = {before_, last_};
  fit();
}

// The minimum of (2) along one u after the other: of a sum of squares with a bound for each these steps come
// to the one there is.
void QualityTimes::fit() noexcept {
  const Parts x = parts_of(last_.quality);
  const double usual = dot(usual_, x);
  std::array<Parts, std::tuple_size_v<Parts>> h{};  // of the normal equations h u = g
  Parts g{};
  const auto add_row = [&](double weight, const Parts& a, double b) {
    for (std::size_t j = 0; j < a.size(); ++j) {
      g[j] += weight * a[j] * b;
      for (std::size_t k = 0; k < a.size(); ++k) h[j][k] += weight * a[j] * a[k];
    }
  };
  const auto part_times = [&](const FrameQuality& quality) {
    Parts t = parts_of(quality);
    for (std::size_t j = 0; j < t.size(); ++j) t[j] *= usual_[j];
    return t;
  };
  Parts row = part_times(last_.quality);
  for (double& a : row) a /= usual;
  add_row(1.0, row, 1.0);
  double weight = 1.0;
  for (std::size_t age = 0; age < std::min(change_count_, kChanges); ++age, weight *= kFading) {
    const Change& change = changes_[(change_count_ - 1 - age) % kChanges];
    const Parts from = part_times(change.from.quality), to = part_times(change.to.quality);
    // In units of the usual time, so that changes of all scenes weigh the same.
    const double unit = dot(usual_, parts_of(change.from.quality)) / change.from.milliseconds;
    for (std::size_t j = 0; j < row.size(); ++j)
      row[j] = (to[j] / change.to.milliseconds - from[j] / change.from.milliseconds) / unit;
    add_row(weight, row, 0.0);
  }
  Parts u{1.0, 1.0, 1.0, 1.0, 1.0};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (std::size_t j = 0; j < u.size(); ++j) {
      double rest = g[j] + kTie;
      for (std::size_t k = 0; k < u.size(); ++k) rest -= k == j ? 0.0 : h[j][k] * u[k];
      u[j] = std::max(kLeast, rest / (h[j][j] + kTie));
    }
  }
  for (std::size_t j = 0; j < u.size(); ++j) p_[j] = usual_[j] * u[j];
  const double scale = last_.milliseconds / dot(p_, x);
  for (double& p : p_) p *= scale;
}

}  // namespace palpate
