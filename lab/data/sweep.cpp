#include "lab/data/sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <utility>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "lab/peer/vtk_tracer.h"

namespace palpate {
namespace {

/// What the effort buys.
struct EffortPlan {
  int repeats = 1;              // runs of a setting, of which the median counts
  double seconds_setting = 0;   // a method's sweep ends where its next setting is expected to take longer
  double second_tolerance = 0;  // of the independent method on trilinear data and formulas
};

EffortPlan plan_of(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return {1, 0.2, 1e-10};
    case Effort::kThorough:
      return {5, 10.0, 1e-11};
    default:
      return {3, 0.5, 1e-11};
  }
}

/// One method's settings, loose to tight.
struct MethodSweep {
  Integrator integrator;
  bool fixed_step = false;
  int order = 4;          // of the error against the setting's cost, for predicting run times
  double tightest = 0.0;  // tolerance; below it rounding takes over or the cost explodes
};

constexpr double kLoosestTolerance = 1e-3;
constexpr double kReferenceTolerance = 1e-12;
constexpr int kComparedPerDiagonal = 16;   // S = D / 16
constexpr int kFewestStepsPerSpacing = 2;  // loosest fixed step: S / 2
constexpr int kMostHalvings = 14;
constexpr std::int64_t kMostPeerSteps = 5'000'000;  // of VTK's fixed steps, more than the shortest ones take
constexpr double kShortestTiming = 0.02;            // [s] of all runs of a setting together
constexpr std::size_t kMostRepeats = 15;

std::vector<MethodSweep> methods_for(const VectorField& field) {
  std::vector<MethodSweep> methods;
  if (field.tet_mesh()) methods.push_back({Integrator::kExact, false, 0, 0.0});
  methods.push_back({Integrator::kEuler, true, 1, 0.0});
  methods.push_back({Integrator::kRk4, true, 4, 0.0});
  methods.push_back({Integrator::kBs32, false, 3, 1e-9});
  methods.push_back({Integrator::kRk34, false, 4, 1e-10});
  methods.push_back({Integrator::kDp54, false, 5, 1e-11});
  methods.push_back({Integrator::kRodas4, false, 4, 1e-10});
  return methods;
}

class Sweeper {
 public:
  Sweeper(const VectorField& field, const SweepRequest& request, Progress* progress)
      : field_(field), request_(request), plan_(plan_of(request.effort)), progress_(progress) {
    sweep_.subject = request.subject;
    sweep_.max_length =
        request.trace.max_length > 0.0 ? request.trace.max_length : kReportDiagonals * field.diagonal();
    sweep_.spacing = field.diagonal() / kComparedPerDiagonal;
    // One thread unless asked: times of several depend on who else uses the machine.
    sweep_.threads = request.trace.threads > 0 ? request.trace.threads : 1;
    sweep_.seeds = request.seeds.size();
  }

  Sweep run() {
    make_reference();
    for (const MethodSweep& method : methods_for(field_)) {
      if (method.integrator == Integrator::kExact) {
        add_row(method.integrator, "cell by cell", 0.0);
      } else if (method.fixed_step) {
        sweep_steps(method);
      } else {
        sweep_tolerances(method);
      }
    }
    add_peer();
    return std::move(sweep_);
  }

 private:
  TraceResult trace(Integrator integrator, double tolerance, double step,
                    std::int64_t most_steps = std::numeric_limits<std::int64_t>::max()) const {
    TraceOptions options = request_.trace;
    options.max_steps = std::min(options.max_steps, most_steps);
    options.integrator = integrator;
    options.tolerance = tolerance;
    options.step = step;
    options.max_length = sweep_.max_length;
    options.threads = sweep_.threads;
    return trace_lines(field_, seeds_, options, progress_);
  }

  TraceResult tightest(bool tets) const {
    return trace(tets ? Integrator::kExact : Integrator::kDp54, kReferenceTolerance, sweep_.spacing);
  }

