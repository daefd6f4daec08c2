#include "common/hand/mode/haptic_surfaces.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/value_histogram.h"

namespace palpate {
namespace {

/// Drawn at a steady rate by a software rasteriser, too.
constexpr std::size_t kMostTriangles = 1'000'000;
/// What has been at work for longer makes way for the next [s].
constexpr double kPatience = 0.4;

/// The parts of the way from a to b, from 0 to 1, between which it lies in the box; the first is not below
/// the second where it misses.
std::array<double, 2> part_inside(const Box& box, const Vec3& a, const Vec3& b) {
  double first = 0.0, last = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double d = b[axis] - a[axis];
    if (d == 0.0) {
      if (a[axis] < box.lower[axis] || a[axis] > box.upper[axis]) return {1.0, 0.0};
      continue;
    }
    const double in = ((d > 0.0 ? box.lower : box.upper)[axis] - a[axis]) / d;
    const double out = ((d > 0.0 ? box.upper : box.lower)[axis] - a[axis]) / d;
    first = std::max(first, in);
    last = std::min(last, out);
  }
  return {first, last};
}

}  // namespace

std::optional<Vec3> first_surface_between(const HapticLevels& levels, const Vec3& from, const Vec3& to) {
  if (!levels.field || !is_finite(from) || !is_finite(to)) return std::nullopt;
  const auto [first, last] = part_inside(levels.field->bounds(), from, to);
  if (!(first < last)) return std::nullopt;
  CellHint hint;
  const auto at = [&](double part) { return from + part * (to - from); };
  const auto value = [&](double part) {
    const ScalarSample sample = levels.field->sample(at(part), hint);
    return sample.status == SampleStatus::kOk ? sample.value : std::nan("");
  };
  constexpr int kSamples = 2048, kBisections = 50;
  double before = std::nan(""), part_before = first;
  for (int n = 0; n <= kSamples; ++n) {
    double part = first + (last - first) * n / kSamples;
    const double here = value(part);
    for (int l = 0; l < levels.isovalues.count && std::isfinite(before) && std::isfinite(here); ++l) {
      const double level = levels.isovalues.value[as_size(l)];
      if ((before >= level) == (here >= level)) continue;
      double low = part_before;
      for (int i = 0; i < kBisections; ++i) {
        const double middle = 0.5 * (low + part);
        ((value(middle) >= level) == (before >= level) ? low : part) = middle;
      }
      return at(low);
    }
    before = here;
    part_before = part;
  }
  return std::nullopt;
}

std::optional<double> haptic_level(const HapticLevels& levels, double value) {
  // Proxies are on their surface to rounding; a level next to it is far farther away.
  constexpr double kOnSurface = 1e-6;
  if (!levels.field) return std::nullopt;
  const double near = kOnSurface * (levels.field->highest() - levels.field->lowest());
  for (int l = 0; l < levels.isovalues.count; ++l) {
    const double level = levels.isovalues.value[as_size(l)];
    if (std::abs(value - level) <= near) return level;
  }
  return std::nullopt;
}

std::string beyond_values(const ScalarField& field, const Isovalues& isovalues) {
  std::string words;
  int count = 0;
  for (int i = 0; i < isovalues.count; ++i) {
    const double level = isovalues.value[as_size(i)];
    if (level >= field.lowest() && level <= field.highest()) continue;
    words += (count++ > 0 ? ", " : "") + short_number(level);
  }
  if (count == 0) return {};
  return (count > 1 ? "isovalues " : "isovalue ") + words + (count > 1 ? " lie" : " lies") +
         " outside the values of " + field.name() +
         (field.lowest() > field.highest()
              ? ", none of which is finite"
              : ", " + short_number(field.lowest()) + " to " + short_number(field.highest())) +
         ": no surface there";
}

HapticSurfaces::HapticSurfaces(std::function<void()> wake)
    : wake_(std::move(wake)), thread_([this](const std::stop_token& stop) { run(stop); }) {}

HapticSurfaces::~HapticSurfaces() {
  const std::lock_guard lock(mutex_);
  if (progress_) progress_->cancel();
}

void HapticSurfaces::request(const HapticLevels& levels) {
  if (levels == asked_) return;
  asked_ = levels;
  const std::lock_guard lock(mutex_);
  const bool other_field = levels.field != wanted_levels_.field;
  if (progress_ && (other_field || progress_->seconds_in_stage() > kPatience)) progress_->cancel();
  if (other_field) made_ = {};
  wanted_levels_ = levels;
  waiting_.reset();
  if (levels.field) waiting_ = levels;
  wanted_.notify_one();
}

HapticSurfaces::Made HapticSurfaces::made() const {
  const std::lock_guard lock(mutex_);
  return made_;
}

std::optional<double> HapticSurfaces::fraction() const {
  const std::lock_guard lock(mutex_);
  if (!progress_) return std::nullopt;
  return std::clamp(progress_->fraction(), 0.0, 1.0);
}

HapticSurfaces::Made HapticSurfaces::make(const HapticLevels& levels, const Made& before,
                                          Progress& progress) const {
  Made made{.histogram = before.histogram};
  if (!made.histogram && levels.field->lowest() <= levels.field->highest()) {
    made.histogram = std::make_shared<const ValueHistogram>(value_histogram(*levels.field));
  }
  for (int i = 0; i < levels.isovalues.count; ++i) {
    const double level = levels.isovalues.value[as_size(i)];
    const auto known = std::find_if(before.meshes.begin(), before.meshes.end(),
                                    [&](const auto& mesh) { return mesh && mesh->level == level; });
    if (known != before.meshes.end()) {
      made.meshes.push_back(*known);
      continue;
    }
    try {
      made.meshes.push_back(std::make_shared<const IsosurfaceMesh>(
          make_isosurface_mesh(*levels.field, level, kMostTriangles, &progress)));
    } catch (const Error& error) {
      made.meshes.push_back(nullptr);
      made.problem = error.what();
    }
  }
  if (made.problem.empty()) made.problem = beyond_values(*levels.field, levels.isovalues);
  return made;
}

void HapticSurfaces::run(const std::stop_token& stop) {
  for (;;) {
    HapticLevels levels;
    Made before;
    std::shared_ptr<Progress> progress;
    {
      std::unique_lock lock(mutex_);
      if (!wanted_.wait(lock, stop, [this] { return waiting_.has_value(); })) return;
      levels = *std::exchange(waiting_, std::nullopt);
      before = made_;
      progress = progress_ = std::make_shared<Progress>();
    }
    std::optional<Made> made;
    try {
      made = make(levels, before, *progress);
    } catch (const Cancelled&) {
      made.reset();  // another request has come
    } catch (const std::exception& error) {
      made = Made{.problem = error.what()};
    }
    {
      const std::lock_guard lock(mutex_);
      progress_.reset();
      if (made && wanted_levels_.field == levels.field) made_ = std::move(*made);
    }
    wake_();
  }
}

}  // namespace palpate
