#include "loaders/dicom/dicom_series.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <tuple>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

// Headers state positions and directions with five digits or so.
constexpr double kSameDirection = 1e-3, kSameStep = 1e-3;
// Of the distance of slices: closer ones are at one place, and those farther from an even place are not even.
constexpr double kSamePlace = 0.05, kEven = 0.05;
constexpr int kMostMissing = 1000;  // between two slices

[[noreturn]] void refuse(const DicomFrame& frame, const std::string& found, const std::string& expected,
                         const std::string& remedy = "") {
  throw input_error({frame.file, "", found, expected, remedy});
}

/// In what two images differ that cannot be slices of one volume; null where they can.
const char* difference(const DicomFrame& a, const DicomFrame& b) {
  const auto close = [](double x, double y) { return std::abs(x - y) <= kSameStep * std::abs(x); };
  if (b.rows != a.rows || b.columns != a.columns) return "size";
  if (b.bits != a.bits || b.is_signed != a.is_signed || b.colors != a.colors) return "type of pixels";
  if (glm::distance(a.along_row, b.along_row) > kSameDirection ||
      glm::distance(a.along_column, b.along_column) > kSameDirection) {
    return "orientation";
  }
  if (!close(a.row_step, b.row_step) || !close(a.column_step, b.column_step)) return "pixel spacing";
  return nullptr;
}

/// Leaves out the few images of another kind that scanners put into a series: localizers, and pictures of a report.
void leave_out_others(std::vector<DicomFrame>& frames, std::vector<std::string>& notes) {
  constexpr std::size_t kMostKinds = 8, kFew = 3, kSlices = 3;
  std::vector<std::vector<std::size_t>> kinds;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto same = std::find_if(kinds.begin(), kinds.end(), [&](const auto& kind) {
      return difference(frames[kind.front()], frames[i]) == nullptr;
    });
    if (same != kinds.end()) {
      same->push_back(i);
    } else if (kinds.size() == kMostKinds) {
      return;
    } else {
      kinds.push_back({i});
    }
  }
  std::size_t largest = 0, most = 0;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (kinds[k].size() > most) largest = k, most = kinds[k].size();
  }
  const std::size_t others = frames.size() - most;
  if (others == 0 || others > kFew || most < std::max(kSlices, 3 * others)) return;
  std::vector<DicomFrame> kept;
  for (const std::size_t i : kinds[largest]) kept.push_back(frames[i]);
  std::string names;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    if (k == largest) continue;
    for (const std::size_t i : kinds[k]) {
      names += (names.empty() ? "" : ", ") + frames[i].file + " (of another " +
               difference(kept.front(), frames[i]) + ")";
    }
  }
  notes.push_back(counted(others, "image") + " that cannot be of the volume left out: " + names);
  frames = std::move(kept);
}

void check_alike(const std::vector<DicomFrame>& frames) {
  const DicomFrame& a = frames.front();
  for (const DicomFrame& b : frames) {
    const char* const differs = difference(a, b);
    if (differs != nullptr) {
      refuse(b, std::string("has another ") + differs + " than " + a.file + " of the same series",
             "images of one volume", "name the files that belong together");
    }
  }
}

/// Where the slices lie along the normal, rising, each once.
std::vector<double> places_of(const std::vector<std::pair<double, std::size_t>>& along) {
  std::vector<double> places;
  double least = HUGE_VAL;
  constexpr double kClose = 1e-2;  // [mm] nearer than this nothing is scanned twice on purpose
  for (std::size_t i = 1; i < along.size(); ++i) {
    const double gap = along[i].first - along[i - 1].first;
    if (gap > kClose) least = std::min(least, gap);
  }
  for (const auto& [place, frame] : along) {
    if (places.empty() ||
        place - places.back() > std::max(kClose, kSamePlace * (least < HUGE_VAL ? least : 0.0)))
      places.push_back(place);
  }
  return places;
}

