// Volumes beside VTK's GPU volume mapper: same data, transfer function, camera and OpenGL context, in turns.
//   xvfb-run -a build/release/bench/volume_bench TOOTH.nhdr HEAD.nii.gz [pixels] [repeats] [folder]
// Times are those of the processor, all threads together: on a software rasteriser the work itself, whatever
// else the machine does; on a GPU look at the clock's, which stand beside them. For either side, frame time
// against the root mean square error (of the sRGB components, 1 is white) from its own converged picture, for
// ever more samples a voxel; then the frame times where the errors are 0.005 and 0.002, interpolated in the
// logarithms of both.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "common/field/transfer/color_transfer.h"
#include "common/render/camera.h"
#include "common/render/gl/context.h"
#include "common/render/png.h"
#include "common/render/volume/volume_picture.h"
#include "tests/bench/volume/vtk_side.h"

namespace palpate::bench {
namespace {

struct Row {
  double cpu_ms = 0.0, ms = 0.0, error = 0.0;
};

Picture bytes_of(const FloatImage& image) {
  Picture picture{image.width, image.height, {}};
  for (std::size_t i = 0; i < image.rgba.size(); ++i) {
    if (i % 4 != 3)
      picture.rgb.push_back(
          static_cast<std::uint8_t>(std::lround(255.0F * std::clamp(image.rgba[i], 0.0F, 1.0F))));
  }
  return picture;
}

double rms(const Picture& a, const Picture& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) {
    const double d = (a.rgb[i] - b.rgb[i]) / 255.0;
    sum += d * d;
  }
  return std::sqrt(sum / static_cast<double>(a.rgb.size()));
}

// Frames of one side.
struct Times {
  std::vector<double> cpu_ms, ms;

  void add(const std::function<double()>& draw) {
    const std::clock_t before = std::clock();
    ms.push_back(draw());
    cpu_ms.push_back(1e3 * static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC);
  }
};

double median(std::vector<double> times) {
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

// The time of the processor at which the error falls to `error`; NaN where the rows do not reach so far.
double time_at(const std::vector<Row>& rows, double error) {
  for (std::size_t i = 1; i < rows.size(); ++i) {
    const Row& a = rows[i - 1];
    const Row& b = rows[i];
    if (a.error < error || b.error > error) continue;
    const double part = std::log(a.error / error) / std::log(a.error / b.error);
    return a.cpu_ms * std::pow(b.cpu_ms / a.cpu_ms, part);
  }
  return rows.front().error <= error ? rows.front().cpu_ms : std::nan("");
}

void save(const Picture& picture, const std::string& file) {
  Image image{picture.width, picture.height, {}};
  const auto row = 3 * static_cast<std::size_t>(picture.width);
  for (int y = picture.height - 1; y >= 0; --y) {
    for (std::size_t x = 0; x < row; x += 3) {
      const std::uint8_t* p = picture.rgb.data() + row * static_cast<std::size_t>(y) + x;
      image.rgba.insert(image.rgba.end(), {p[0], p[1], p[2], 255});
    }
  }
  write_png(file, image, {});
}

void compare(const std::string& name, VolumeView view, int pixels, int repeats, const std::string& folder) {
  const Camera camera = make_camera(view.image->bounds(), {.azimuth = 30.0, .elevation = 20.0}, 1.0);
  VtkSide vtk(view, camera, pixels, pixels);
  vtk.make_current();
  VolumePicture ours(pixels, pixels, VolumePicture::Context::kCurrent);

  std::printf("%s\n", gl_description().c_str());
  constexpr double kConverged = 32.0;
  VolumeView best = view;
  best.samples_per_voxel = kConverged;
  best.table_entries = 1024;
  const Picture our_best = bytes_of(ours.draw(best, camera));
  vtk.draw(kConverged);
  const Picture vtk_best = vtk.read();
  std::printf("%s, %s, %d x %d; both converged: %.4f apart\n", name.c_str(),
              view.shading ? "shaded" : "not shaded", pixels, pixels, rms(our_best, vtk_best));

  if (!folder.empty()) {
    const std::string stem = folder + "/" + name + (view.shading ? "_shaded" : "");
    save(our_best, stem + "_palpate.png");
    save(vtk_best, stem + "_vtk.png");
  }

  constexpr double kEnough = 0.002;
  std::vector<Row> our_rows, vtk_rows;
  std::printf("  samples a voxel  Palpate CPU ms, ms, error        VTK CPU ms, ms, error\n");
  for (const double samples : {0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0}) {
    const bool our_turn = our_rows.empty() || our_rows.back().error > kEnough;
    const bool vtk_turn = vtk_rows.empty() || vtk_rows.back().error > kEnough;
    Picture our_picture, vtk_picture;
    Times our_times, vtk_times;
    vtk.make_current();
    view.samples_per_voxel = samples;
    if (our_turn) our_picture = bytes_of(ours.draw(view, camera));
    if (vtk_turn) vtk.draw(samples);
    if (vtk_turn) vtk_picture = vtk.read();
    for (int i = 0; i < repeats; ++i) {
      if (our_turn) our_times.add([&] { return ours.draw_again(); });
      if (vtk_turn) vtk_times.add([&] { return vtk.draw(samples); });
    }
    if (our_turn)
      our_rows.push_back({median(our_times.cpu_ms), median(our_times.ms), rms(our_picture, our_best)});
    if (vtk_turn)
      vtk_rows.push_back({median(vtk_times.cpu_ms), median(vtk_times.ms), rms(vtk_picture, vtk_best)});
    const auto text = [](bool turn, const std::vector<Row>& rows) {
      char cell[40] = "";
      if (turn)
        std::snprintf(cell, sizeof cell, "%8.1f %8.1f %8.4f", rows.back().cpu_ms, rows.back().ms,
                      rows.back().error);
      return std::string(cell);
    };
    std::printf("  %15g %27s %27s\n", samples, text(our_turn, our_rows).c_str(),
                text(vtk_turn, vtk_rows).c_str());
    std::fflush(stdout);
  }
  for (const double error : {0.005, 0.002}) {
    const double a = time_at(our_rows, error), b = time_at(vtk_rows, error);
    std::printf("  error %.3f: %.1f ms and %.1f ms, %.2f times the frame rate\n", error, a, b, b / a);
  }
}

}  // namespace
}  // namespace palpate::bench

