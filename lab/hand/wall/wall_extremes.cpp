#include "lab/hand/wall/wall_extremes.h"

#include <algorithm>
#include <functional>
#include <string>

#include "common/base/text.h"
#include "lab/hand/wall/wall_run.h"

namespace palpate {
namespace {

struct Setting {
  std::string name;
  std::function<void(WallCase&)> set;
};

WallCase pushed(const Setting& setting, double times_bound) {
  WallCase wall{.device = find_profile("ideal"), .seconds = 8.0};
  setting.set(wall);
  wall.stiffness = times_bound * stiffness_bound(loop_of(wall), 0.0).stiffness;
  return wall;
}

void coarse_encoder(WallCase& wall) {
  wall.device.encoder_step = 2e-4;
  wall.device.friction =
      std::max(wall.device.friction, 0.05);  // without which no stiffness is passive on an encoder
}

WallExtreme controlled(const Setting& setting, double times_bound) {
  constexpr double kMillimetres = 1e3, kLimit = 0.75;
  return {.name = setting.name + ", " + short_number(times_bound) + " times the bound",
          .builder = "an arm pushed against a wall stiffer than passive",
          .claim = "largest motion with the passivity controller",
          .guard = "the passivity controller",
          .limit = kLimit,
          .measure = [setting, times_bound](bool guarded) {
            WallCase wall = pushed(setting, times_bound);
            wall.controlled = guarded;
            const WallRun run = run_wall(wall);
            return kMillimetres * std::max(run.deepest, run.farthest);
          }};
}

WallExtreme bounded(const Setting& setting) {
  constexpr double kWithin = 0.95, kBeyond = 100.0, kMillimetres = 1e3;
  return {.name = setting.name + ", within the bound",
          .builder = "an arm pushed against a wall of 0.95 of the bound",
          .claim = "how wide it goes on swinging",
          .guard = "the bound of stiffness",
          .limit = 0.0,
          .measure = [setting](bool guarded) {
            const Oscillation found = run_wall(pushed(setting, guarded ? kWithin : kBeyond)).swing;
            return found.sustained ? kMillimetres * found.amplitude : 0.0;
          }};
}

}  // namespace

std::vector<WallExtreme> wall_extremes() {
  const Setting plain{"1 kHz", [](WallCase&) {}};
  const Setting fast{"8 kHz", [](WallCase& w) { w.rate = 8000.0; }};
  const Setting light{"damping of 0.25 N s/m", [](WallCase& w) {
                        w.device.damping = 0.25;
                        w.seconds = 16.0;  // lightly damped, it tells late whether it dies out
                      }};
  const Setting coarse{"encoder steps of 0.2 mm", coarse_encoder};
  const Setting slow{"100 Hz", [](WallCase& w) { w.rate = 100.0; }};
  const auto late = [](double delay) {
    return Setting{"delay of " + short_number(1e3 * delay) + " ms", [delay](WallCase& w) {
                     w.device.sensor_delay = 0.0;
                     w.device.actuator_delay = delay;
                   }};
  };
  std::vector<WallExtreme> rows;
  for (const double times : {10.0, 100.0, 1000.0}) {
    for (const Setting& setting : {plain, fast, light}) {
      if (times < 1000.0 || setting.name != fast.name) rows.push_back(controlled(setting, times));
    }
  }
  rows.push_back(controlled(coarse, 100.0));
  for (const Setting& setting : {slow, fast, light, coarse, late(1e-3), late(8e-3), late(32e-3)})
    rows.push_back(bounded(setting));
  return rows;
}

}  // namespace palpate