/// Which step along the normal each place is, from 0 on; those between are missing.
std::vector<std::size_t> steps_of(const std::vector<double>& places, const DicomFrame& first,
                                  bool allow_gaps) {
  std::vector<std::size_t> steps(std::min<std::size_t>(places.size(), 2));
  if (steps.size() == 2) steps[1] = 1;
  if (places.size() < 3) return steps;
  std::vector<double> gaps;
  for (std::size_t k = 1; k < places.size(); ++k) gaps.push_back(places[k] - places[k - 1]);
  std::vector<double> sorted = gaps;
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2),
                   sorted.end());
  const double step = sorted[sorted.size() / 2];
  steps = {0};
  for (std::size_t k = 0; k < gaps.size(); ++k) {
    const double across = gaps[k] / step;
    const bool sensible = across < static_cast<double>(kMostMissing);
    const auto missing = sensible ? static_cast<long>(std::lround(across)) - 1 : 0;
    steps.push_back(steps.back() + as_size(std::max(0L, missing)) + 1);
    if (std::abs(gaps[k] - step) <= kEven * step) continue;
    const std::string between = "between " + short_number(places[k]) + " and " + short_number(places[k + 1]) +
                                " mm along the normal of the slices";
    const bool lacking =
        missing > 0 && std::abs(across - static_cast<double>(missing) - 1.0) <= kEven * across;
    if (lacking && allow_gaps) continue;
    if (lacking) {
      refuse(first,
             "belongs to a series in which " + counted(as_size(missing), "slice") + " of " +
                 short_number(step) + " mm lack" + (missing == 1 ? "s " : " ") + between,
             "all slices of the volume", "copy the missing files here, or leave gaps with --allow-gaps");
    }
    refuse(first,
           "belongs to a series that is not evenly spaced: " + short_number(gaps[k]) + " mm " + between +
               ", " + short_number(step) + " mm elsewhere",
           "slices at even distances", "name the files that belong together");
  }
  return steps;
}

Vec3 ras(const Vec3& lps) { return {-lps.x, -lps.y, lps.z}; }

/// Whether all weighted volumes state one b, and the lengths of their directions which part of it they have: GE's way of
/// several shells.
bool lengths_are_shells(const GradientTable& table) {
  const double largest = table.largest_weighting();
  double longest = 0.0, shortest = HUGE_VAL;
  for (std::size_t v = 0; v < table.weightings.size(); ++v) {
    if (table.unweighted(v)) continue;
    constexpr double kSame = 0.99;
    if (table.weightings[v] < kSame * largest) return false;
    longest = std::max(longest, glm::length(table.directions[v]));
    shortest = std::min(shortest, glm::length(table.directions[v]));
  }
  constexpr double kAlike = 0.95;
  return shortest < kAlike * longest;
}

void take_gradients(DicomSeries& series, std::size_t slices) {
  const auto stated = as_size(std::count_if(series.frames.begin(), series.frames.end(),
                                            [](const DicomFrame& f) { return f.gradient.has_value(); }));
  if (stated == 0) return;
  if (stated < series.frames.size()) {
    series.notes.push_back(counted(series.frames.size() - stated, "image") + " of " +
                           std::to_string(series.frames.size()) + " state no b-value: taken as 0");
  }
  GradientTable table;
  for (std::size_t v = 0; v < series.volumes; ++v) {
    const DicomGradient first = series.frames[v * slices].gradient.value_or(DicomGradient{});
    for (std::size_t k = 1; k < slices; ++k) {
      const DicomFrame& frame = series.frames[v * slices + k];
      const DicomGradient other = frame.gradient.value_or(DicomGradient{});
      const bool same = std::abs(other.weighting - first.weighting) <= 1.0 + 1e-2 * first.weighting &&
                        glm::distance(other.direction, first.direction) <= 1e-2;
      if (!same) {
        refuse(frame,
               "has another diffusion gradient than " + series.frames[v * slices].file +
                   ", which is to be of the same volume",
               "one gradient a volume", "files may be missing or belong to another series");
      }
    }
    table.weightings.push_back(first.weighting);
    table.directions.push_back(ras(first.direction));
  }
  if (!lengths_are_shells(table)) {
    for (Vec3& direction : table.directions) {
      if (direction != Vec3(0.0)) direction = glm::normalize(direction);
    }
  }
  if (table.largest_weighting() > 0.0) series.gradients = std::move(table);
}

/// Of each volume the value that all its images have, where volumes differ in it; nothing where one has several.
std::vector<double> value_of_volumes(const DicomSeries& series, std::size_t slices,
                                     std::optional<double> DicomFrame::*value) {
  std::vector<double> values;
  for (std::size_t v = 0; v < series.volumes; ++v) {
    const std::optional<double> first = series.frames[v * slices].*value;
    for (std::size_t k = 0; k < slices; ++k) {
      const DicomFrame& frame = series.frames[v * slices + k];
      if (!first || (!frame.file.empty() && frame.*value != first)) return {};
    }
    values.push_back(*first);
  }
  return values;
}

