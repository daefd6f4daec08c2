// A hand moves in a volume, the view stands still: frames in which rays are cast only where something opaque
// has moved (common/render/volume/cached_volume.h) against frames that cast all of them, in turns.
//   build/release/bench/local_redraw_bench TOOTH.nhdr HEAD.nii.gz [pixels] [steps]
// Times are those of the processor, all threads together; the clock's stand beside them. "first" is the frame
// that is kept, "local" the mean of those that follow, "full" of those without; "moved" the share of the
// pixels whose colours a full redraw changes from one frame to the next.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/field/transfer/color_transfer.h"
#include "common/render/gl/context.h"
#include "common/render/scene_renderer.h"
#include "tests/bench/volume/sample_views.h"

namespace palpate::bench {
namespace {

struct Frame {
  double cpu_ms = 0.0, ms = 0.0;

  Frame& operator+=(const Frame& other) {
    cpu_ms += other.cpu_ms;
    ms += other.ms;
    return *this;
  }
};

Frame timed(SceneRenderer& renderer, const SceneView& view, int pixels) {
  const std::clock_t before = std::clock();
  const Stopwatch clock;
  renderer.draw(view, pixels, pixels);
  (void)renderer.finish();
  const double ms = 1e3 * clock.seconds();
  return {1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, ms};
}

/// The scene at step i of `steps`.
using Motion = std::function<void(SceneView&, double part)>;

void run(const std::string& what, SceneView view, const Motion& motion, int pixels, int steps) {
  SceneRenderer local, full;
  Frame first, kept, cast;
  Image before;
  int worst = 0;
  double moved = 0.0;
  for (int i = 0; i <= steps; ++i) {
    motion(view, static_cast<double>(i) / steps);
    view.volume->cache_picture = false;
    const Frame f = timed(full, view, pixels);
    view.volume->cache_picture = true;
    const Frame l = timed(local, view, pixels);
    const Image wanted = full.read(), found = local.read();
    std::size_t others = 0;
    for (std::size_t k = 0; k < wanted.rgba.size(); ++k)
      worst = std::max(worst, std::abs(int{wanted.rgba[k]} - int{found.rgba[k]}));
    for (std::size_t k = 0; i > 0 && k < wanted.rgba.size(); k += 4)
      others += std::equal(wanted.rgba.begin() + static_cast<std::ptrdiff_t>(k),
                           wanted.rgba.begin() + static_cast<std::ptrdiff_t>(k + 3),
                           before.rgba.begin() + static_cast<std::ptrdiff_t>(k))
                    ? 0
                    : 1;
    before = wanted;
    if (i == 0) continue;  // shaders, tables and voxels are made
    moved += static_cast<double>(others) / (static_cast<double>(pixels) * pixels * steps);
    cast += f;
    kept += l;
  }
  // Kept once more, all shaders being there.
  local.forget(PictureCache::kVolume);
  first = timed(local, view, pixels);
  std::printf(
      "  %-22s full %6.1f (%6.1f) first %6.1f (%6.1f) local %6.1f (%6.1f) x%5.2f; moved %4.1f %%; worst "
      "%d/255\n",
      what.c_str(), cast.cpu_ms / steps, cast.ms / steps, first.cpu_ms, first.ms, kept.cpu_ms / steps,
      kept.ms / steps, cast.cpu_ms / kept.cpu_ms, 100.0 * moved, worst);
  std::fflush(stdout);
}

void runs(const std::string& name, const VolumeView& volume, int pixels, int steps) {
  SceneView view;
  view.volume = volume;
  view.bounds = volume.image->bounds();
  view.camera = make_camera(view.bounds, {.azimuth = 30.0, .elevation = 20.0}, 1.0);
  std::printf("%s, %s, %d x %d, CPU ms (clock)\n", name.c_str(), volume.shading ? "shaded" : "not shaded",
              pixels, pixels);
  const Vec3 middle = view.bounds.center(), half = 0.5 * view.bounds.size();
  const auto around = [&](double part, double share) {
    const double angle = 2.0 * 3.14159265358979 * part;
    return middle + share * half * Vec3(std::cos(angle), std::sin(angle), 0.5 * std::sin(2.0 * angle));
  };
  const Motion hand = [&](SceneView& v, double part) {
    v.probe =
        ProbeView{.probe = around(part, 0.55), .proxy = around(part, 0.45), .force = 1.0, .force_cap = 2.0};
  };
  run("probe, band and proxy", view, hand, pixels, steps);
  const Motion line = [&](SceneView& v, double part) {
    v.outline = {{around(part, 0.9), around(part + 0.3, 0.9), around(part + 0.6, 0.9)}};
    v.probe.emplace();
  };
  run("a line", view, line, pixels, steps);
  const Motion large = [&](SceneView& v, double part) {
    hand(v, part);
    v.probe->style.probe_size = v.probe->style.proxy_size = 400.0;
  };
  run("balls of 0.4 heights", view, large, pixels, steps);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 3) {
    std::fprintf(stderr, "usage: local_redraw_bench TOOTH.nhdr HEAD.nii.gz [pixels] [steps]\n");
    return 2;
  }
  const int pixels = argc > 3 ? std::atoi(argv[3]) : 512, steps = argc > 4 ? std::atoi(argv[4]) : 20;
  const OffscreenContext context;
  std::printf("%s\n", gl_description().c_str());
  for (const bool shading : {false, true}) {
    VolumeView tooth = bench::tooth_view(argv[1]);
    tooth.shading = shading;
    bench::runs("tooth", tooth, pixels, steps);
    VolumeView head = bench::head_view(argv[2]);
    head.shading = shading;
    bench::runs("head", head, pixels, steps);
  }
}
