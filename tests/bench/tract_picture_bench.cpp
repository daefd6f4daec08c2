// Tracts in their millions as a window draws them: pictures while the view turns, each within a budget, and
// then at rest until all tracts are there. The smallest set is the measure of the others.
//
//   tract_picture_bench [--lines N,N,…] [--budget MS] [--opacity A] [--no-rest] [--out PREFIX] [FILE.tck]
//
// Without a file the lines are wound through an ellipsoid of the size of a brain, 50 points a millimetre
// apart; with one, its first parts. Without a display, one process, one thread. What is printed of a set:
//   prepared  shuffling and cutting into pieces
//   first     the first picture, compiling shaders included
//   moving    median and worst of pictures while the view turns, and the share of tracts in the last one
//   at rest   until every tract is drawn: in all, and the longest of these pictures, which is how long a hand
//             that moves the view again may wait

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/version.h"
#include "common/load/read_tractogram.h"
#include "common/render/gl/context.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"

namespace palpate::bench {
namespace {

constexpr int kWidth = 1140, kHeight = 870;  // the picture in a window of the usual size
constexpr int kTurns = 40;

struct Setup {
  std::vector<std::size_t> counts{10'000, 100'000, 1'000'000};
  double budget = 60.0;  // [ms]
  double opacity = 1.0;
  bool rest = true;
  std::string file, out;
};

/// Lines that wind through an ellipsoid with half axes of 70, 85 and 60 mm.
std::shared_ptr<const Tractogram> wound_lines(std::size_t count) {
  constexpr int kPoints = 50;
  constexpr double kRadius = 40.0;  // of their curvature [mm], on the average
  const Vec3 axes{70.0, 85.0, 60.0};
  std::mt19937 random{11};
  std::normal_distribution<double> normal;
  const auto direction = [&] {
    const double x = normal(random), y = normal(random), z = normal(random);
    return glm::normalize(Vec3{x, y, z});
  };
  std::uniform_real_distribution<double> share;
  auto lines = std::make_shared<Tractogram>();
  lines->points.reserve(count * kPoints);
  for (std::size_t l = 0; l < count; ++l) {
    Vec3 x = axes * direction() * std::cbrt(share(random));
    Vec3 t = direction();
    const Vec3 turn = direction() / kRadius;
    for (int i = 0; i < kPoints; ++i) {
      lines->points.emplace_back(x);
      const Vec3 scaled = x / axes;
      // Back toward the middle near the surface.
      t = glm::normalize(t + glm::cross(turn, t) - 0.1 * std::max(0.0, glm::length(scaled) - 0.9) * x);
      x += t;
    }
    lines->starts.push_back(lines->points.size());
  }
  return lines;
}

std::shared_ptr<const Tractogram> first_lines(const Tractogram& all, std::size_t count) {
  auto lines = std::make_shared<Tractogram>();
  count = std::min(count, all.line_count());
  const auto last = static_cast<std::ptrdiff_t>(all.starts[count]);
  lines->points.assign(all.points.begin(), all.points.begin() + last);
  lines->starts.assign(all.starts.begin(), all.starts.begin() + static_cast<std::ptrdiff_t>(count) + 1);
  return lines;
}

/// Memory of this process that is in use [MiB].
double resident() {
  std::ifstream status("/proc/self/statm");
  double pages = 0.0;
  status >> pages >> pages;
  return pages * 4.0 / 1024.0;
}

struct Times {
  double prepared = 0.0, first = 0.0, moving = 0.0, worst = 0.0, rest = 0.0, longest = 0.0;  // [ms]
  double memory = 0.0;                                                                       // [MiB]
  int pictures = 0;
};

Times measure(std::shared_ptr<const Tractogram> lines, const Setup& setup) {
  Times times;
  const Stopwatch preparing;
  const auto bundle = make_tract_bundle(std::move(lines));
  times.prepared = 1e3 * preparing.seconds();
  SceneView view;
  view.bounds = bundle->bounds;
  view.show_color_bar = view.show_axes = false;
  view.tracts = TractView{.bundle = bundle, .opacity = setup.opacity};
  view.probe.emplace();
  const OffscreenContext context;
  SceneRenderer renderer;
  const auto draw = [&] {
    renderer.draw(view, kWidth, kHeight, 1.0, setup.budget);
    return renderer.finish();
  };
  constexpr double kAspect = static_cast<double>(kWidth) / kHeight;
  view.camera = make_camera(view.bounds, {}, kAspect);
  times.first = draw();
  std::vector<double> moving;
  for (int i = 0; i < kTurns; ++i) {
    turn(view.camera, 0.05, 0.01);
    moving.push_back(draw());
  }
  std::sort(moving.begin(), moving.end());
  times.moving = moving[moving.size() / 2];
  times.worst = moving.back();
  const auto save = [&](const char* name) {
    if (!setup.out.empty()) write_png(setup.out + name, renderer.read(), {});
  };
  save("_moving.png");
  if (setup.rest) {
    const Stopwatch resting;
    while (!renderer.complete()) {
      times.longest = std::max(times.longest, draw());
      ++times.pictures;
    }
    times.rest = 1e3 * resting.seconds();
    save("_rest.png");
  }
  times.memory = resident();
  return times;
}

int run(const Setup& setup) {
  std::shared_ptr<const Tractogram> all;
  if (!setup.file.empty()) {
    all = std::make_shared<const Tractogram>(read_tractogram(setup.file, nullptr).lines);
  } else {
    all = wound_lines(*std::max_element(setup.counts.begin(), setup.counts.end()));
  }
  {
    const OffscreenContext context;
    std::printf("%s, %s, %d x %d, budget %g ms\n", build_text().c_str(), gl_description().c_str(), kWidth,
                kHeight, setup.budget);
  }
  std::printf("%9s %10s %9s %9s %9s %9s %10s %9s %9s %9s\n", "lines", "points", "prepared", "first", "moving",
              "worst", "at rest", "pictures", "longest", "memory");
  Times least;
  for (const std::size_t count : setup.counts) {
    auto lines = first_lines(*all, count);
    const std::size_t points = lines->points.size();
    const Times t = measure(lines, setup);
    std::printf("%9zu %10zu %6.0f ms %6.0f ms %6.0f ms %6.0f ms %7.2f s %9d %6.0f ms %5.0f MiB\n",
                lines->line_count(), points, t.prepared, t.first, t.moving, t.worst, 1e-3 * t.rest,
                t.pictures, t.longest, t.memory);
    if (count == setup.counts.front()) {
      least = t;
    } else {
      std::printf("%9s moving x%.2f, at rest x%.1f\n", "", t.moving / least.moving,
                  t.rest / std::max(least.rest, 1e-9));
    }
    std::fflush(stdout);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::bench::Setup setup;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    const bool more = i + 1 < argc;
    if (word == "--lines" && more) {
      setup.counts.clear();
      std::istringstream counts(argv[++i]);
      for (std::string one; std::getline(counts, one, ',');) setup.counts.push_back(std::stoul(one));
    } else if (word == "--budget" && more) {
      setup.budget = std::atof(argv[++i]);
    } else if (word == "--opacity" && more) {
      setup.opacity = std::atof(argv[++i]);
    } else if (word == "--out" && more) {
      setup.out = argv[++i];
    } else if (word == "--no-rest") {
      setup.rest = false;
    } else {
      setup.file = word;
    }
  }
  try {
    return palpate::bench::run(setup);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "tract_picture_bench: %s\n", error.what());
    return 1;
  }
}
