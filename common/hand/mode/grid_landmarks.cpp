#include "common/hand/mode/grid_landmarks.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <utility>

#include "common/haptics/frame_along.h"

namespace palpate {
namespace {

constexpr std::size_t kPlanes = 192;
constexpr int kPlaces = 32;

/// Lowest and highest of e . x over the corners of a box.
std::pair<double, double> extent(const Box& box, const Vec3& e) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (unsigned corner = 0; corner < 8; ++corner) {
    Vec3 x{0.0};
    for (int a = 0; a < 3; ++a)
      x[a] = (corner >> static_cast<unsigned>(a) & 1U) != 0 ? box.upper[a] : box.lower[a];
    low = std::min(low, glm::dot(e, x));
    high = std::max(high, glm::dot(e, x));
  }
  return {low, high};
}

double between(std::pair<double, double> ends, double part) {
  return ends.first + part * (ends.second - ends.first);
}

using Profile = std::array<double, kPlanes>;

Profile profile_along(const ScalarField& field, const Mat3& axes, int axis) {
  const Vec3 &along = axes[axis], &across = axes[(axis + 1) % 3], &upward = axes[(axis + 2) % 3];
  const auto s = extent(field.bounds(), along), u = extent(field.bounds(), across),
             v = extent(field.bounds(), upward);
  Profile profile{};
  CellHint hint;
  for (std::size_t i = 0; i < kPlanes; ++i) {
    const Vec3 middle = between(s, (static_cast<double>(i) + 0.5) / kPlanes) * along;
    double sum = 0.0;
    int inside = 0;
    for (int j = 0; j < kPlaces; ++j) {
      const Vec3 row = middle + between(u, (j + 0.5) / kPlaces) * across;
      for (int k = 0; k < kPlaces; ++k) {
        const ScalarSample sample = field.sample(row + between(v, (k + 0.5) / kPlaces) * upward, hint);
        if (sample.status != SampleStatus::kOk) continue;
        sum += sample.value - field.lowest();
        ++inside;
      }
    }
    profile[i] = inside > 0 ? sum / inside : 0.0;
  }
  return profile;
}

Profile smoothed(const Profile& profile) {
  Profile result = profile;
  for (std::size_t i = 1; i + 1 < kPlanes; ++i)
    result[i] = 0.25 * profile[i - 1] + 0.5 * profile[i] + 0.25 * profile[i + 1];
  return result;
}

/// By how much the peak at `i` stands out of the lower of the valleys that part it from higher places.
double prominence(const Profile& profile, std::size_t i) {
  const auto valley = [&](int step) {
    double lowest = profile[i];
    for (auto j = static_cast<std::ptrdiff_t>(i); j >= 0 && j < static_cast<std::ptrdiff_t>(kPlanes);
         j += step) {
      const double value = profile[static_cast<std::size_t>(j)];
      if (value > profile[i]) return lowest;
      lowest = std::min(lowest, value);
    }
    return lowest;
  };
  return profile[i] - std::max(valley(-1), valley(1));
}

}  // namespace

Mat3 grid_axes(const GridFrame& frame, const LocalFrame& local) {
  switch (frame.kind) {
    case GridFrame::Kind::kData:
      return local.rotated ? local.rotation : Mat3{1.0};
    case GridFrame::Kind::kWorld:
      break;
    case GridFrame::Kind::kPlane: {
      const Mat3 along = frame_along(glm::normalize(frame.first));
      return {along[1], along[2], along[0]};
    }
    case GridFrame::Kind::kAxes: {
      const Vec3 first = glm::normalize(frame.first), third = glm::normalize(glm::cross(first, frame.second));
      return {first, glm::cross(third, first), third};
    }
  }
  return Mat3{1.0};
}

std::array<GridMark, 3> marks_at(const GridFrame& frame, const LocalFrame& local, const Vec3& x) {
  const Vec3 along = x * grid_axes(frame, local);  // row vector times axes: the coordinates along them
  std::array<GridMark, 3> marks;
  for (int a = 0; a < 3; ++a) marks[static_cast<std::size_t>(a)] = {.axis = a, .at = along[a]};
  return marks;
}

std::vector<double> value_peaks(const ScalarField& field, const Mat3& axes, int axis, int count) {
  constexpr double kLeast = 0.02;
  const Profile profile = smoothed(smoothed(profile_along(field, axes, axis)));
  const auto [low, high] = std::minmax_element(profile.begin(), profile.end());
  std::vector<std::pair<double, std::size_t>> peaks;
  for (std::size_t i = 1; i + 1 < kPlanes; ++i) {
    if (!(profile[i] > profile[i - 1] && profile[i] >= profile[i + 1])) continue;
    const double out = prominence(profile, i);
    if (out > kLeast * (*high - *low)) peaks.emplace_back(-out, i);
  }
  std::sort(peaks.begin(), peaks.end());
  peaks.resize(std::min(peaks.size(), static_cast<std::size_t>(std::max(count, 0))));
  const auto ends = extent(field.bounds(), axes[axis]);
  std::vector<double> places;
  for (const auto& [out, i] : peaks) {
    // The vertex of the parabola through the peak and its neighbours.
    const double left = profile[i - 1], right = profile[i + 1], bend = left - 2.0 * profile[i] + right;
    const double off = bend < 0.0 ? 0.5 * (left - right) / bend : 0.0;
    places.push_back(between(ends, (static_cast<double>(i) + 0.5 + off) / kPlanes));
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace palpate
