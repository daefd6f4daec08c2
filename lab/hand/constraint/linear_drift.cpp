#include "lab/hand/constraint/linear_drift.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/base/index.h"
#include "common/haptics/constraint/linear.h"
#include "common/haptics/constraint/streamline.h"
#include "common/haptics/reference_frame.h"
#include "lab/data/formula_flow.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/html.h"
#include "lab/page/plot.h"

namespace palpate {
namespace {

constexpr double kScale = 0.2;                                                       // m a unit of data
constexpr double kDriftStep = 1e-3;                                                  // s
constexpr std::array<double, 8> kSpeeds{0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0};  // m/s
constexpr std::array<double, 5> kRates{3.0, 5.0, 10.0, 20.0, 40.0};                  // 1/m

/// A line in closed form, workspace units, by a parameter that need not be its arc.
class KnownLine {
 public:
  KnownLine(DriftFlow flow, double rate) : flow_(flow), rate_(rate) {}

  [[nodiscard]] std::shared_ptr<const VectorField> field() const {
    return flow_ == DriftFlow::kParting ? parting_flow(rate_ * kScale) : turning_flow(0.0);
  }
  [[nodiscard]] Vec3 at(double u) const {
    if (flow_ == DriftFlow::kTurning) return Vec3{std::cos(u), std::sin(u), 0.0} / rate_;
    return {u, kEnd * std::exp(rate_ * (u - kDriftWay)), 0.0};
  }
  /// |d at / du|.
  [[nodiscard]] double pace(double u) const {
    return flow_ == DriftFlow::kTurning ? 1.0 / rate_ : std::hypot(1.0, rate_ * at(u).y);
  }
  /// Whether the way is over.
  [[nodiscard]] bool ended(double u) const {
    return flow_ == DriftFlow::kTurning ? u > kDriftWay * rate_ : u > kDriftWay;
  }
  /// Distance of `x` from the line.
  [[nodiscard]] double distance(const Vec3& x) const {
    if (flow_ == DriftFlow::kTurning) return std::hypot(std::hypot(x.x, x.y) - 1.0 / rate_, x.z);
    // Newton on the slope of the squared distance; `x` is close to the line, and the line is convex.
    double u = x.x;
    constexpr int kSteps = 20;
    for (int n = 0; n < kSteps; ++n) {
      const double y = at(u).y, slope = rate_ * y, bend = rate_ * slope;
      u -= (u - x.x + (y - x.y) * slope) / (1.0 + slope * slope + std::max(0.0, (y - x.y) * bend));
    }
    return glm::distance(at(u), x);
  }

