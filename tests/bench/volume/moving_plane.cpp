// One plane cuts a volume and moves along its normal, the view stands still: frames put together from kept
// slabs (common/render/volume/slab_cache.h) against frames cast anew, in turns.
//   build/release/bench/moving_plane_bench TOOTH.nhdr HEAD.nii.gz [pixels] [steps]
// Times are those of the processor, all threads together, as in volume_bench; the clock's stand beside them.
// "new" frames all rays cast; "kept" mean of the whole drag, forth and back: "at once" with all pictures of
// slabs made on the way, "rested" with those made before it while the view stood still, as a window does, in
// the time that stands behind. "first" is the first of these frames, "rest" those that made none. A plane
// faces the viewer, or what it cuts away lies behind; goes along the view; goes along z; goes obliquely.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/field/transfer/color_transfer.h"
#include "common/render/camera.h"
#include "common/render/gl/context.h"
#include "common/render/volume/volume_picture.h"
#include "tests/bench/volume/sample_views.h"

namespace palpate::bench {
namespace {

struct Frame {
  double cpu_ms = 0.0, ms = 0.0;
};

Frame timed(const std::function<void()>& draw) {
  const std::clock_t before = std::clock();
  const Stopwatch clock;
  draw();
  const double ms = 1e3 * clock.seconds();
  return {1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, ms};
}

Frame mean(const std::vector<Frame>& frames) {
  Frame sum;
  for (const Frame& each : frames) {
    sum.cpu_ms += each.cpu_ms / static_cast<double>(frames.size());
    sum.ms += each.ms / static_cast<double>(frames.size());
  }
  return sum;
}

// Frames put together from kept slabs.
struct Kept {
  explicit Kept(int pixels) : picture(pixels, pixels, VolumePicture::Context::kCurrent) {}

  void take(VolumeView view, const Camera& camera, const FloatImage& wanted, bool counts) {
    view.cache_slabs = true;
    const int programs = picture.cost().programs;
    const std::uint64_t before = picture.cost().slab_bytes;
    const Frame put = timed([&] { (void)picture.draw_alone(view, camera); });
    const bool same = picture.cost().slab_bytes == before && picture.cost().programs == programs;
    worst = std::max(worst, worst_difference(wanted, picture.draw(view, camera)));
    if (!counts) return;
    if (all.empty()) {
      first = put;
    } else if (same) {
      rest.push_back(put);
    }
    all.push_back(put);
  }

  VolumePicture picture;
  std::vector<Frame> all, rest;
  Frame first;
  double worst = 0.0;
};

// @param n of the plane, towards what is cut away.
void drag(const std::string& name, VolumeView view, const Camera& camera, const Vec3& n, int pixels,
          int steps) {
  Kept at_once(pixels), rested(pixels);
  VolumePicture anew(pixels, pixels, VolumePicture::Context::kCurrent);
  const Box box = view.image->bounds();
  const Vec3 half = 0.5 * box.size();
  const double reach = glm::dot(glm::abs(n), half), middle = glm::dot(n, box.center());
  view.cuts = {{.kept = {glm::normalize(n), 0.0}}};
  std::vector<Frame> all_new;
  Frame preparing;
  for (int i = 0; i <= steps; ++i) {
    // Forth and back over the inner fifth.
    view.cuts[0].kept.offset = middle + 0.2 * reach * std::sin(2.0 * 3.14159265358979 * (i + 0.3) / steps);
    view.cache_slabs = false;
    const Frame cast = timed([&] { (void)anew.draw_alone(view, camera); });
    const FloatImage wanted = anew.draw(view, camera);
    const bool counts = i > 0;  // before, nothing has moved: tables, voxels and shaders are made
    if (counts) all_new.push_back(cast);
    at_once.take(view, camera, wanted, counts);
    rested.take(view, camera, wanted, counts);
    if (counts) continue;
    preparing = timed([&] {
      while (rested.picture.prepare_slabs(0)) continue;
    });
  }
  const Frame n0 = mean(all_new), k0 = mean(at_once.all), r0 = mean(at_once.rest), k1 = mean(rested.all);
  std::printf(
      "  %-16s new %5.1f (%5.1f) at once %5.1f (%5.1f) x%.2f, first %5.1f, rest %4.1f x%5.2f; rested %4.1f "
      "(%4.1f) x%5.2f, first %4.1f, made in %.0f (%.0f); worst %.2f/255, %.0f MB\n",
      name.c_str(), n0.cpu_ms, n0.ms, k0.cpu_ms, k0.ms, n0.cpu_ms / k0.cpu_ms, at_once.first.cpu_ms,
      r0.cpu_ms, n0.cpu_ms / r0.cpu_ms, k1.cpu_ms, k1.ms, n0.cpu_ms / k1.cpu_ms, rested.first.cpu_ms,
      preparing.cpu_ms, preparing.ms, 255.0 * std::max(at_once.worst, rested.worst),
      static_cast<double>(rested.picture.cost().slab_bytes) / 1e6);
  std::fflush(stdout);
}

void drags(const std::string& name, const VolumeView& view, int pixels, int steps) {
  const Camera camera = make_camera(view.image->bounds(), {.azimuth = 30.0, .elevation = 20.0}, 1.0);
  std::printf("%s, %s, %d x %d, CPU ms (clock)\n", name.c_str(), view.shading ? "shaded" : "not shaded",
              pixels, pixels);
  const std::array<std::pair<const char*, Vec3>, 5> planes{
      {{"faces the viewer", camera.axes[2]},
       {"cuts behind", -camera.axes[2]},
       {"along the view", camera.axes[0]},
       {"along z", {0.0, 0.0, 1.0}},
       {"oblique", glm::normalize(Vec3(1.0, -2.0, 1.5))}}};
  for (const auto& [what, n] : planes) drag(what, view, camera, n, pixels, steps);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 3) {
    std::fprintf(stderr, "usage: moving_plane_bench TOOTH.nhdr HEAD.nii.gz [pixels] [steps]\n");
    return 2;
  }
  const int pixels = argc > 3 ? std::atoi(argv[3]) : 512, steps = argc > 4 ? std::atoi(argv[4]) : 40;
  const OffscreenContext context;
  std::printf("%s\n", gl_description().c_str());
  for (const bool shading : {false, true}) {
    VolumeView tooth = bench::tooth_view(argv[1]);
    tooth.shading = shading;
    bench::drags("tooth", tooth, pixels, steps);
    VolumeView head = bench::head_view(argv[2]);
    head.shading = shading;
    bench::drags("head", head, pixels, steps);
  }
}
