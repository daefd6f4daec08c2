// Time to fill preintegrated tables of the sizes of Ikits 2006, table 5.1, from a float transfer function.
//   build/release/bench/preintegration_bench [threads]
// The reference printed 1421, 2944 and 4554 ms on a CPU of 2004, 59, 85 and 113 ms on its GPU.

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "common/base/clock.h"
#include "common/field/color_transfer.h"
#include "common/render/volume/preintegration.h"

int main(int argc, char** argv) {
  using namespace palpate;
  const int threads = argc > 1 ? std::atoi(argv[1]) : 0;
  const ColorTransfer transfer = make_color_transfer(ColorPreset::kDensity, 0.0, 1.0);
  std::printf("%-16s %10s %10s\n", "table", "median ms", "best ms");
  struct Size {
    std::size_t entries, lengths;
  };
  for (const Size size : {Size{128, 8}, Size{128, 128}, Size{128, 256}, Size{256, 32}, Size{256, 256}}) {
    const auto entries = optical_entries(transfer, 0.0, 1.0, size.entries, 2.0);
    std::vector<std::uint16_t> table(4 * size.entries * size.entries * size.lengths);
    std::vector<double> times;
    for (int i = 0; i < 15; ++i) {
      const Stopwatch clock;
      preintegrate(entries, size.lengths, threads, table);
      times.push_back(1e3 * clock.seconds());
    }
    std::sort(times.begin(), times.end());
    std::printf("%3zu x %3zu x %3zu %10.2f %10.2f\n", size.entries, size.entries, size.lengths, times[7],
                times[0]);
  }
}
