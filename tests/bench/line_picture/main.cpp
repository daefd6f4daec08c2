// Lines beside VTK: the same lines, off-screen, in the picture of a window of the usual size, in one run.
//
//   xvfb-run -a line_picture_bench [--scenes NAME,…] [--rounds N] [--data FOLDER] [--sides palpate|both] [--errors no]
//                      [--out PREFIX]
//
// Scenes: one (two lines: what a picture takes besides), the 600 lines that flow shows of tornado, carotid and disk, abc (2.5 million points of the formula)
// and abc10 (ten million). What is printed of a scene:
//   at rest   a picture in full quality from another place each time: median of interleaved rounds [ms], beside VTK's
//             wide lines without and with four samples, and tubes; the ratio is of two medians of this run
//   turning   as a window does it: FrameBudget chooses the quality, pictures a second and what was given up
//   error     root mean square difference from the same side's picture of three times the pixels along either edge,
//             averaged: 1 is white
// Times by the clock of two cores that nothing else should use; the processor's time of this process stands beside.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/base/version.h"
#include "common/compose/line_view.h"
#include "common/render/budget/frame_budget.h"
#include "common/render/gl/context.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"
#include "common/scene/input.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"
#include "tests/bench/line_picture/vtk_side.h"

namespace palpate::bench {
namespace {

constexpr int kWidth = 1144, kHeight = 841;
constexpr double kBudget = 60.0;  // [ms]
constexpr int kLarger = 3;        // of the pictures that errors are against

struct Scene {
  std::string name, example, file, seeds;
};

std::vector<Scene> scenes() {
  return {{"one", "tornado", "", "random:1"},
          {"tornado", "tornado", "", "speed:300"},
          {"carotid", "", "carotid/carotid.vtk", "speed:300"},
          {"disk", "", "disk/disk_out_ref.ex2", "speed:300"},
          {"abc", "abc", "", "random:2700"},
          {"abc10", "abc", "", "random:11000"}};
}

struct Setup {
  std::vector<std::string> names{"tornado", "carotid", "disk", "abc"};
  std::string data = "../shared/data/flow", out;
  int rounds = 7;
  bool both = true, errors = true;
};

SceneView view_of(const Scene& scene, const std::string& data) {
  InputOptions spec;
  spec.kind = FieldKind::kVector;
  spec.example = scene.example;
  if (!scene.file.empty()) spec.files = {data + "/" + scene.file};
  Input input = Input::open(spec);
  const auto field = input.load_field(0);
  const auto seeds = make_seeds(parse_seeds(scene.seeds), *field, 1);
  TraceOptions options;
  options.backward = true;
  options.max_length = kViewDiagonals * field->diagonal();
  TraceResult traced = trace_lines(*field, seeds, options);
  std::printf("%s: %zu lines, %zu points\n", scene.name.c_str(), traced.lines.size(), traced.points);
  std::fflush(stdout);
  SceneView view;
  view.bounds = field->bounds();
  view.lines = std::make_shared<const std::vector<Line>>(std::move(traced.lines));
  view.show_axes = view.show_color_bar = view.show_outline = false;
  view.aspect = static_cast<double>(kWidth) / kHeight;
  view.camera = make_camera(view.bounds, {}, view.aspect);
  return view;
}

double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double median(std::vector<double> numbers) {
  if (numbers.empty()) return 0.0;
  const auto middle = numbers.begin() + static_cast<std::ptrdiff_t>(numbers.size() / 2);
  std::nth_element(numbers.begin(), middle, numbers.end());
  return *middle;
}

/// Root mean square difference of `small` from the averages of `large`.
double error_of(const Image& small, const Image& large) {
  double sum = 0.0;
  for (int y = 0; y < small.height; ++y) {
    for (int x = 0; x < small.width; ++x) {
      std::array<double, 3> mean{};
      for (int j = 0; j < kLarger; ++j) {
        for (int i = 0; i < kLarger; ++i) {
          const auto pixel = large.pixel(kLarger * x + i, kLarger * y + j);
          for (std::size_t c = 0; c < 3; ++c) mean[c] += pixel[c];
        }
      }
      const auto pixel = small.pixel(x, y);
      for (std::size_t c = 0; c < 3; ++c) {
        const double difference = (mean[c] / (kLarger * kLarger) - pixel[c]) / 255.0;
        sum += difference * difference;
      }
    }
  }
  return std::sqrt(sum / (3.0 * small.width * small.height));
}

struct Side {
  std::string name;
  std::function<double(const Camera&)> draw;  ///< [ms]
  std::function<Image()> read;
  std::function<Image(const Camera&)> large;
  std::vector<double> clock, processor;  ///< [ms]
};

void print_sides(std::vector<Side>& sides, const SceneView& view, const Setup& setup,
                 const std::string& scene) {
  Camera camera = view.camera;
  for (Side& side : sides) side.draw(camera);
  for (int round = 0; round < setup.rounds; ++round) {
    turn(camera, 0.2, 0.02);
    for (Side& side : sides) {
      const double before = processor_ms();
      side.clock.push_back(side.draw(camera));
      side.processor.push_back(processor_ms() - before);
    }
  }
  const double ours = median(sides.front().clock), ours_processor = median(sides.front().processor);
  for (Side& side : sides) {
    side.draw(view.camera);
    const Image picture = side.read();
    const double error = setup.errors ? error_of(picture, side.large(view.camera)) : 0.0;
    if (!setup.out.empty()) write_png(setup.out + scene + "_" + side.name + ".png", picture, {});
    std::printf("  at rest  %-14s %8.1f ms %8.1f ms of processors   / palpate %5.2f %5.2f   error %.4f\n",
                side.name.c_str(), median(side.clock), median(side.processor), median(side.clock) / ours,
                median(side.processor) / ours_processor, error);
    std::fflush(stdout);
  }
}

void print_turning(SceneRenderer& renderer, const SceneView& view, const Setup& setup,
                   const std::string& scene) {
  FrameBudget budget(kBudget);
  SceneView seen = view;
  renderer.draw(seen, kWidth, kHeight);
  budget.rested(renderer.finish());
  budget.begin();
  std::vector<double> clock;
  constexpr int kFrames = 40, kSettled = 15;
  const Stopwatch all;
  double from = 0.0;
  for (int i = 0; i < kFrames; ++i) {
    if (i == kSettled) from = all.seconds();
    turn(seen.camera, 0.02, 0.005);
    renderer.set_line_detail(budget.quality().detail);
    renderer.draw(seen, kWidth, kHeight, budget.quality().resolution);
    renderer.finish();
    if (!renderer.compiled()) budget.drawn(renderer.gpu_milliseconds());
    if (i >= kSettled) clock.push_back(renderer.gpu_milliseconds());
  }
  const double rate = (kFrames - kSettled) / (all.seconds() - from);
  if (!setup.out.empty()) write_png(setup.out + scene + "_turning.png", renderer.read(), {});
  std::sort(clock.begin(), clock.end());
  std::printf("  turning  %5.1f pictures/s, median %.1f ms, worst %.1f ms, resolution %.2f, detail %.2f\n",
              rate, median(clock), clock.back(), budget.quality().resolution, budget.quality().detail);
  renderer.set_line_detail(1.0);
}

void run_scene(const Scene& scene, const Setup& setup) {
  const SceneView view = view_of(scene, setup.data);
  std::vector<std::unique_ptr<VtkSide>> vtk;
  std::unique_ptr<OffscreenContext> context;
  if (setup.both) {
    for (const VtkLines how : {VtkLines::kPlain, VtkLines::kSampled, VtkLines::kTubes})
      vtk.push_back(std::make_unique<VtkSide>(view, how, kWidth, kHeight));
  } else {
    context = std::make_unique<OffscreenContext>();
  }
  const auto enter = [&] {
    if (setup.both) {
      vtk.front()->make_current();
    } else {
      context->make_current();
    }
  };
  enter();
  auto renderer = std::make_unique<SceneRenderer>();
  std::vector<Side> sides(1);
  sides[0].name = "palpate";
  sides[0].draw = [&](const Camera& camera) {
    enter();
    SceneView seen = view;
    seen.camera = camera;
    renderer->draw(seen, kWidth, kHeight);
    return renderer->finish();
  };
  sides[0].read = [&] { return renderer->read(); };
  sides[0].large = [&](const Camera& camera) {
    enter();
    SceneView seen = view;
    seen.camera = camera;
    SceneRenderer large;
    large.draw(seen, kLarger * kWidth, kLarger * kHeight);
    large.finish();
    return large.read();
  };
  const std::vector<std::string> names{"vtk-plain", "vtk-lines", "vtk-tubes"};
  for (std::size_t i = 0; i < vtk.size(); ++i) {
    const VtkLines how = std::vector{VtkLines::kPlain, VtkLines::kSampled, VtkLines::kTubes}[i];
    VtkSide* side = vtk[i].get();
    sides.push_back({names[i],
                     [side](const Camera& camera) {
                       side->look(camera);
                       return side->draw();
                     },
                     [side] { return side->read(); },
                     [&view, how](const Camera& camera) {
                       VtkSide large(view, how, kLarger * kWidth, kLarger * kHeight);
                       large.look(camera);
                       large.draw();
                       return large.read();
                     },
                     {},
                     {}});
  }
  print_sides(sides, view, setup, scene.name);
  enter();
  print_turning(*renderer, view, setup, scene.name);
  std::fflush(stdout);
  enter();
  renderer.reset();
}

std::vector<std::string> split(const std::string& text) {
  std::vector<std::string> parts;
  std::istringstream words(text);
  for (std::string one; std::getline(words, one, ',');) parts.push_back(one);
  return parts;
}

int run(const Setup& setup) {
  {
    const OffscreenContext context;
    std::printf("%s, %s, %d x %d\n", build_text().c_str(), gl_description().c_str(), kWidth, kHeight);
  }
  for (const Scene& scene : scenes()) {
    if (std::find(setup.names.begin(), setup.names.end(), scene.name) != setup.names.end())
      run_scene(scene, setup);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::bench::Setup setup;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i], value = argv[i + 1];
    if (word == "--scenes") setup.names = palpate::bench::split(value);
    if (word == "--rounds") setup.rounds = std::atoi(value.c_str());
    if (word == "--data") setup.data = value;
    if (word == "--out") setup.out = value;
    if (word == "--errors") setup.errors = value != "no";
    if (word == "--sides") setup.both = value == "both";
  }
  try {
    return palpate::bench::run(setup);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "line_picture_bench: %s\n", error.what());
    return 1;
  }
}
