#include "lab/hand/haptic_stability.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <utility>

#include "common/base/text.h"
#include "lab/data/made_data.h"
#include "lab/hand/streamline_run.h"

namespace palpate {
namespace {

constexpr std::size_t kSteps = 3000;  // of each path
constexpr std::size_t kPaths = 4;     // on each field
constexpr int kScalingExponent = 20;
constexpr double kBeyondCap = 4.0;  // what the coupling asks for before the line is let go, of the cap

Workspace workspace_of(const VectorField& field) {
  return {Workspace::default_scale(field.diagonal()), field.frame()};
}

/// What the runs on one field came to.
struct Tally {
  double not_finite = 0.0;        ///< rows
  double forces_on_faults = 0.0;  ///< bad rows that have a force, or no fault
  double force = 0.0;             ///< largest, of the cap
  double slew = 0.0;              ///< fastest change of a force that is not cut, of the limit
  double residual = 0.0;          ///< [diagonals] as stated
  std::size_t bad_rows = 0;
  std::size_t rows = 0;
};

bool is_bad(const PathRow& row) { return !std::isfinite(row.time) || !is_finite(row.position); }

/// The path with a bad row every 61: numbers that are none, time standing still and running backwards.
std::vector<PathRow> spoiled(std::vector<PathRow> path) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr std::size_t kEvery = 61;
  for (std::size_t n = kEvery; n < path.size(); n += kEvery) {
    switch (n / kEvery % 6) {
      case 0:
        path[n].position = Vec3{kNan};
        break;
      case 1:
        path[n].position.z = -HUGE_VAL;
        break;
      case 2:
        path[n].time = path[n - 1].time;
        break;
      case 3:
        path[n].time -= 1.0;
        break;
      case 4:
        path[n].time = kNan;
        break;
      default:
        path[n].position *= 0x1p1000;
    }
  }
  return path;
}

void add_run(const std::vector<PathRow>& path, const std::vector<RunStep>& steps, const DeviceLimits& limits,
             double metres_per_diagonal, Tally& tally) {
  constexpr double kRounding = 1e-9;  // [N] of a force that is a difference of others
  Vec3 last_force{0.0};
  double last_time = path.front().time;
  for (std::size_t n = 0; n < steps.size(); ++n) {
    const HandStep& hand = steps[n].hand;
    const double dt = path[n].time - last_time;
    const bool finite = is_finite(hand.force) && is_finite(hand.chain.proxy(hand.probe)) &&
                        std::isfinite(hand.chain.residual);
    tally.not_finite += finite ? 0.0 : 1.0;
    if (is_bad(path[n]) || (n > 0 && !(dt > 0.0))) {
      ++tally.bad_rows;
      const bool cut = hand.force == Vec3{0.0} && hand.state == HoldState::kFault;
      tally.forces_on_faults += cut ? 0.0 : 1.0;
    }
    tally.force = std::max(tally.force, glm::length(hand.force) / limits.force_cap);
    if (hand.force != Vec3{0.0}) {
      const double most = limits.slew_cap * std::min(dt, SafetyStage::kLongestStep);
      tally.slew =
          std::max(tally.slew, (glm::distance(hand.force, last_force) - kRounding) / std::max(most, 1e-300));
    }
    tally.residual = std::max(tally.residual, hand.chain.residual / metres_per_diagonal);
    last_force = hand.force;
    if (std::isfinite(path[n].time)) last_time = path[n].time;
  }
  tally.rows += steps.size();
}

/// Seeds all over the field.
std::vector<Vec3> spread_seeds(const VectorField& field) {
  std::mt19937_64 random(11);
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-53; };
  constexpr int kTries = 200;
  std::vector<Vec3> seeds;
  for (int n = 0; n < kTries && seeds.size() < kPaths; ++n) {
    const double x = unit(), y = unit(), z = unit();
    const Vec3 seed = field.bounds().lower + field.bounds().size() * Vec3{x, y, z};
    CellHint hint;
    if (field.sample(seed, hint).status == SampleStatus::kOk) seeds.push_back(seed);
  }
  return seeds;
}

Tally tally_on(const FieldPtr& field, std::vector<Vec3> seeds, int threads, Progress* progress) {
  Tally tally;
  const Workspace workspace = workspace_of(*field);
  // So firm that the cap has something to hold: by default the line is let go at half of it.
  ChainSettings firm;
  firm.stiffness = kBeyondCap * DeviceLimits{}.force_cap / firm.streamline.release_distance;
  StreamlineRun run(field, workspace, threads, firm);
  seeds.resize(std::min(seeds.size(), kPaths));
  for (std::size_t s = 0; s < seeds.size(); ++s) {
    if (progress) progress->check();
    const auto path = spoiled(make_probe_path({*field, workspace, run.settings().streamline.release_distance},
                                              PathKind::kRough, seeds[s], kSteps, 100 + s));
    if (path.empty()) continue;
    add_run(path, run.follow(path), run.limits(), Workspace::kDefaultSize, tally);
  }
  return tally;
}

FieldPtr field_of(const std::vector<DataSet>& blocks, const VectorChoice& choice) {
  return make_vector_field(blocks, choice, "made data");
}

VectorChoice made_choice() { return {.arrays = {"velocity"}, .label = "velocity"}; }

DataSet sink_data() {
  const auto even = even_coordinates(7);
  return tetrahedral_data(even, even, even, [](const Vec3& x) {
    const Vec3 from = x - Vec3{0.125, -0.0625, 0.25};
    return Vec3{-from.x - 4.0 * from.y, 4.0 * from.x - from.y, -2.0 * from.z};
  });
}

