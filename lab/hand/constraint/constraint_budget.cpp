#include "lab/hand/constraint/constraint_budget.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "lab/hand/streamline_run.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr std::array<int, 10> kBudgetIterations{1, 2, 3, 4, 6, 8, 16, 32, 64, 128};
constexpr double kServoStep = 1e-3;  // s

std::size_t steps_of(Effort effort) {
  switch (effort) {
    case Effort::kQuick:
      return 1000;
    case Effort::kThorough:
      return 20'000;
    default:
      return 4000;
  }
}

/// A hand along the guide: pulled aside slowly, trembling, and leaping within reach every now and then.
std::vector<Vec3> hand_of(const BudgetSubject& subject, std::size_t steps) {
  constexpr double kBeside = 0.002, kTremor = 0.0005, kLeap = 0.003;  // m, in each axis
  constexpr double kSettled = 0.05;  // s in which the hand comes off the feature
  constexpr std::size_t kLeapEvery = 60;
  std::mt19937_64 random(3);
  const auto unit = [&random] { return static_cast<double>(random() >> 11U) * 0x1p-52 - 1.0; };
  const auto waves = [](const Vec3& frequencies, double t) {
    const Vec3 turns = 2.0 * std::numbers::pi * t * frequencies;
    return Vec3{std::sin(turns.x), std::sin(turns.y), std::sin(turns.z)};
  };
  std::vector<Vec3> path;
  path.reserve(steps);
  Vec3 leap{0.0};
  for (std::size_t n = 0; n < steps; ++n) {
    const double t = kServoStep * static_cast<double>(n);
    if (n % kLeapEvery == kLeapEvery - 1) {
      const double x = unit(), y = unit(), z = unit();
      leap = kLeap * Vec3{x, y, z};
    }
    const Vec3 aside = kBeside * waves({0.31, 0.43, 0.57}, t) + kTremor * waves({8.3, 9.7, 11.6}, t) + leap;
    path.push_back(subject.guide(t) + std::min(1.0, t / kSettled) * aside);
  }
  return path;
}

BudgetRow measure(const BudgetSubject& subject, const std::vector<Vec3>& path, int iterations) {
  const double stiffness = ChainSettings{}.stiffness;
  const auto constraint = subject.make();
  const IdealProxy ideal = subject.make_ideal();
  BudgetRow row{.constraint = subject.name, .iterations = iterations, .steps = path.size()};
  std::vector<double> residuals, forces, times;
  UpdateBudget budget;
  budget.iterations = iterations;
  for (const Vec3& probe : path) {
    LinkUpdate link;
    const double before = thread_microseconds();
    constraint->update(probe, budget, link);
    times.push_back(thread_microseconds() - before);
    const Vec3 wanted = ideal(probe);
    row.used = std::max(row.used, link.iterations);
    row.fallbacks += link.state == HoldState::kFellBack ? 1 : 0;
    if (link.state == HoldState::kFree) continue;  // a search that goes on: nothing holds the probe as yet
    forces.push_back(stiffness * glm::distance(link.proxy, wanted));
    residuals.push_back(subject.off_feature ? subject.off_feature(link.proxy) : 0.0);
  }
  row.residual = errors_of(std::move(residuals));
  row.force_error = errors_of(std::move(forces));
  const StepErrors time = errors_of(std::move(times));
  row.us_p50 = time.median;
  row.us_p99 = time.p99;
  row.us_max = time.max;
  return row;
}

}  // namespace

ConstraintBudget run_constraint_budget(Effort effort, Progress* progress) {
  if (progress) progress->begin("constraints by their budget", 0);
  ConstraintBudget budget;
  budget.clock_microseconds = clock_microseconds();
  for (const BudgetSubject& subject : budget_subjects()) {
    const std::vector<Vec3> path = hand_of(subject, steps_of(effort));
    for (const int iterations : kBudgetIterations) {
      if (progress) progress->check();
      budget.rows.push_back(measure(subject, path, iterations));
      if (budget.rows.back().used == 0) break;  // it does not search
    }
  }
  return budget;
}

ReportSection constraint_budget_section(const ConstraintBudget& budget) {
  ReportSection section;
  section.title = "Every constraint and what its budget buys";
  section.paragraphs = {
      "One update of each constraint on features that are known in closed form, with the iterations of its "
      "budget swept. A made hand trembles beside the feature and leaps within reach of it. The force error "
      "is "
      "the stiffness times the distance of the proxy from where it would be with unlimited work; the "
      "distance "
      "is that of the proxy from the feature. Constraints that do not search have one row. Times are "
      "processor "
      "time of the thread and contain " +
      three_digits(budget.clock_microseconds) + " us for reading the clock."};
  section.columns = {"constraint",
                     "iterations",
                     "force error, 99 % [N]",
                     "worst [N]",
                     "worst distance [m]",
                     "us, half",
                     "99 %",
                     "worst",
                     "used",
                     "fell back"};
  std::vector<PlotSeries> series;
  constexpr double kMicro = 1e-6;
  for (const BudgetRow& row : budget.rows) {
    section.table.push_back({row.constraint, std::to_string(row.iterations),
                             three_digits(row.force_error.p99), three_digits(row.force_error.max),
                             three_digits(row.residual.max), three_digits(row.us_p50),
                             three_digits(row.us_p99), three_digits(row.us_max), std::to_string(row.used),
                             std::to_string(row.fallbacks)});
    const auto add = [&](double error, const char* kind) {
      section.work_precision.push_back({row.constraint + " constraint, in closed form", row.constraint,
                                        "iterations=" + std::to_string(row.iterations), error, kind,
                                        kMicro * row.us_p99});
    };
    add(row.force_error.p99, "force error, 99 % of steps / N");
    add(row.force_error.max, "force error, worst step / N");
    add(row.residual.max, "distance from the feature, worst step / m");
    if (series.empty() || series.back().name != row.constraint) series.push_back({row.constraint, {}});
    series.back().points.push_back({row.us_p99, row.force_error.p99});
  }
  section.plots = {{"constraint_budget.svg", "force error against run time of every constraint, log-log",
                    svg({.title = "Force error of every constraint against run time",
                         .x_label = "time that 99 % of the steps stay below [us]",
                         .y_label = "force error that 99 % of the steps stay below [N]",
                         .series = std::move(series)})}};
  return section;
}

}  // namespace palpate