  void make_reference() {
    const bool tets = field_.tet_mesh() != nullptr;
    stage("tightest method");
    seeds_ = request_.seeds;
    TraceResult reference = tightest(tets);
    sweep_.seeds_outside = reference.outside_seeds.size();
    if (reference.lines.empty()) {
      throw work_error("no line to compare: all " + counted(seeds_.size(), "seed") + " lie outside the data");
    }
    // Seeds whose line ends inside in any direction are dropped, then those beyond what the effort allows.
    std::vector<bool> inside(seeds_.size(), false), traced(seeds_.size(), false);
    for (const Line& line : reference.lines) {
      traced[line.seed] = true;
      if (!ends_inside(line, field_.diagonal())) continue;
      inside[line.seed] = true;
      ++sweep_.lines_inside;
    }
    std::vector<Vec3> kept;
    for (std::size_t s = 0; s < seeds_.size() && kept.size() < request_.most_lines; ++s) {
      if (traced[s] && !inside[s]) kept.push_back(seeds_[s]);
    }
    if (kept.empty())
      throw work_error(
          "no line to compare: every line ends inside, in a sink or on itself; give other --seeds");
    seeds_ = std::move(kept);
    sweep_.reference_lines = tightest(tets).lines;
    sweep_.reference = tets ? "exact" : "dp54 tolerance=" + short_number(kReferenceTolerance);

    stage("independent method");
    const Integrator other = tets ? Integrator::kDp54 : Integrator::kRodas4;
    const double tolerance = tets ? kReferenceTolerance : plan_.second_tolerance;
    sweep_.second = std::string(name_of(other)) + " tolerance=" + short_number(tolerance);
    second_lines_ = trace(other, tolerance, sweep_.spacing).lines;
    sweep_.agreement =
        compare_lines(second_lines_, sweep_.reference_lines, sweep_.spacing, field_.diagonal());
    sweep_.disputed = as_size(std::ranges::count_if(sweep_.agreement.lines, [](const LineJudgement& l) {
      return l.meeting != Meeting::kInside && !(l.error <= kDisputed);
    }));
  }

  double add_row(Integrator integrator, const std::string& parameter, double setting, double tolerance = 1e-6,
                 double step = 0.0) {
    stage(std::string(name_of(integrator)) + " " + parameter);
    SweepRow row{.method = std::string(name_of(integrator)), .parameter = parameter, .setting = setting};
    std::vector<double> seconds;
    TraceResult result;
    // Short runs are repeated more often: one of them says little.
    double total = 0.0;
    while (static_cast<int>(seconds.size()) < plan_.repeats ||
           (total < kShortestTiming && seconds.size() < kMostRepeats)) {
      if (progress_) progress_->check();
      result = step > 0.0 ? trace(integrator, tolerance, step)
                          : trace(integrator, tolerance, sweep_.spacing, kMostSweptSteps);
      seconds.push_back(result.seconds_trace);
      total += seconds.back();
      if (total > plan_.seconds_setting) break;  // so long a run says enough
    }
    std::sort(seconds.begin(), seconds.end());
    row.seconds = seconds[seconds.size() / 2];
    row.repeats = static_cast<int>(seconds.size());
    row.lines = result.lines.size();
    row.points = result.points;
    const bool own = integrator == (field_.tet_mesh() != nullptr ? Integrator::kExact : Integrator::kDp54);
    row.judge = own ? sweep_.second : sweep_.reference;
    row.error = compare_lines(result.lines, own ? second_lines_ : sweep_.reference_lines, sweep_.spacing,
                              field_.diagonal());
    sweep_.rows.push_back(row);
    return row.seconds;
  }

  void sweep_steps(const MethodSweep& method) {
    double step = sweep_.spacing / kFewestStepsPerSpacing;
    for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
      const double seconds = add_row(method.integrator, "step=" + short_number(step), step, 1e-6, step);
      if (2.0 * seconds > plan_.seconds_setting) return;
    }
  }

