#include "common/hand/mode/linear_proposal.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "common/base/text.h"

namespace palpate {
namespace {

using Knot = HapticTransferFunction::Knot;

struct Probed {
  double value = 0.0, gradient = 0.0;
};

/// At the middles of an even lattice; places without a value are left out.
std::vector<Probed> places_of(const ScalarField& field) {
  constexpr int kSide = 40;
  std::vector<Probed> places;
  places.reserve(std::size_t{kSide} * kSide * kSide);
  CellHint hint;
  for (int k = 0; k < kSide; ++k) {
    for (int j = 0; j < kSide; ++j) {
      for (int i = 0; i < kSide; ++i) {
        const Vec3 x = field.bounds().lower + field.bounds().size() * ((Vec3(i, j, k) + 0.5) / double{kSide});
        const ScalarSample value = field.sample(x, hint);
        const VectorSample gradient = field.gradient(x, hint);
        if (value.status != SampleStatus::kOk || gradient.status != SampleStatus::kOk) continue;
        places.push_back({value.value, glm::length(gradient.value)});
      }
    }
  }
  return places;
}

/// @pre `numbers` is not empty.
double quantile(std::vector<double> numbers, double part) {
  const auto at = static_cast<std::ptrdiff_t>(part * static_cast<double>(numbers.size() - 1));
  std::nth_element(numbers.begin(), numbers.begin() + at, numbers.end());
  return numbers[static_cast<std::size_t>(at)];
}

ValueHistogram histogram_of(const std::vector<double>& numbers) {
  constexpr std::size_t kBins = 1024;
  const auto [low, high] = std::ranges::minmax(numbers);
  return bulk_histogram(
      [&](double lower, double upper) {
        return count_values(
            numbers.size(), [&](std::size_t i) { return numbers[i]; }, lower, upper, kBins, 1);
      },
      low, high);
}

/// Local maxima of the smoothed histogram that hold a fiftieth of what the highest does.
std::vector<double> peaks_of(const ValueHistogram& histogram) {
  constexpr std::size_t kBars = 64, kMost = 4;
  constexpr double kSmallest = 0.02;
  if (histogram.counts.size() < kBars || !(histogram.lower < histogram.upper)) return {};
  std::array<double, kBars> bars{}, smooth{};
  for (std::size_t i = 0; i < histogram.counts.size(); ++i)
    bars[i * kBars / histogram.counts.size()] += static_cast<double>(histogram.counts[i]);
  double most = 0.0;
  for (std::size_t i = 0; i < kBars; ++i) {
    constexpr std::array<double, 5> kWeights{1.0, 4.0, 6.0, 4.0, 1.0};
    for (std::size_t w = 0; w < kWeights.size(); ++w) {
      if (i + w >= 2 && i + w - 2 < kBars) smooth[i] += kWeights[w] * bars[i + w - 2];
    }
    most = std::max(most, smooth[i]);
  }
  std::vector<std::size_t> peaks;
  for (std::size_t i = 0; i < kBars; ++i) {
    const double before = i > 0 ? smooth[i - 1] : 0.0, after = i + 1 < kBars ? smooth[i + 1] : 0.0;
    if (smooth[i] > before && smooth[i] >= after && smooth[i] >= kSmallest * most) peaks.push_back(i);
  }
  std::ranges::sort(peaks, [&](std::size_t a, std::size_t b) { return smooth[a] > smooth[b]; });
  if (peaks.size() > kMost) peaks.resize(kMost);
  std::ranges::sort(peaks);
  std::vector<double> values;
  for (const std::size_t peak : peaks) {
    values.push_back(std::lerp(histogram.lower, histogram.upper,
                               (static_cast<double>(peak) + 0.5) / static_cast<double>(kBars)));
  }
  return values;
}

void take_curve(std::span<const Knot> knots, HapticTransferFunction& function) {
  HapticTransferFunction made;
  if (!HapticTransferFunction::make(knots, false, made)) function = made;
}

}  // namespace

bool ScalarStatistics::has_boundaries() const noexcept {
  constexpr double kFewest = 5e-4, kStandsOut = 2.0;
  return boundary > kStandsOut * noise && boundaries >= kFewest;
}

ScalarStatistics scalar_statistics(const ScalarField& field) {
  constexpr double kNoiseOfQuartile = 3.06, kSteepPart = 0.1, kQuarter = 0.25, kHalf = 0.5;
  const std::vector<Probed> places = places_of(field);
  ScalarStatistics statistics;
  if (places.empty()) return statistics;
  std::vector<double> values, gradients, steep, even;
  for (const Probed& place : places) {
    values.push_back(place.value);
    gradients.push_back(place.gradient);
  }
  statistics.values = histogram_of(values);
  statistics.gradients = histogram_of(gradients);
  statistics.noise = kNoiseOfQuartile * quantile(gradients, kQuarter);
  const double least = std::max(statistics.noise, kSteepPart * statistics.gradients.upper);
  for (const Probed& place : places) {
    if (place.gradient > least) steep.push_back(place.gradient);
    if (place.gradient <= statistics.noise) even.push_back(place.value);
  }
  if (!steep.empty()) statistics.boundary = quantile(steep, kHalf);
  statistics.boundaries = static_cast<double>(steep.size()) / static_cast<double>(places.size());
  if (!even.empty()) statistics.materials = peaks_of(histogram_of(even));
  return statistics;
}

LinearSettings proposed(LinearSettings settings, const ScalarStatistics& statistics) {
  constexpr double kFaint = 0.25, kNear = 0.001, kFar = 0.008;  // of the stiffness; [m]
  const bool edges = statistics.has_boundaries();
  settings.measure = edges ? LinearMeasure::kGradient : LinearMeasure::kValue;
  for (LinearAxis& axis : settings.axes) {
    if (edges) {
      axis.kappa = HapticTransferFunction(Knot{statistics.noise, kFaint}, Knot{statistics.boundary, 1.0});
      axis.tau = HapticTransferFunction(Knot{statistics.noise, kNear}, Knot{statistics.boundary, kFar});
      continue;
    }
    const std::size_t count = statistics.materials.size();
    if (count < 2) {
      axis.kappa = HapticTransferFunction(1.0);
      continue;
    }
    std::vector<Knot> knots;
    for (std::size_t i = 0; i < count; ++i) {
      const double rank = static_cast<double>(i) / static_cast<double>(count - 1);
      knots.push_back({statistics.materials[i], std::lerp(kFaint, 1.0, rank)});
    }
    take_curve(knots, axis.kappa);
    for (Knot& knot : knots) knot.value = std::lerp(kNear, kFar, (knot.value - kFaint) / (1.0 - kFaint));
    take_curve(knots, axis.tau);
  }
  return settings;
}

std::string proposal_text(const LinearSettings& settings, const ScalarStatistics& statistics) {
  std::string text = "measure auto: " + std::string(name_of(settings.measure));
  if (statistics.has_boundaries()) {
    text += ", noise up to " + short_number(statistics.noise) + " and boundaries of " +
            short_number(statistics.boundary) + " a data unit";
  } else {
    text += ", no boundary stands out from noise of " + short_number(statistics.noise) + " a data unit";
  }
  if (statistics.materials.empty()) return text;
  text += "; materials at ";
  for (std::size_t i = 0; i < statistics.materials.size(); ++i)
    text += (i > 0 ? ", " : "") + short_number(statistics.materials[i]);
  return text;
}

}  // namespace palpate
