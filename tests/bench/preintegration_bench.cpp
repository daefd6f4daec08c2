// Time to fill preintegrated tables of the sizes of Ikits 2006, table 5.1, from a float transfer function: by
// the processor, that and the copy to the GPU, and by a compute shader, to the table in the memory of the
// GPU; then what is made anew of them when one point of the function is dragged.
//   build/release/bench/preintegration_bench [threads]
// The reference printed 1421, 2944 and 4554 ms on a CPU of 2004, 59, 85 and 113 ms on its GPU.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/clock.h"
#include "common/field/transfer/color_transfer.h"
#include "common/render/gl/context.h"
#include "common/render/gl/object.h"
#include "common/render/volume/table/gpu_preintegration.h"
#include "common/render/volume/table/preintegration.h"

namespace {

// Median of 15, or of fewer where they take long, after one that compiles and touches memory [ms].
double median_ms(const std::function<void()>& fill) {
  constexpr std::size_t kRuns = 15;
  constexpr double kLong = 2.0;  // [s]
  fill();
  std::vector<double> times;
  const palpate::Stopwatch all;
  do {
    const palpate::Stopwatch clock;
    fill();
    times.push_back(1e3 * clock.seconds());
  } while (times.size() < kRuns && all.seconds() < kLong);
  std::sort(times.begin(), times.end());
  return times[times.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  using namespace palpate;
  const int threads = argc > 1 ? std::atoi(argv[1]) : 0;
  const OffscreenContext context;
  std::printf("%s\n%-16s %13s %13s %13s %13s %13s\n", gl_description().c_str(), "table, median ms",
              "processor", "and copied", "compute", "one point", "of segments");
  const ColorTransfer transfer = make_color_transfer(ColorPreset::kDensity, 0.0, 1.0);
  std::vector<ColorPoint> points = transfer.points();
  points[points.size() / 2].opacity *= 0.9;
  const ColorTransfer dragged(points);
  GpuPreintegration gpu;
  struct Size {
    std::size_t entries, lengths;
  };
  for (const Size size :
       {Size{128, 8}, Size{128, 128}, Size{128, 256}, Size{256, 32}, Size{256, 256}, Size{512, 32}}) {
    const auto entries = optical_entries(transfer, 0.0, 1.0, size.entries, 2.0);
    std::vector<std::uint16_t> table(4 * size.entries * size.entries * size.lengths);
    const auto n = static_cast<GLsizei>(size.entries), layers = static_cast<GLsizei>(size.lengths);
    GLuint name = 0;
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    const GlTexture texture(name);
    glTextureStorage3D(name, 1, GL_RGBA16, n, n, layers);
    const double filled = median_ms([&] { preintegrate(entries, size.lengths, threads, table); });
    const double copied = median_ms([&] {
      preintegrate(entries, size.lengths, threads, table);
      glTextureSubImage3D(name, 0, 0, 0, 0, n, n, layers, GL_RGBA, GL_UNSIGNED_SHORT, table.data());
      glFinish();
    });
    const double computed = median_ms([&] {
      gpu.fill(entries, size.lengths, texture, 0, {0, size.entries - 1});
      glFinish();
    });
    const auto now = optical_entries(dragged, 0.0, 1.0, size.entries, 2.0);
    const EntryRange changed = changed_entries(entries, now).value_or(EntryRange{});
    const double anew = median_ms([&] { preintegrate(now, size.lengths, threads, table, changed); });
    std::printf("%3zu x %3zu x %3zu  %13.2f %13.2f %13.2f %13.2f %12.0f%%\n", size.entries, size.entries,
                size.lengths, filled, copied, computed, anew,
                100.0 * share_of_segments(changed, size.entries));
  }
}
