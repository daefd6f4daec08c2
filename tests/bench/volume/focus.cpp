// Table 5.3 of Ikits 2006 again: frames with a focus of ever smaller size, its context cheap, beside the
// frame in which all is focus, with the parameters of table 5.2; neither empty-space skipping nor early ray
// termination on either side. The focus is the part of the volume that is closest to the viewer.
//   build/release/bench/focus_bench HEAD.nii.gz [repeats]
// Times are those of the processor, all threads together, as in volume_bench; the clock's stand beside them.

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

#include "common/field/transfer/color_transfer.h"
#include "common/render/camera.h"
#include "common/render/gl/context.h"
#include "common/render/volume/volume_picture.h"
#include "tests/bench/volume/sample_views.h"

namespace palpate::bench {
namespace {

struct Size {
  double axis = 1.0;                    // of the volume
  std::array<double, 2> printed_fps{};  // at 512^2 and 1024^2
};
constexpr std::array<Size, 5> kSizes{{{1.0, {8.45, 3.60}},
                                      {0.79, {11.52, 4.48}},
                                      {0.63, {20.28, 7.76}},
                                      {0.50, {35.71, 13.19}},
                                      {0.40, {63.29, 20.94}}}};

VolumeView view_of(const VolumeView& full, double axis, const Camera& camera) {
  if (axis == 1.0) return full;
  VolumeView view = full;
  const Box box = full.image->bounds();
  const Vec3 half = 0.5 * axis * box.size();
  const Vec3 corner = box.center() + 0.5 * box.size() * glm::sign(camera.axes[2]);
  Lens focus{make_box(corner - half * glm::sign(camera.axes[2]),
                      Mat3(half.x, 0.0, 0.0, 0.0, half.y, 0.0, 0.0, 0.0, half.z))};
  focus.samples_per_voxel = 4.0;
  focus.shading = true;
  view.lenses = {focus};
  view.samples_per_voxel = 1.0;
  view.shading = false;
  view.context = {.viewport = 0.5, .level = 1, .table_entries = 128};
  return view;
}

struct Frame {
  double cpu_ms = 0.0, ms = 0.0;
};

Frame again(VolumePicture& picture) {
  const std::clock_t before = std::clock();
  const double ms = picture.draw_again();
  return {1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC, ms};
}

Frame median(std::vector<Frame> frames) {
  const auto middle = [&](double Frame::*what) {
    std::sort(frames.begin(), frames.end(),
              [&](const Frame& a, const Frame& b) { return a.*what < b.*what; });
    return frames[frames.size() / 2].*what;
  };
  return {middle(&Frame::cpu_ms), middle(&Frame::ms)};
}

void table(const VolumeView& full, int pixels, std::size_t column, int repeats) {
  const Camera camera = make_camera(full.image->bounds(), {.azimuth = 30.0, .elevation = 20.0}, 1.0);
  std::vector<std::unique_ptr<VolumePicture>> pictures;
  std::vector<std::vector<Frame>> frames(kSizes.size());
  for (const Size& size : kSizes) {
    pictures.push_back(std::make_unique<VolumePicture>(pixels, pixels, VolumePicture::Context::kCurrent));
    (void)pictures.back()->draw_alone(view_of(full, size.axis, camera), camera);
  }
  for (int i = 0; i < repeats; ++i) {
    for (std::size_t k = 0; k < pictures.size(); ++k) frames[k].push_back(again(*pictures[k]));
  }
  std::printf("%d x %d    focus, axis   CPU ms (clock)   times the frame rate   printed\n", pixels, pixels);
  const double all = median(frames[0]).cpu_ms;
  for (std::size_t k = 0; k < kSizes.size(); ++k) {
    const Frame frame = median(frames[k]);
    std::printf("  %16.0f %% %8.1f (%6.1f) %15.2f %15.2f\n", 100.0 * kSizes[k].axis, frame.cpu_ms, frame.ms,
                all / frame.cpu_ms, kSizes[k].printed_fps[column] / kSizes[0].printed_fps[column]);
  }
  std::fflush(stdout);
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 2) {
    std::fprintf(stderr, "usage: focus_bench HEAD.nii.gz [repeats]\n");
    return 2;
  }
  const int repeats = argc > 2 ? std::atoi(argv[2]) : 5;
  const OffscreenContext context;
  std::printf("%s\n", gl_description().c_str());
  VolumeView head = bench::head_view(argv[1]);
  head.samples_per_voxel = 4.0;
  head.skip_empty = false;
  head.stop_where_opaque = false;
  const Index3 n = head.image->points;
  std::printf("%d x %d x %d voxels\n", n.x, n.y, n.z);
  bench::table(head, 512, 0, repeats);
  bench::table(head, 1024, 1, repeats);
}