/// Rows whose bits differ when the data is 2^k as large and its speeds 2^-2k as large.
double different_rows(const std::vector<DataSet>& blocks, const VectorChoice& choice,
                      const std::vector<Vec3>& seeds, int threads) {
  const double power = std::ldexp(1.0, kScalingExponent);
  const auto scaled = [&](double length, double value) {
    std::vector<DataSet> copies;
    for (const DataSet& block : blocks) {
      copies.push_back(scaled_data(block, length, value));
      // Momentum and density scale alike, so only one of them may change.
      if (choice.kind != VectorChoice::Kind::kMomentumOverDensity) continue;
      for (std::size_t a = 0; a < block.arrays.size(); ++a) {
        if (block.arrays[a].name == choice.arrays.back()) copies.back().arrays[a] = block.arrays[a];
      }
    }
    return field_of(copies, choice);
  };
  const FieldPtr one = scaled(1.0, 1.0), other = scaled(power, 1.0 / (power * power));
  const Workspace workspace = workspace_of(*one);
  const Workspace other_workspace(workspace.scale() / power, other->frame());
  StreamlineRun run(one, workspace, threads), other_run(other, other_workspace, threads);
  double different = 0.0;
  for (std::size_t s = 0; s < std::min(seeds.size(), kPaths); ++s) {
    auto path = make_probe_path({*one, workspace, run.settings().streamline.release_distance},
                                PathKind::kRough, seeds[s], kSteps, 200 + s);
    const auto steps = run.follow(path);
    for (PathRow& row : path) row.position *= power;
    const auto other_steps = other_run.follow(path);
    for (std::size_t n = 0; n < steps.size(); ++n) {
      const HandStep &a = steps[n].hand, &b = other_steps[n].hand;
      const bool same = a.force == b.force && a.state == b.state &&
                        a.chain.proxy(a.probe) == b.chain.proxy(b.probe) &&
                        a.chain.residual == b.chain.residual;
      different += same ? 0.0 : 1.0;
    }
  }
  return different;
}

void add_cases(const std::string& where, const Tally& tally, std::vector<StabilityCase>& cases) {
  if (tally.rows == 0) return;
  const std::string rows =
      std::to_string(tally.rows) + " steps, " + std::to_string(tally.bad_rows) + " of them of bad rows";
  cases.push_back(make_case("hand " + where + ": finite", tally.not_finite, 0.0, "steps",
                            "steps whose force, proxy or residual is not finite; " + rows));
  cases.push_back(make_case("hand " + where + ": faults", tally.forces_on_faults, 0.0, "steps",
                            "bad rows (NaN, infinity, time standing or running backwards) that had a force"));
  cases.push_back(make_case(
      "hand " + where + ": force", tally.force, 1.0 + 1e-12, "of the cap",
      "largest force, through jumps of a metre in a millisecond, where the coupling is so stiff that it "
      "asks for " +
          short_number(kBeyondCap) + " times the cap"));
  cases.push_back(make_case("hand " + where + ": slew", tally.slew, 1.0, "of the limit",
                            "fastest change of the force, but for drops to zero"));
  cases.push_back(make_case("hand " + where + ": residual", tally.residual, kResidualLimit, "of the diagonal",
                            "largest distance of the proxy from the tracer's curve, as each step states it"));
}

}  // namespace

std::vector<StabilityCase> run_haptic_stability(const FieldPtr& field, const ConstraintSweep& sweep,
                                                const StabilityRequest& request, Progress* progress) {
  if (progress) progress->begin("stability of the hand", 0);
  const int threads = request.trace.threads;
  std::vector<StabilityCase> cases;
  double farthest = 0.0;
  std::size_t compared = 0;
  for (const ConstraintRow& row : sweep.rows) {
    farthest = std::max(farthest, row.residual.max);
    compared += row.compared;
  }
  if (compared > 0) {
    cases.push_back(make_case("hand: on its line", farthest, kResidualLimit, "of the diagonal",
                              "largest distance of the proxy from a line traced by rodas4, a thousand times "
                              "tighter, in " +
                                  std::to_string(compared) + " steps of all budgets"));
  }
  add_cases("on this data", tally_on(field, request.seeds, threads, progress), cases);
  const FieldPtr sink = field_of({sink_data()}, made_choice());
  add_cases("at a sink", tally_on(sink, spread_seeds(*sink), threads, progress), cases);
  const Box box{Vec3{-1.0}, Vec3{1.0}};
  const DataSet swirl = uniform_data(17, box, [](const Vec3& x) { return Vec3{-x.y, x.x, 0.25}; });
  const FieldPtr holed = field_of({holed_data(swirl, {0.4, 0.0, 0.0}, 0.35)}, made_choice());
  add_cases("at a hole of NaNs", tally_on(holed, spread_seeds(*holed), threads, progress), cases);

  const bool made = request.blocks.empty();
  const double different = made ? different_rows({sink_data()}, made_choice(), spread_seeds(*sink), threads)
                                : different_rows(request.blocks, request.choice, request.seeds, threads);
  cases.push_back(
      make_case("hand: powers of two", different, 0.0, "steps",
                std::string("steps whose bits differ where lengths are 2^20, speeds 2^-40 and the workspace "
                            "2^-20 times as large, on ") +
                    (made ? "the sink" : "this data")));
  return cases;
}

}  // namespace palpate