// Functions without opacities below 1e-4, which VTK takes as they are whatever the step: its pictures would
// grow denser with every sample.
palpate::ColorTransfer tooth_colors() {
  return palpate::ColorTransfer({{0.0, {0.2F, 0.1F, 0.1F}, 0.0},
                                 {499.0, {0.6F, 0.3F, 0.2F}, 0.0},
                                 {500.0, {0.6F, 0.3F, 0.2F}, 0.005},
                                 {800.0, {0.9F, 0.6F, 0.3F}, 0.08},
                                 {1000.0, {1.0F, 0.9F, 0.7F}, 0.1},
                                 {1300.0, {1.0F, 1.0F, 1.0F}, 0.5}});
}

palpate::ColorTransfer head_colors() {
  return palpate::ColorTransfer({{0.0, {0.1F, 0.05F, 0.04F}, 0.0},
                                 {59.0, {0.4F, 0.2F, 0.2F}, 0.0},
                                 {60.0, {0.4F, 0.2F, 0.2F}, 0.002},
                                 {120.0, {0.8F, 0.5F, 0.4F}, 0.04},
                                 {200.0, {1.0F, 0.9F, 0.8F}, 0.2},
                                 {255.0, {1.0F, 1.0F, 1.0F}, 0.4}});
}

int main(int argc, char** argv) {
  using namespace palpate;
  if (argc < 3) {
    std::fprintf(stderr, "usage: volume_bench TOOTH.nhdr HEAD.nii.gz [pixels] [repeats] [folder]\n");
    return 2;
  }
  const int pixels = argc > 3 ? std::atoi(argv[3]) : 512, repeats = argc > 4 ? std::atoi(argv[4]) : 5;
  const std::string folder = argc > 5 ? argv[5] : "";
  for (const bool shading : {false, true}) {
    VolumeView tooth;
    tooth.image = bench::read_sample(argv[1]);
    tooth.transfer = tooth_colors();
    tooth.shading = shading;
    bench::compare("tooth", tooth, pixels, repeats, folder);
    VolumeView head;
    head.image = bench::read_sample(argv[2]);
    head.transfer = head_colors();
    head.shading = shading;
    bench::compare("head", head, pixels, repeats, folder);
  }
}