/// What the steps of several volumes at one place are.
void take_times(DicomSeries& series, std::size_t slices) {
  const auto rises = [](const std::vector<double>& values) {
    return !values.empty() &&
           std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
  };
  const std::string each = std::to_string(series.volumes) + " images at each place";
  const std::vector<double> echoes = value_of_volumes(series, slices, &DicomFrame::echo);
  const std::vector<double> triggers = value_of_volumes(series, slices, &DicomFrame::trigger);
  if (rises(echoes)) {
    series.times = echoes;
    series.times_are = each + ", of other echo times: steps of time are these, in ms";
  } else if (rises(triggers)) {
    series.times = triggers;
    series.times_are = each + ", of other times after the trigger: steps of time are these, in ms";
  } else {
    for (std::size_t v = 0; v < series.volumes; ++v) series.times.push_back(static_cast<double>(v));
    series.times_are = each + ": steps of time are their numbers, from 0 on";
  }
}

}  // namespace

DicomSeries sort_dicom_series(std::vector<DicomFrame> frames, bool allow_gaps) {
  DicomSeries series;
  leave_out_others(frames, series.notes);
  check_alike(frames);
  const DicomFrame first = frames.front();
  const Vec3 normal = glm::normalize(glm::cross(first.along_row, first.along_column));
  std::vector<std::pair<double, std::size_t>> along;
  for (std::size_t i = 0; i < frames.size(); ++i) along.emplace_back(glm::dot(normal, frames[i].position), i);
  std::sort(along.begin(), along.end());
  const std::vector<double> places = places_of(along);
  const std::vector<std::size_t> steps = steps_of(places, first, allow_gaps);

  // The images of each place in the order in which they were taken: the same number of each is a volume.
  std::vector<std::vector<DicomFrame>> at(places.size());
  for (const auto& [place, i] : along) {
    std::size_t k = 0;
    while (k + 1 < places.size() && std::abs(places[k + 1] - place) < std::abs(places[k] - place)) ++k;
    at[k].push_back(frames[i]);
  }
  series.volumes = 0;
  for (const auto& images : at) series.volumes = std::max(series.volumes, images.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    auto& images = at[k];
    if (images.size() != series.volumes) {
      refuse(images.front(),
             "lies where there " + std::string(images.size() == 1 ? "is one image, " : "are ") +
                 (images.size() == 1 ? "" : std::to_string(images.size()) + " images, ") +
                 std::to_string(series.volumes) + " elsewhere in the series",
             "all slices of all volumes", "files are missing or doubled");
    }
    std::stable_sort(images.begin(), images.end(), [](const DicomFrame& a, const DicomFrame& b) {
      return std::tie(a.temporal, a.acquisition, a.echo, a.trigger, a.instance, a.number) <
             std::tie(b.temporal, b.acquisition, b.echo, b.trigger, b.instance, b.number);
    });
  }
  const std::size_t slices = steps.back() + 1;
  DicomFrame missing = first;
  missing.file.clear();
  series.frames.assign(series.volumes * slices, missing);
  for (std::size_t v = 0; v < series.volumes; ++v) {
    for (std::size_t k = 0; k < at.size(); ++k) series.frames[v * slices + steps[k]] = at[k][v];
  }
  if (slices > at.size()) {
    series.notes.push_back(counted(slices - at.size(), "slice") + " of " + std::to_string(slices) +
                           " missing: no values there");
  }

  if (series.volumes > 1) take_times(series, slices);

  // A slice alone is as thick as it says.
  const bool says = first.thickness > 0.0 && std::isfinite(first.thickness);
  if (slices == 1 && !says)
    series.notes.emplace_back("one slice, which does not say how thick it is: taken as 1 mm");
  Vec3 step = normal * (says ? first.thickness : 1.0);
  if (slices > 1) {
    const Vec3 low = at.front().front().position, high = at.back().front().position;
    step = (high - low) / static_cast<double>(slices - 1);
    for (std::size_t k = 0; k < at.size(); ++k) {
      const double off = glm::distance(at[k].front().position, low + step * static_cast<double>(steps[k]));
      if (off > kEven * glm::length(step) + 0.1 * std::min(first.row_step, first.column_step))
        refuse(at[k].front(), "lies beside the row of the other slices by " + short_number(off) + " mm",
               "slices in a straight row");
    }
  }
  series.topology.points = {first.columns, first.rows, static_cast<int>(slices)};
  series.topology.origin = ras(at.front().front().position);
  series.topology.axes[0] = ras(first.along_row * first.column_step);
  series.topology.axes[1] = ras(first.along_column * first.row_step);
  series.topology.axes[2] = ras(step);
  if (!first.notes.empty()) series.notes.push_back(first.notes);
  if (first.inverted) series.notes.emplace_back("large numbers are dark by its photometric interpretation");
  if (slices == at.size()) take_gradients(series, slices);
  return series;
}

}  // namespace palpate
