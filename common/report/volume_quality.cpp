#include "common/report/volume_quality.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/base/clock.h"
#include "common/render/gl/context.h"
#include "common/render/volume/image_error.h"
#include "common/render/volume/preintegration.h"
#include "common/render/volume/table_timing.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxel_bricks.h"

namespace palpate {
namespace {

int pixels_of(Effort effort) {
  return effort == Effort::kQuick ? 96 : effort == Effort::kThorough ? 512 : 256;
}

int repeats_of(Effort effort) { return effort == Effort::kQuick ? 1 : effort == Effort::kThorough ? 9 : 5; }

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Enlarged to `pixels` a side, linearly between the middles of pixels.
FloatImage enlarged(const FloatImage& image, int pixels) {
  const auto n = static_cast<std::size_t>(pixels);
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
      float* const out =
          large.rgba.data() + 4 * (n * static_cast<std::size_t>(y) + static_cast<std::size_t>(x));
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
    const auto lengths = static_cast<std::size_t>(row.lengths);
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

std::vector<FocusRate> focus_rates(VolumeView view, const Camera& camera, VolumePicture& picture, int repeats,
                                   Progress* progress) {
  std::vector<FocusRate> rows{{1.0, 8.45}, {0.79, 11.52}, {0.63, 20.28}, {0.5, 35.71}, {0.4, 63.29}};
  constexpr double kFocusSamples = 4.0, kContextSamples = 1.0;
  view.skip_empty = view.stop_where_opaque = false;
  for (FocusRate& row : rows) {
    if (progress) progress->check();
    view.lenses.clear();
    view.shading = row.axis == 1.0;  // the first row is drawn without a lens, as in the reference
    view.samples_per_voxel = view.shading ? kFocusSamples : kContextSamples;
    view.context = {.viewport = 0.5, .level = 1, .table_entries = view.table_entries / 2};
    if (!view.shading) {
      Lens lens;
      lens.shape = nearest_corner(view, camera, row.axis);
      lens.samples_per_voxel = kFocusSamples;
      view.lenses.push_back(std::move(lens));
    }
    (void)picture.draw(view, camera);
    row.rate = 1e3 / frame_time(picture, repeats);
  }
  return rows;
}

}  // namespace

VolumeQuality run_volume_quality(const VolumeView& given, const std::string& subject, Effort effort,
                                 Progress* progress) {
  VolumeQuality quality;
  quality.subject = subject;
  quality.pixels = pixels_of(effort);
  const int pixels = quality.pixels, repeats = repeats_of(effort);
  const Camera camera = make_camera(given.image->bounds(), {}, 1.0);
  const OffscreenContext context;
  quality.renderer = gl_description();
  VolumePicture picture(pixels, pixels, VolumePicture::Context::kCurrent);
  if (progress) progress->begin("drawing the volume", given.lenses.empty() ? 25 : 30);

  const FloatImage converged = picture.draw(converged_view(given), camera);

  const auto measure = [&](const std::string& method, double parameter, const VolumeView& view,
                           const std::vector<float>& opaque_depth = {}) {
    if (progress) {
      progress->check();
      progress->advance();
    }
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
    if (progress) {
      progress->check();
      progress->advance();
    }
    const int small = static_cast<int>(std::lround(scale * pixels));
    VolumePicture smaller(small, small, VolumePicture::Context::kCurrent);
    const FloatImage image = enlarged(smaller.draw(given, camera), pixels);
    quality.rows.push_back({"resolution", scale, rms_difference(image, converged),
                            worst_difference(image, converged), frame_time(smaller, repeats)});
  }
  // Of what lies outside lenses, where the picture has some.
  for (const double share : {0.25, 0.5, 0.7}) {
    if (given.lenses.empty()) break;
    VolumeView view = given;
    view.context.viewport = share;
    measure("resolution around lenses", share, view);
  }
  for (const int level : {1, 2}) {
    if (given.lenses.empty()) break;
    VolumeView view = given;
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
  kept.keep_picture = true;
  const auto pixel_count = static_cast<std::size_t>(pixels) * static_cast<std::size_t>(pixels);
  measure("kept while it stands still", given.samples_per_voxel, kept, std::vector<float>(pixel_count, 1.0F));

  quality.focus = focus_rates(given, camera, picture, repeats, progress);
  quality.tables = table_times(given, repeats);
  return quality;
}

}  // namespace palpate