  void sweep_tolerances(const MethodSweep& method) {
    // A method of order p takes 10^(1/p) times as many steps for one digit more.
    const double growth = std::pow(10.0, 1.0 / method.order);
    const double loosest = -std::log10(kLoosestTolerance);
    const int settings = static_cast<int>(std::lround(-std::log10(method.tightest) - loosest)) + 1;
    for (int i = 0; i < settings; ++i) {
      const double tolerance = std::pow(10.0, -(loosest + i));
      const double seconds =
          add_row(method.integrator, "tolerance=" + short_number(tolerance), tolerance, tolerance);
      if (growth * seconds > plan_.seconds_setting) return;
    }
  }

  /// vtkStreamTracer on the same mesh, by its steps.
  void add_peer() {
    const TraceOptions& wanted = request_.trace;
    std::string why = VtkTracer::hindrance(field_);
    if (why.empty() && (wanted.max_time > 0.0 || !wanted.stop_rules.empty()))
      why = "it knows no limit of time and no rules to stop by";
    if (!why.empty()) {
      sweep_.peer_missing = "VTK's tracer is left out: " + why + ".";
      return;
    }
    try {
      VtkTracer vtk(field_, sweep_.spacing, progress_);
      for (const bool fifth : {false, true}) {
        double step = sweep_.spacing / kFewestStepsPerSpacing;
        for (int halving = 0; halving < kMostHalvings; ++halving, step *= 0.5) {
          const double seconds = add_peer_row(vtk, {.fifth = fifth, .step = step});
          if (2.0 * seconds > plan_.seconds_setting) break;
        }
      }
    } catch (const Cancelled&) {
      throw;
    } catch (const std::exception& error) {
      sweep_.peer_missing = std::string("VTK's tracer failed: ") + error.what() + ".";
    }
  }

  double add_peer_row(VtkTracer& vtk, const VtkSetting& setting) {
    SweepRow row{.method = setting.fifth ? "VTK rk45" : "VTK rk4",
                 .parameter = "step=" + short_number(setting.step),
                 .setting = setting.step,
                 .judge = sweep_.reference};
    stage(row.method + " " + row.parameter);
    const TraceOptions& wanted = request_.trace;
    std::vector<Line> lines;
    for (const TraceDirection direction : {TraceDirection::kForward, TraceDirection::kBackward}) {
      if (!(direction == TraceDirection::kForward ? wanted.forward : wanted.backward)) continue;
      VtkLines found = vtk.trace(seeds_, direction, setting, sweep_.max_length, kMostPeerSteps);
      row.seconds += found.seconds;
      std::move(found.lines.begin(), found.lines.end(), std::back_inserter(lines));
    }
    row.lines = lines.size();
    for (const Line& line : lines) row.points += line.points.size();
    row.error = compare_lines(lines, sweep_.reference_lines, sweep_.spacing, field_.diagonal(), false);
    sweep_.rows.push_back(row);
    return row.seconds;
  }

  void stage(const std::string& what) const {
    if (progress_) progress_->begin("error against time: " + what, 0);
  }

  const VectorField& field_;
  const SweepRequest& request_;
  EffortPlan plan_;
  Progress* progress_;
  std::vector<Vec3> seeds_;         ///< of the lines that are compared
  std::vector<Line> second_lines_;  ///< of the independent method
  Sweep sweep_;
};

}  // namespace

Effort effort_from_name(const std::string& name) {
  if (name == "quick") return Effort::kQuick;
  if (name == "normal") return Effort::kNormal;
  if (name == "thorough") return Effort::kThorough;
  throw usage_error("'" + name + "' is no effort; known: quick, normal, thorough");
}

Sweep run_sweep(const VectorField& field, const SweepRequest& request, Progress* progress) {
  return Sweeper(field, request, progress).run();
}

std::vector<WorkPrecision> work_precision_rows(const Sweep& sweep) {
  std::vector<WorkPrecision> rows;
  for (const SweepRow& row : sweep.rows) {
    rows.push_back({sweep.subject, row.method, row.parameter, row.error.p95,
                    "95 % of lines, distance at equal arc length / diagonal", row.seconds});
    rows.push_back({sweep.subject, row.method, row.parameter, row.error.max,
                    "worst line, distance at equal arc length / diagonal", row.seconds});
  }
  return rows;
}

}  // namespace palpate
