#include "lab/data/volume_quality.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/quantile.h"
#include "common/base/text.h"
#include "common/render/gl/context.h"
#include "common/render/volume/estimate/image_error.h"
#include "common/render/volume/table/gpu_preintegration.h"
#include "common/render/volume/table/preintegration.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/voxel_bricks.h"

namespace palpate {
namespace {

int pixels_of(Effort effort) {
  return effort == Effort::kQuick ? 96 : effort == Effort::kThorough ? 512 : 256;
}

/// Sizes of table 5.3, the larger one where there is time.
constexpr int kSmallFocus = 512, kLargeFocus = 1024;
std::vector<int> focus_pixels_of(Effort effort) {
  if (effort == Effort::kThorough) return {kSmallFocus, kLargeFocus};
  return {effort == Effort::kQuick ? pixels_of(effort) : kSmallFocus};
}

int repeats_of(Effort effort) { return effort == Effort::kQuick ? 1 : effort == Effort::kThorough ? 9 : 5; }

/// Enlarged to `pixels` a side, linearly between the middles of pixels.
FloatImage enlarged(const FloatImage& image, int pixels) {
  const auto n = as_size(pixels);
  FloatImage large{pixels, pixels, std::vector<float>(4 * n * n)};
  const auto place = [&](int i, int count) {
    const double at = std::clamp((i + 0.5) * count / pixels - 0.5, 0.0, count - 1.0);
    const int first = std::min(static_cast<int>(at), std::max(0, count - 2));
    return std::pair(first, at - first);
  };
  for (int y = 0; y < pixels; ++y) {
    const auto [j, v] = place(y, image.height);
    for (int x = 0; x < pixels; ++x) {
      const auto [i, u] = place(x, image.width);
      const int i1 = std::min(i + 1, image.width - 1), j1 = std::min(j + 1, image.height - 1);
      const Rgba a = image.at(i, j), b = image.at(i1, j), c = image.at(i, j1), d = image.at(i1, j1);
      float* const out = large.rgba.data() + 4 * (n * as_size(y) + as_size(x));
      for (std::size_t k = 0; k < 4; ++k) {
        out[k] =
            static_cast<float>((1.0 - v) * ((1.0 - u) * a[k] + u * b[k]) + v * ((1.0 - u) * c[k] + u * d[k]));
      }
    }
  }
  return large;
}

double rms_difference(const FloatImage& a, const FloatImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const double off = i % 4 == 3 ? 0.0 : static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
    sum += off * off;
  }
  return std::sqrt(sum / (0.75 * static_cast<double>(a.rgba.size())));
}

double frame_time(VolumePicture& picture, int repeats) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) times.push_back(picture.draw_again());
  return median(times);
}

std::vector<TableTime> table_times(const VolumeView& view, int repeats) {
  // Printed: incremental computation on a GPU and a CPU of 2004, of 8-bit tables.
  std::vector<TableTime> rows{{8, 59.0, 1421.0}, {128, 85.0, 2944.0}, {256, 113.0, 4554.0}};
  constexpr std::size_t kEntries = 128;
  const auto entries = optical_entries(view.transfer, view.image->lowest, view.image->highest, kEntries, 2.0);
  for (TableTime& row : rows) {
    const auto lengths = as_size(row.lengths);
    std::vector<std::uint16_t> table(4 * kEntries * kEntries * lengths);
    std::vector<double> times;
    for (int i = 0; i <= repeats; ++i) {
      const Stopwatch clock;
      preintegrate(entries, lengths, 0, table);
      if (i > 0) times.push_back(1e3 * clock.seconds());  // the first one touches its memory
    }
    row.milliseconds = median(times);
    row.compute_ms = compute_table_ms(entries, lengths, repeats);
  }
  return rows;
}

/// A box of `share` of the sides of the volume, in the corner next to the viewer.
ConvexShape nearest_corner(const VolumeView& view, const Camera& camera, double share) {
  const Box bounds = view.image->bounds();
  Vec3 corner = bounds.lower;
  for (int a = 0; a < 3; ++a) corner[a] = camera.axes[2][a] > 0.0 ? bounds.upper[a] : bounds.lower[a];
  const Vec3 middle = 0.5 * (bounds.lower + bounds.upper), half = 0.5 * share * (bounds.upper - bounds.lower);
  const Vec3 center = corner + share * (middle - corner);
  // A little more, or the border of the volume would be left to the context by rounding.
  constexpr double kMore = 1.0 + 1e-6;
  return make_box(center, Mat3(Vec3(kMore * half.x, 0.0, 0.0), Vec3(0.0, kMore * half.y, 0.0),
                               Vec3(0.0, 0.0, kMore * half.z)));
}

