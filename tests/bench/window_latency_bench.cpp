// From what the hand does to the picture that shows it: turning lines, following one, dragging the crosshair through
// slices beside a volume, editing a transfer function.
//
//   xvfb-run -a -s '-screen 0 1600x1200x24' window_latency_bench [--seconds N] [--data FOLDER] [--budget MS] [--acts NAME,…]
//
// The windows are those of `flow` and `grid`, 1440 x 900, panels and all; the mouse moves in each frame. An event comes at
// any moment alike: it waits until the frame at hand is shown, is taken by the next one, and seen when that is shown. So
// of two frames that take a and b, events are answered after b to a + b, evenly. What is printed is the distribution of
// that over all moments of an act, the first second left out, and the quality that pictures had at the end.
// The bar is 60 ms for 95 % of the events.

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "apps/flow/flow_model.h"
#include "apps/grid/grid_model.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/version.h"
#include "common/field/transfer/color_transfer.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/window/panels/volume/volume_panel.h"
#include "common/window/window.h"

namespace palpate::bench {
namespace {

struct Setup {
  double seconds = 10.0;
  double budget = kFrameBudget;  // [ms]
  std::string data = "../shared/data";
  std::vector<std::string> acts;  // empty: all
};

constexpr int kMostFrames = 4000, kGrabAt = 10;

/// A drag in small circles about a place of the window, from frame kGrabAt on.
std::vector<ScriptedEvent> circling(double x, double y, double radius) {
  std::vector<ScriptedEvent> script;
  for (int frame = kGrabAt + 1; frame < kMostFrames; ++frame) {
    const double angle = 0.05 * (frame - kGrabAt);
    script.push_back({frame,
                      {.kind = InputKind::kMove,
                       .x = x + radius * std::sin(angle),
                       .y = y + radius * (1.0 - std::cos(angle))}});
  }
  return script;
}

std::vector<ScriptedEvent> held_circling(double x, double y, double radius) {
  std::vector<ScriptedEvent> script = circling(x, y, radius);
  script.insert(script.begin(), {{kGrabAt - 1, {.kind = InputKind::kMove, .x = x, .y = y}},
                                 {kGrabAt, {.kind = InputKind::kPress}}});
  return script;
}

std::vector<ScriptedEvent> grabbed_circling(double x, double y, double radius) {
  std::vector<ScriptedEvent> script = circling(x, y, radius);
  script.insert(script.begin(), {{kGrabAt - 1, {.kind = InputKind::kMove, .x = x, .y = y}},
                                 {kGrabAt, {.kind = InputKind::kKeyDown, .key = 'G'}}});
  return script;
}

/// Holds the fourth point of the preset and leads it up and down.
std::vector<ScriptedEvent> editing() {
  const ColorPoint fourth = make_color_transfer(ColorPreset::kDensity, 0.0, 1.0).points()[3];
  const double across = fourth.value, down = 1.0 - fourth.opacity;
  std::vector<ScriptedEvent> script{{kGrabAt - 4, {.kind = InputKind::kMove}, "points", 0, across, down},
                                    {kGrabAt, {.kind = InputKind::kPress}}};
  for (int frame = kGrabAt + 1; frame < kMostFrames; ++frame) {
    const double there = 0.5 + 0.4 * std::sin(0.05 * (frame - kGrabAt));
    script.push_back({frame, {.kind = InputKind::kMove}, "points", 0, across, there});
  }
  return script;
}

double quantile(const std::vector<double>& sorted, double p) {
  return sorted.empty() ? 0.0 : sorted[static_cast<std::size_t>(p * static_cast<double>(sorted.size() - 1))];
}

void run(const std::string& name, WindowModel& model, WindowOptions window, const Setup& setup) {
  window.frames = kMostFrames;
  window.frame_budget = setup.budget;
  std::vector<double> frames;  // [ms]
  const Stopwatch all;
  Stopwatch frame;
  double first = -1.0;
  int asked = 0;
  window.stop_requested = [&] {
    const double took = 1e3 * frame.seconds();
    frame.restart();
    if (++asked <= kGrabAt + 2) return false;
    if (first < 0.0) first = all.seconds();
    constexpr double kWarming = 1.0;
    if (all.seconds() - first > kWarming) frames.push_back(took);
    return all.seconds() - first > setup.seconds + kWarming;
  };
  const WindowResult result = run_window(model, window);
  // An event in each millisecond.
  std::vector<double> waits;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    const int events = std::max(1, static_cast<int>(std::lround(frames[i])));
    for (int e = 0; e < events; ++e) waits.push_back(frames[i + 1] + frames[i] * (e + 0.5) / events);
  }
  std::sort(waits.begin(), waits.end());
  std::sort(frames.begin(), frames.end());
  std::printf(
      "  %-10s %5zu frames, median %5.1f ms   answered after p50 %5.1f   p95 %5.1f   p99 %5.1f   most %6.1f ms",
      name.c_str(), frames.size(), quantile(frames, 0.5), quantile(waits, 0.5), quantile(waits, 0.95),
      quantile(waits, 0.99), quantile(waits, 1.0));
  std::printf("   resolution %.2f, detail %.2f%s\n", result.quality.resolution, result.quality.detail,
              result.missing.empty() ? "" : "   A CONTROL WAS MISSING");
  std::fflush(stdout);
}

WindowOptions flow_window() {
  WindowOptions window{.program = "flow"};
  window.panels = flow_panels();
  window.touch.modes = modes_of(FieldKind::kVector);
  return window;
}

WindowOptions grid_window() {
  WindowOptions window{.program = "grid"};
  window.panels = {draw_volume};
  window.touch.modes = modes_of(FieldKind::kScalar);
  return window;
}

int run(const Setup& setup) {
  std::printf("%s, frame budget %.0f ms\n", build_text().c_str(), setup.budget);
  const auto flow = [&](const std::string& name, std::vector<ScriptedEvent> script) {
    Document document;
    document.input.files = {setup.data + "/flow/carotid/carotid.vtk"};
    FlowModel model(document, "flow");
    WindowOptions window = flow_window();
    window.script = std::move(script);
    run(name, model, window, setup);
  };
  const auto grid = [&](const std::string& name, std::vector<ScriptedEvent> script, const char* layout) {
    Document document;
    document.input.example = "shells";
    document.panes.layout = layout;
    GridModel model(document, "grid");
    WindowOptions window = grid_window();
    window.script = std::move(script);
    run(name, model, window, setup);
  };
  constexpr double kMiddleX = 860.0, kMiddleY = 450.0;
  const std::vector<std::pair<std::string, std::function<void(const std::string&)>>> acts{
      {"turning", [&](const std::string& n) { flow(n, held_circling(kMiddleX, kMiddleY, 80.0)); }},
      {"following", [&](const std::string& n) { flow(n, grabbed_circling(kMiddleX, kMiddleY, 60.0)); }},
      {"slices", [&](const std::string& n) { grid(n, held_circling(550.0, 200.0, 60.0), "4"); }},
      {"volume", [&](const std::string& n) { grid(n, held_circling(kMiddleX, kMiddleY, 80.0), "1"); }},
      {"transfer", [&](const std::string& n) { grid(n, editing(), "1"); }}};
  for (const auto& [name, act] : acts) {
    if (setup.acts.empty() || std::find(setup.acts.begin(), setup.acts.end(), name) != setup.acts.end())
      act(name);
  }
  return 0;
}

}  // namespace
}  // namespace palpate::bench

int main(int argc, char** argv) {
  palpate::bench::Setup setup;
  for (int i = 1; i + 1 < argc; i += 2) {
    const std::string word = argv[i], value = argv[i + 1];
    if (word == "--seconds") setup.seconds = std::atof(value.c_str());
    if (word == "--budget") setup.budget = std::atof(value.c_str());
    if (word == "--data") setup.data = value;
    if (word == "--acts") {
      std::istringstream names(value);
      for (std::string name; std::getline(names, name, ',');) setup.acts.push_back(name);
    }
  }
  try {
    return palpate::bench::run(setup);
  } catch (const palpate::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return static_cast<int>(error.code());
  }
}
