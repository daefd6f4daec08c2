#include "lab/hand/wall/stability_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "common/base/parallel.h"
#include "common/base/text.h"
#include "lab/hand/wall/energy_cycle.h"

namespace palpate {
namespace {

/// What all sweeps start from: 2 b / T = 4000 N/m, and b T / m = 0.02.
WallCase base_case() { return {.device = find_profile("ideal"), .gap = 1e-3, .seconds = 3.0}; }

/// Hard enough to move every class of device against its friction, hand and all.
WallCase device_case(const DeviceProfile& device) {
  WallCase wall = base_case();
  wall.device = device;
  wall.push = 2.0;
  wall.gap = 2e-3;
  return wall;
}

struct Swept {
  std::string name, unit;
  double shown;
  std::vector<double> values;
  std::function<void(WallCase&, double)> set;
};

std::vector<Swept> all_swept() {
  return {
      {"servo rate",
       "Hz",
       1.0,
       {250, 500, 1000, 2000, 4000, 8000},
       [](WallCase& w, double v) { w.rate = v; }},
      {"damping of the arm",
       "N s/m",
       1.0,
       {0.25, 0.5, 1, 2, 4, 8, 16},
       [](WallCase& w, double v) {
         w.device.damping = v;
         w.seconds = std::max(w.seconds, 4.0 / v);  // lightly damped, it tells late whether it dies out
       }},
      {"delay",
       "ms",
       1e3,
       {1.25e-4, 2.5e-4, 5e-4, 1e-3, 2e-3, 4e-3, 8e-3},
       [](WallCase& w, double v) {
         w.device.sensor_delay = 0.0;
         w.device.actuator_delay = v;
       }},
      // With the friction of a small arm at least, without which no stiffness is passive on an encoder at
      // all.
      {"encoder step",
       "mm",
       1e3,
       {1e-5, 2e-5, 5e-5, 1e-4, 2e-4},
       [](WallCase& w, double v) {
         w.device.encoder_step = v;
         w.device.friction = std::max(w.device.friction, 0.05);
       }},
  };
}

StiffnessRow stiffness_row(WallCase wall, double value) {
  StiffnessRow row{.value = value, .bound = stiffness_bound(loop_of(wall), 0.0).stiffness};
  row.unheld = largest_stable_stiffness(wall);
  wall.controlled = true;
  row.controlled = largest_stable_stiffness(wall);
  wall.controlled = false;
  wall.hand = kRelaxedHand;
  row.relaxed = largest_stable_stiffness(wall);
  wall.hand = kFirmHand;
  row.firm = largest_stable_stiffness(wall);
  return row;
}

std::vector<LedgerRow> ledger_rows() {
  std::vector<LedgerRow> rows;
  WallCase wall = base_case();
  wall.seconds = 4.0;
  const double bound = stiffness_bound(loop_of(wall), 0.0).stiffness;
  for (const double times : {0.5, 0.95, 1.05, 2.0, 10.0}) {
    for (const bool controlled : {false, true}) {
      wall.stiffness = times * bound;
      wall.controlled = controlled;
      rows.push_back({wall, bound, run_wall(wall)});
    }
  }
  return rows;
}

/// What the bench must be able to see, and what the controller must be able to do.
std::vector<StabilityCase> wall_cases() {
  std::vector<StabilityCase> cases;
  WallCase wall = base_case();
  wall.gap = 0.0;
  wall.seconds = 8.0;
  const double bound = stiffness_bound(loop_of(wall), 0.0).stiffness;
  const double onset = largest_stable_stiffness(wall), free = energy_free_stiffness(wall);
  cases.push_back(make_case("wall: onset of swinging", std::abs(onset / bound - 1.0), 0.05, "of the bound",
                            "an unheld arm pushed against a wall begins to swing at " + short_number(onset) +
                                " N/m; the bound 2 b / T is " + short_number(bound) + " N/m"));
  cases.push_back(make_case(
      "wall: energy of a cycle", std::abs(free / bound - 1.0), 0.01, "of the bound",
      "in and out at constant speed, the hand begins to get energy back at " + short_number(free) + " N/m"));
  wall.stiffness = 10.0 * bound;
  const WallRun loose = run_wall(wall);
  wall.controlled = true;
  const WallRun held = run_wall(wall);
  constexpr double kMillimetres = 1e3;
  cases.push_back(
      make_case("wall: travel under control", kMillimetres * std::max(held.deepest, held.farthest), 2.0, "mm",
                "largest motion at ten times the bound with the passivity controller; without it " +
                    short_number(kMillimetres * std::max(loose.deepest, loose.farthest)) + " mm"));
  cases.push_back(make_case("wall: force under control", held.force / wall.device.peak_force, 0.999,
                            "of the peak",
                            "largest force of that run; without the controller " +
                                short_number(loose.force / wall.device.peak_force)));
  return cases;
}

}  // namespace

WallStability run_wall_stability(int threads, Progress* progress, const DeviceProfile& device) {
  WallStability result;
  result.swept = device;
  const bool ideal = device.name == find_profile("ideal").name;
  struct Job {
    WallCase wall;
    double value;
    StiffnessRow* row;
  };
  std::vector<Job> jobs;
  const std::vector<Swept> all = all_swept();
  result.sweeps.reserve(all.size());
  for (const Swept& swept : all) {
    StiffnessSweep& sweep =
        result.sweeps.emplace_back(StiffnessSweep{swept.name, swept.unit, swept.shown, {}});
    sweep.rows.resize(swept.values.size());
    for (std::size_t n = 0; n < swept.values.size(); ++n) {
      WallCase wall = ideal ? base_case() : device_case(device);
      swept.set(wall, swept.values[n]);
      jobs.push_back({wall, swept.values[n], &sweep.rows[n]});
    }
  }
  std::vector<DeviceProfile> devices(device_profiles().begin(), device_profiles().end());
  const bool known = std::any_of(devices.begin(), devices.end(),
                                 [&](const DeviceProfile& each) { return each.name == device.name; });
  if (!known) devices.push_back(device);
  result.devices.resize(devices.size());
  for (std::size_t n = 0; n < devices.size(); ++n) {
    result.devices[n].device = devices[n];
    jobs.push_back({device_case(devices[n]), 0.0, &result.devices[n].stiffness});
  }
  if (progress) progress->begin("stability of a virtual wall", jobs.size());
  parallel_for(jobs.size(), threads, [&](std::size_t first, std::size_t last) {
    for (std::size_t n = first; n < last; ++n) {
      if (progress) progress->check();
      *jobs[n].row = stiffness_row(jobs[n].wall, jobs[n].value);
      if (progress) progress->advance();
    }
  });
  result.ledger = ledger_rows();
  result.cases = wall_cases();
  return result;
}

}  // namespace palpate