FocusTable focus_rates(VolumeView view, const Camera& camera, int pixels, int repeats, Progress* progress) {
  // Shares of the sides, and frames a second as they are printed for 512 x 512 and 1024 x 1024 pixels.
  struct Printed {
    double axis, small, large;
  };
  constexpr std::array<Printed, 5> kPrinted{{{1.0, 8.45, 3.60},
                                             {0.79, 11.52, 4.48},
                                             {0.63, 20.28, 7.76},
                                             {0.5, 35.71, 13.19},
                                             {0.4, 63.29, 20.94}}};
  constexpr double kFocusSamples = 4.0, kContextSamples = 1.0;
  FocusTable table{.pixels = pixels, .rows = {}};
  VolumePicture picture(pixels, pixels, VolumePicture::Context::kCurrent);
  view.skip_empty = view.stop_where_opaque = false;
  for (const Printed& printed : kPrinted) {
    if (progress) {
      progress->check();
      progress->advance();
    }
    view.lenses.clear();
    view.shading = printed.axis == 1.0;  // the first row is drawn without a lens, as in the reference
    view.samples_per_voxel = view.shading ? kFocusSamples : kContextSamples;
    view.context = {.viewport = 0.5, .level = 1, .table_entries = view.table_entries / 2};
    if (!view.shading) {
      Lens lens;
      lens.shape = nearest_corner(view, camera, printed.axis);
      lens.samples_per_voxel = kFocusSamples;
      view.lenses.push_back(std::move(lens));
    }
    (void)picture.draw_alone(view, camera);
    table.rows.push_back({printed.axis, pixels == kLargeFocus ? printed.large : printed.small,
                          1e3 / frame_time(picture, repeats)});
  }
  return table;
}

/// Places of a cutting plane across the data axis that is seen most along, about the middle of the volume.
std::vector<VolumeView> moved_planes(const VolumeView& view, const Camera& camera) {
  constexpr int kPlaces = 7;
  constexpr double kWay = 0.2;  // of the side
  const Box bounds = view.image->bounds();
  const Vec3 seen = glm::abs(camera.axes[2]);
  const int axis = seen.x >= std::max(seen.y, seen.z) ? 0 : seen.y >= seen.z ? 1 : 2;
  Vec3 normal{0.0};
  normal[axis] = camera.axes[2][axis] > 0.0 ? 1.0 : -1.0;
  const Vec3 middle = 0.5 * (bounds.lower + bounds.upper);
  std::vector<VolumeView> views;
  for (int i = 0; i < kPlaces; ++i) {
    const double off = kWay * (static_cast<double>(i) / (kPlaces - 1) - 0.5) * bounds.size()[axis];
    views.push_back(view);
    views.back().cuts.push_back({.kept = {normal, glm::dot(normal, middle) + off}});
  }
  return views;
}

std::string asked_for(const VolumeView& view) {
  return short_number(view.samples_per_voxel) + " samples a voxel, " +
         (view.preintegrate ? "preintegrated, " : "") + "tables of " + std::to_string(view.table_entries) +
         " entries, " + (view.shading ? "shaded" : "not shaded");
}

}  // namespace

