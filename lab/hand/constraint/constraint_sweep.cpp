#include "lab/hand/constraint/constraint_sweep.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lab/hand/constraint/reference_curve.h"
#include "lab/hand/streamline_run.h"

namespace palpate {
namespace {

/// What the effort buys.
struct PathPlan {
  std::size_t seeds = 0;
  std::size_t steps = 0;  ///< of the path from each seed
};

PathPlan plan_of(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return {2, 800};
    case Effort::kThorough:
      return {16, 3000};
    default:
      return {6, 1500};
  }
}

constexpr std::array<int, 10> kSweepIterations{1, 2, 3, 4, 6, 8, 16, 32, 64, 128};
constexpr std::array<int, 6> kCells{1, 2, 4, 8, 16, 32};
// Diagonals on either side of a catch, that the reference reaches: paths keep within half of one about their
// seed, and rough ones do not stay long on a line.
constexpr double kReferenceLength = 0.6, kRoughReferenceLength = 0.2;

constexpr double kNear = 1e-7;  // diagonals: well below what is promised

class Sweeper {
 public:
  Sweeper(const std::shared_ptr<const VectorField>& field, const ConstraintSweepRequest& request,
          Progress* progress)
      : field_(field),
        request_(request),
        progress_(progress),
        workspace_(Workspace::default_scale(field->diagonal()), field->frame()),
        run_(field, workspace_, request.threads) {}

  ConstraintSweep run() {
    const PathPlan plan = plan_of(request_.effort);
    ConstraintSweep sweep{.subject = request_.subject, .clock_microseconds = clock_microseconds()};
    sweep.release_force = run_.settings().stiffness * run_.settings().streamline.release_distance;
    sweep.seeds = std::min(plan.seeds, request_.seeds.size());
    for (const PathKind kind : kPathKinds) {
      if (progress_) progress_->begin("constraint: " + std::string(name_of(kind)) + " paths", 0);
      curves_.clear();
      reference_length_ =
          (kind == PathKind::kRough ? kRoughReferenceLength : kReferenceLength) * field_->diagonal();
      std::vector<std::vector<PathRow>> paths;
      for (std::size_t s = 0; s < sweep.seeds; ++s) {
        paths.push_back(make_probe_path({*field_, workspace_, run_.settings().streamline.release_distance},
                                        kind, request_.seeds[s], plan.steps, s + 1));
      }
      for (const int iterations : kSweepIterations) {
        sweep.rows.push_back(measure(kind, paths, false, {.iterations = iterations}));
      }
      for (const int cells : kCells) sweep.rows.push_back(measure(kind, paths, true, {.cells = cells}));
    }
    return sweep;
  }

 private:
  ConstraintRow measure(PathKind kind, const std::vector<std::vector<PathRow>>& paths, bool cells_swept,
                        const UpdateBudget& budget) {
    ConstraintRow row{.path = kind, .cells_swept = cells_swept, .budget = budget};
    std::vector<double> times;
    residuals_.clear();
    lags_.clear();
    force_errors_.clear();
    for (const auto& path : paths) {
      const std::vector<RunStep> steps = run_.follow(path, budget);
      compare(path, steps);
      for (const RunStep& step : steps) {
        times.push_back(step.microseconds);
        row.us_mean += step.microseconds;
        row.releases += step.hand.state == HoldState::kReleased ? 1 : 0;
        row.fallbacks += step.hand.state == HoldState::kFellBack ? 1 : 0;
      }
    }
    row.steps = times.size();
    row.us_mean /= static_cast<double>(std::max<std::size_t>(times.size(), 1));
    const StepErrors time = errors_of(std::move(times));
    row.us_p50 = time.median;
    row.us_p99 = time.p99;
    row.us_max = time.max;
    row.compared = residuals_.size();
    row.residual = errors_of(residuals_);
    row.lag = errors_of(lags_);
    row.force_error = errors_of(force_errors_);
    return row;
  }

  /// (1) for every step of a run.
  void compare(const std::vector<PathRow>& path, const std::vector<RunStep>& steps) {
    const ReferenceCurve* curve = nullptr;
    std::size_t ideal = 0, real = 0;  // points of the reference next to q and p
    std::uint64_t catches = 0;
    for (std::size_t n = 0; n < steps.size(); ++n) {
      const RunStep& step = steps[n];
      if (n == 0 || step.catches != catches) {
        curve = &reference(path[n].position);
        ideal = real = curve->seed();
        catches = step.catches;
      }
      if (!step.follows || curve == nullptr || curve->empty()) continue;
      const Vec3 proxy = workspace_.data_from_workspace(step.hand.chain.proxies[0]);
      const auto q = curve->nearest(path[n].position, ideal);
      auto p = curve->nearest(proxy, real);
      // A proxy that went far in one step is looked for on the whole curve: the way downhill may end
      // elsewhere.
      const double near = kNear * field_->diagonal();
      if (glm::distance(proxy, p.position) > near) p = curve->nearest_of_all(proxy);
      ideal = q.point;
      real = p.point;
      if (q.beyond || p.beyond) {
        curve = nullptr;  // until the next catch
        continue;
      }
      const double diagonal = field_->diagonal();
      residuals_.push_back(glm::distance(proxy, p.position) / diagonal);
      lags_.push_back(std::abs(p.arc - q.arc) / diagonal);
      force_errors_.push_back(run_.settings().stiffness * workspace_.scale() *
                              glm::distance(proxy, q.position));
    }
  }

  const ReferenceCurve& reference(const Vec3& seed) {
    const std::array<double, 3> key{seed.x, seed.y, seed.z};
    const auto found = curves_.find(key);
    if (found != curves_.end()) return found->second;
    if (progress_) progress_->check();
    return curves_.emplace(key, ReferenceCurve(*field_, seed, reference_length_)).first->second;
  }

  std::shared_ptr<const VectorField> field_;
  const ConstraintSweepRequest& request_;
  Progress* progress_;
  Workspace workspace_;
  StreamlineRun run_;
  double reference_length_ = 0.0;                           ///< data units
  std::map<std::array<double, 3>, ReferenceCurve> curves_;  ///< by the place of the catch
  std::vector<double> residuals_, lags_, force_errors_;     ///< of the row that is being measured
};

}  // namespace

std::string ConstraintRow::parameter() const {
  return cells_swept ? "cells=" + std::to_string(budget.cells)
                     : "iterations=" + std::to_string(budget.iterations);
}

ConstraintSweep run_constraint_sweep(const std::shared_ptr<const VectorField>& field,
                                     const ConstraintSweepRequest& request, Progress* progress) {
  return Sweeper(field, request, progress).run();
}

std::vector<WorkPrecision> work_precision_rows(const ConstraintSweep& sweep) {
  constexpr double kMicro = 1e-6;
  std::vector<WorkPrecision> rows;
  for (const ConstraintRow& row : sweep.rows) {
    const std::string subject =
        "streamline constraint, " + std::string(name_of(row.path)) + " paths on " + sweep.subject;
    const double seconds = kMicro * row.us_p99;
    const auto add = [&](double error, const char* kind) {
      rows.push_back({subject, "streamline", row.parameter(), error, kind, seconds});
    };
    add(row.force_error.p99, "force error, 99 % of steps / N");
    add(row.force_error.max, "force error, worst step / N");
    add(row.force_error.max / sweep.release_force, "force error, worst step / force at release");
    add(row.lag.max, "lag along the line, worst step / diagonal");
    add(row.residual.max, "distance from the line, worst step / diagonal");
  }
  return rows;
}

}  // namespace palpate
