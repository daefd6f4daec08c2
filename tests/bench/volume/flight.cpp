// A flight about and into a sparse volume that is larger than the memory given, as the window draws it while
// something moves: bricks are paged in, and the frame budget holds.
//   build/release/bench/sparse_flight_bench [budget ms] [frames] [memory MB] [FILE.vdb] [frames.csv]
//   [picture.png]
//     [clock]
// Without a file, or with "-", the built-in sparse shells of 1024^3. The bar: after the first second 99 % of
// the frames within 1.5 times the budget, none over three times. Times, those that the budget is held by too,
// are of the processor: the drawing thread's, beside which nothing else happens, and those of all others as
// two cores share them. On a software rasteriser that is what the clock shows on a machine that does nothing
// else, or a little more; with "clock" as the last word it is the clock's.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>
#include <vector>

#include <time.h>

#include "common/base/clock.h"
#include "common/field/analytic/volume_examples.h"
#include "common/load/load.h"
#include "common/render/budget/frame_budget.h"
#include "common/render/camera.h"
#include "common/render/gl/context.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate::bench {
namespace {

// Seconds of this process so far, as a machine of two cores that does nothing else would take them.
double work_seconds() {
  const auto seconds_of = [](clockid_t which) {
    timespec time{};
    clock_gettime(which, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  };
  const double drawing = seconds_of(CLOCK_THREAD_CPUTIME_ID), all = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
  return drawing + 0.5 * (all - drawing);
}

struct Frame {
  double ms = 0.0, update_ms = 0.0;
  FrameQuality quality;
  BrickShare bricks;
};

std::shared_ptr<const VolumeImage> open_image(const std::string& file) {
  if (file.empty()) {
    const DataSet block = volume_example("sparse-shells");
    return make_volume_image(block, block.arrays.front().name, "sparse-shells");
  }
  Source source = Source::open({{file}, {}});
  const std::string array = source.arrays().front().name;
  return make_volume_image(source.read({array}).front(), array, file);
}

// Twice around, three times in and out, up and down.
Camera camera_at(const Box& bounds, double part) {
  const double turn = 2.0 * 3.14159265358979 * part;
  return make_camera(bounds,
                     {.azimuth = 720.0 * part,
                      .elevation = 40.0 * std::sin(2.0 * turn),
                      .zoom = std::exp2(1.6 * (1.0 - std::cos(3.0 * turn)))},
                     1.0);
}

double quantile(std::vector<double> times, double part) {
  std::sort(times.begin(), times.end());
  return times[std::min(times.size() - 1,
                        static_cast<std::size_t>(part * static_cast<double>(times.size())))];
}

void fly(double budget, int frames, double memory, const std::string& file, const std::string& csv,
         const std::string& picture, bool by_clock) {
  const Stopwatch watch;
  const auto now = [&] { return by_clock ? watch.seconds() : work_seconds(); };
  SceneView view;
  view.volume.emplace();
  view.volume->image = open_image(file);
  const VolumeImage& image = *view.volume->image;
  std::printf(
      "%d x %d x %d voxels, %.0f MB in memory of %.0f dense, opened in %.2f s\n", image.points.x,
      image.points.y, image.points.z,
      std::ldexp(static_cast<double>(image.sparse ? image.sparse->bytes().size() : image.byte_count()), -20),
      std::ldexp(static_cast<double>(image.byte_count()), -20), now());
  const double low = image.lowest, high = image.highest;
  view.volume->transfer = ColorTransfer({{low + 0.1 * (high - low), {0.2F, 0.3F, 0.8F}, 0.0},
                                         {low + 0.4 * (high - low), {0.9F, 0.6F, 0.3F}, 0.3},
                                         {high, {1.0F, 0.95F, 0.8F}, 0.8}});
  view.volume->storage.memory = static_cast<std::uint64_t>(std::ldexp(memory, 20));
  view.bounds = image.bounds();
  constexpr int kPixels = 512;

  const OffscreenContext context;
  std::printf("%s; budget %.0f ms, %.0f MB of volume memory, %d frames of %d^2\n", gl_description().c_str(),
              budget, memory, frames, kPixels);
  // As LivePicture does.
  SceneRenderer renderer;
  FrameBudget held(budget);
  held.show(true, false);
  constexpr std::uint64_t kUpload = std::uint64_t{8} << 20U;
  view.volume->storage.upload = kUpload;
  std::vector<Frame> all;
  const double start = now();
  double first_second = 0.0;
  for (int i = 0; i < frames; ++i) {
    view.camera = camera_at(view.bounds, static_cast<double>(i) / frames);
    const FrameQuality quality = held.quality();
    const double before = now();
    renderer.draw(with_quality(view, quality), kPixels, kPixels, quality.resolution);
    const double updated = now();
    renderer.finish();
    const double ms = 1e3 * (now() - before);
    all.push_back({ms, 1e3 * (updated - before), quality, renderer.bricks()});
    held.drawn(ms);
    if (now() - start <= 1.0) first_second = static_cast<double>(i + 1);
  }
  if (!picture.empty()) write_png(picture, renderer.read(), {});
  if (!csv.empty()) {
    std::FILE* out = std::fopen(csv.c_str(), "w");
    if (out != nullptr) {
      std::fprintf(out, "frame,ms,update_ms,samples,pixels,held,wanted,all\n");
      for (std::size_t i = 0; i < all.size(); ++i)
        std::fprintf(out, "%zu,%.1f,%.1f,%.2f,%.2f,%zu,%zu,%zu\n", i, all[i].ms, all[i].update_ms,
                     all[i].quality.context, all[i].quality.resolution, all[i].bricks.held,
                     all[i].bricks.wanted, all[i].bricks.all);
      std::fclose(out);
    }
  }
  std::vector<double> times;
  // The frame that the first second ends in counts as one of it.
  for (std::size_t i = static_cast<std::size_t>(first_second) + 1; i < all.size(); ++i)
    times.push_back(all[i].ms);
  if (times.empty()) return;
  const auto within = [&](double share) {
    return 100.0 *
           static_cast<double>(
               std::count_if(times.begin(), times.end(), [&](double ms) { return ms <= share * budget; })) /
           static_cast<double>(times.size());
  };
  std::printf(
      "first frame %.0f ms; after the first second, %zu frames: median %.0f ms, 95 %% %.0f, 99 %% %.0f, most "
      "%.0f\n",
      all.front().ms, times.size(), quantile(times, 0.5), quantile(times, 0.95), quantile(times, 0.99),
      quantile(times, 1.0));
  std::printf("within 1.5 times the budget %.2f %% (bar 99), within 3 times %.2f %% (bar 100)\n", within(1.5),
              within(3.0));
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  const auto text = [&](int i) {
    return argc > i && std::string(argv[i]) != "-" ? std::string(argv[i]) : "";
  };
  const auto number = [&](int i, double otherwise) {
    return text(i).empty() ? otherwise : std::atof(argv[i]);
  };
  palpate::bench::fly(number(1, 200.0), static_cast<int>(number(2, 600.0)), number(3, 512.0), text(4),
                      text(5), text(6), text(7) == "clock");
}