 private:
  static constexpr double kEnd = 0.06;  // m, where a parting line is at the end of its way
  DriftFlow flow_;
  double rate_;
};

std::unique_ptr<Constraint> constraint_of(FollowMethod method, const KnownLine& line) {
  const auto field = line.field();
  const Workspace workspace(kScale, field->frame());
  std::unique_ptr<Constraint> made;
  if (method == FollowMethod::kStreamline) {
    made = std::make_unique<StreamlineConstraint>(
        std::make_shared<LiveLine>(field, LiveLine::kFollowTolerance, 1), workspace);
  } else {
    made = std::make_unique<LinearConstraint>(std::make_unique<FlowFrame>(field, workspace));
  }
  ChainSettings settings;
  settings.linear.axes[1].rule = settings.linear.axes[2].rule = AxisRule::kFixed;
  made->apply(settings);
  return made;
}

LinearDriftRow measure(DriftFlow flow, FollowMethod method, double rate, double speed) {
  const KnownLine line(flow, rate);
  const auto constraint = constraint_of(method, line);
  UpdateBudget budget;
  if (method == FollowMethod::kLinearStep) budget.iterations = 1;
  LinearDriftRow row{.flow = flow, .method = method, .rate = rate, .speed = speed};
  int steps = 0;
  for (double u = 0.0; !line.ended(u); u += speed * kDriftStep / line.pace(u)) {
    LinkUpdate link;
    const double before = thread_microseconds();
    constraint->update(line.at(u), budget, link);
    row.us_mean += thread_microseconds() - before;
    ++steps;
    const bool holds = link.state == HoldState::kHeld || link.state == HoldState::kFellBack;
    row.drift = std::max(row.drift, holds ? line.distance(link.proxy) : HUGE_VAL);
  }
  row.us_mean /= steps;
  return row;
}

/// A curve for each flow and method; the settled steps would lie on the others.
template <typename X>
std::vector<PlotSeries> series_of(const std::vector<LinearDriftRow>& rows, const X& x) {
  std::vector<PlotSeries> all;
  for (const LinearDriftRow& row : rows) {
    const std::string name =
        std::string(name_of(row.method)) + ", " + (row.flow == DriftFlow::kParting ? "parting" : "circle");
    auto found = std::find_if(all.begin(), all.end(), [&](const PlotSeries& s) { return s.name == name; });
    if (found == all.end()) found = all.insert(found, {name, {}});
    found->points.push_back({x(row), 1e3 * row.drift});
  }
  return all;
}

}  // namespace

std::string_view name_of(FollowMethod method) noexcept {
  constexpr std::array<std::string_view, 3> kNames{"linear step", "linear, settled", "streamline"};
  return kNames[as_size(method)];
}

std::string_view name_of(DriftFlow flow) noexcept {
  return flow == DriftFlow::kParting ? "lines that part" : "circle";
}

LinearDrift run_linear_drift(Progress* progress) {
  if (progress) progress->begin("drift of linear constraints", 0);
  LinearDrift drift;
  for (const DriftFlow flow : {DriftFlow::kParting, DriftFlow::kTurning}) {
    for (const FollowMethod method : kFollowMethods) {
      if (progress) progress->check();
      for (const double speed : kSpeeds) drift.by_speed.push_back(measure(flow, method, kDriftRate, speed));
      for (const double rate : kRates) drift.by_rate.push_back(measure(flow, method, rate, kDriftSpeed));
    }
  }
  return drift;
}

ReportSection linear_drift_section(const LinearDrift& drift) {
  ReportSection section;
  section.title = "Following a line by its tangents, and by itself";
  section.paragraphs = {
      "A hand goes " + three_digits(kDriftWay) +
      " m along lines that are known in closed form: y = y0 exp(r x), which part at the divergence r, and "
      "circles. The linear model holds the proxy on the tangent at the last proxy (Ikits 2006, sec. 6.3 and "
      "figure 6.5), which is Euler's rule: its drift grows with the speed of the hand and with what the flow "
      "does to errors. Settling the step at each update does not help, since the line is not known to it. "
      "The "
      "streamline constraint holds on to the line itself; what is left is the tolerance of its tracing."};
  section.plots = {
      {"linear_drift.svg", "drift against the speed of the hand, log-log",
       svg({.title = "Drift from the line against the speed of the hand",
            .x_label =
                "speed of the hand [m/s], divergence or curvature " + three_digits(kDriftRate) + " 1/m",
            .y_label = "largest distance of the proxy from the line [mm]",
            .series = series_of(drift.by_speed, [](const LinearDriftRow& r) { return r.speed; })})},
      {"linear_drift_rate.svg", "drift against divergence, log-log",
       svg({.title = "Drift from the line against divergence and curvature",
            .x_label =
                "divergence, or curvature of the circle [1/m], at " + three_digits(kDriftSpeed) + " m/s",
            .y_label = "largest distance of the proxy from the line [mm]",
            .series = series_of(drift.by_rate, [](const LinearDriftRow& r) { return r.rate; })})}};
  section.columns = {"lines", "held by", "rate [1/m]", "speed [m/s]", "drift [mm]", "us a step"};
  constexpr double kMicro = 1e-6;
  const auto add = [&](const LinearDriftRow& row, bool in_table) {
    const std::string flow(name_of(row.flow)), method(name_of(row.method));
    section.work_precision.push_back(
        {"following " + flow, method,
         "rate=" + three_digits(row.rate) + " 1/m, speed=" + three_digits(row.speed) + " m/s", row.drift,
         "largest distance from the line / m", kMicro * row.us_mean});
    if (!in_table) return;
    section.table.push_back({flow, method, three_digits(row.rate), three_digits(row.speed),
                             three_digits(1e3 * row.drift), three_digits(row.us_mean)});
  };
  for (const LinearDriftRow& row : drift.by_speed) add(row, row.speed == kDriftSpeed);
  for (const LinearDriftRow& row : drift.by_rate) add(row, false);
  return section;
}

}  // namespace palpate