VolumeQuality run_volume_quality(const VolumeView& given, const std::string& subject, Effort effort,
                                 Progress* progress) {
  VolumeQuality quality;
  quality.subject = subject;
  quality.asked_for = asked_for(given);
  quality.pixels = pixels_of(effort);
  const int pixels = quality.pixels, repeats = repeats_of(effort);
  const std::vector<int> focus_pixels = focus_pixels_of(effort);
  const Camera camera = make_camera(given.image->bounds(), {}, 1.0);
  const OffscreenContext context;
  quality.renderer = gl_description();
  VolumePicture picture(pixels, pixels, VolumePicture::Context::kCurrent);
  constexpr std::size_t kPictures = 32, kFocusRows = 5;
  if (progress) progress->begin("drawing the volume", kPictures + kFocusRows * focus_pixels.size());

  const FloatImage converged = picture.draw(converged_view(given), camera);

  const auto begin_row = [&] {
    if (!progress) return;
    progress->check();
    progress->advance();
  };
  const auto measure = [&](const std::string& method, double parameter, const VolumeView& view,
                           const std::vector<float>& opaque_depth = {}) {
    begin_row();
    const FloatImage image = picture.draw(view, camera, opaque_depth);
    quality.rows.push_back({method, parameter, rms_difference(image, converged),
                            worst_difference(image, converged), frame_time(picture, repeats)});
  };
  for (const double samples : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    VolumeView view = given;
    view.samples_per_voxel = samples;
    measure("samples a voxel", samples, view);
  }
  for (const double samples : {1.0, 4.0, 16.0}) {
    VolumeView view = given;
    view.samples_per_voxel = samples;
    view.preintegrate = false;
    measure("samples a voxel, not preintegrated", samples, view);
  }
  for (const double ratio : {2.0, 4.0}) {
    VolumeView view = given;
    view.far_sampling = ratio;
    measure("times fewer samples at the far end", ratio, view);
  }
  for (const int entries : {16, 32, 64, 128, 256}) {
    VolumeView view = given;
    view.table_entries = entries;
    measure("entries of the table", entries, view);
  }
  for (const double scale : {0.25, 0.35, 0.5, 0.7, 1.0}) {
    begin_row();
    const int small = static_cast<int>(std::lround(scale * pixels));
    VolumePicture smaller(small, small, VolumePicture::Context::kCurrent);
    const FloatImage image = enlarged(smaller.draw(given, camera), pixels);
    quality.rows.push_back({"resolution", scale, rms_difference(image, converged),
                            worst_difference(image, converged), frame_time(smaller, repeats)});
  }
  // Of what lies outside lenses: where there are none, outside a ball that shows the same, so that the
  // converged picture is the same, too.
  VolumeView focused = given;
  quality.made_focus = given.lenses.empty();
  if (quality.made_focus) {
    constexpr double kRadius = 0.2;  // of the diagonal
    const Box bounds = given.image->bounds();
    Lens lens{.shape = make_sphere(0.5 * (bounds.lower + bounds.upper), kRadius * bounds.diagonal())};
    lens.samples_per_voxel = given.samples_per_voxel;
    lens.shading = given.shading;
    lens.colored = given.colored;
    focused.lenses.push_back(std::move(lens));
  }
  for (const double share : {0.25, 0.5, 0.7}) {
    VolumeView view = focused;
    view.context.viewport = share;
    measure("resolution around lenses", share, view);
  }
  for (const int level : {1, 2}) {
    VolumeView view = focused;
    view.context.level = level;
    measure("halvings of voxels around lenses", level, view);
  }
  VolumeView all = given;
  all.skip_empty = false;
  measure("empty bricks drawn, too", given.samples_per_voxel, all);
  all = given;
  all.stop_where_opaque = false;
  measure("rays go on where nothing is seen", given.samples_per_voxel, all);
  if (!given.image->colors) {
    VolumeView bricked = given;
    bricked.storage.brick_cells = kPoolBrickCells;
    measure("voxels in bricks of so many cells", kPoolBrickCells, bricked);
  }
  VolumeView kept = given;
  kept.cache_picture = true;
  const auto pixel_count = as_size(pixels) * as_size(pixels);
  measure("cached while it stands still", given.samples_per_voxel, kept,
          std::vector<float>(pixel_count, 1.0F));

  // Against the converged picture of the last place.
  std::vector<VolumeView> places = moved_planes(given, camera);
  const FloatImage cut = picture.draw(converged_view(places.back()), camera);
  for (const bool slabs : {false, true}) {
    begin_row();
    std::vector<double> times;
    for (VolumeView& view : places) {
      view.cache_slabs = slabs;
      (void)picture.draw_alone(view, camera);  // slabs that lack are made
    }
    for (const VolumeView& view : places) times.push_back(picture.draw_alone(view, camera));
    const FloatImage image = picture.draw(places.back(), camera);
    quality.rows.push_back({slabs ? "plane moves, slabs cached" : "plane moves, no slabs cached",
                            given.samples_per_voxel, rms_difference(image, cut), worst_difference(image, cut),
                            median(times)});
  }

  for (const int size : focus_pixels)
    quality.focus.push_back(focus_rates(given, camera, size, std::min(repeats, 3), progress));
  quality.tables = table_times(given, repeats);
  return quality;
}

}  // namespace palpate
