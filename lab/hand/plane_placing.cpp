#include "lab/hand/plane_placing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <random>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/device_profile.h"
#include "common/device/simulated_device.h"
#include "common/haptics/constraint/grid_axis.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/servo/hand_step.h"
#include "lab/page/html.h"

namespace palpate {
namespace {

constexpr double kRate = 1000.0;   // [Hz]
constexpr double kLongest = 10.0;  // [s]
constexpr double kDwell = 0.3;     // [s]
constexpr double kGain = 2.5;      // [1/s] at which what is missing is made good
constexpr double kSettle = 0.5;    // [s] on the plane before it is taken
const Vec3 kGrip{0.06, 0.0, 0.0};  // on the plane, beside its sphere

/// Where the operator looks, as the device that leads the simulated one.
class Aim final : public Device {
 public:
  explicit Aim(const Vec3& place) : sample_{.position = place} {}
  void look(const Vec3& place) noexcept { sample_.position = place; }
  void press() noexcept { sample_.buttons = 1; }
  bool read(double now, DeviceSample& sample) noexcept override {
    sample = sample_;
    sample.time = now;
    return true;
  }
  void command(const Vec3& /*force*/) noexcept override {}
  void emergency_stop() noexcept override {}
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  DeviceSample sample_;
  DeviceLimits limits_;
};

/// The chain of a means, and how to tell where its plane is.
struct Rig {
  std::unique_ptr<ProxyChain> chain;
  std::shared_ptr<PlaneWidget> widget;
  Vec3 start{0.0};

  [[nodiscard]] Vec3 plane(const HandStep& step) const {
    return widget ? widget->pose(0).center : step.chain.proxy(step.probe);
  }
};

Rig rig_of(PlacingMeans means, double voxel, double target) {
  ChainSettings settings;
  std::vector<std::unique_ptr<Constraint>> links;
  Rig rig;
  switch (means) {
    case PlacingMeans::kHandAlone:
      break;
    case PlacingMeans::kGridDetents:
      settings.grid_axis.detents = 1.0;
      [[fallthrough]];
    case PlacingMeans::kGrid:
      links.push_back(std::make_unique<GridAxis>(Vec3{0.0}, Mat3{1.0}, Vec3{voxel}));
      break;
    case PlacingMeans::kGridLandmark: {
      const GridAxis::Landmark mark{{0.0, 0.0, 1.0}, target};
      links.push_back(std::make_unique<GridAxis>(Vec3{0.0}, Mat3{1.0}, Vec3{voxel}, std::span(&mark, 1)));
      break;
    }
    case PlacingMeans::kWidgetFree:
    case PlacingMeans::kWidgetConstrained: {
      constexpr double kLetsGo = 1e-4;
      if (means == PlacingMeans::kWidgetFree) settings.plane_widget.reach = kLetsGo;
      rig.widget =
          std::make_shared<PlaneWidget>(1.0, Mat3{1.0}, PlanePose{}, std::make_shared<WidgetNewsBuffer>());
      for (int place = 0; place < PlaneWidget::kLinks; ++place)
        links.push_back(std::make_unique<PlaneWidgetLink>(rig.widget, place));
      rig.start = kGrip;
      break;
    }
  }
  rig.chain = std::make_unique<ProxyChain>(std::move(links), settings);
  return rig;
}

double at_part(std::vector<double> values, double part) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[as_size(std::lround(part * static_cast<double>(values.size() - 1)))];
}

std::string millimetres(double metres) { return short_number(1e3 * metres); }

/// "1.2 (0.9 to 1.4)", all times `unit`.
std::string interval_text(const MedianInterval& interval, double unit = 1.0) {
  const auto digits = [unit](double value) { return three_digits(unit * value); };
  std::string text = digits(interval.median);
  if (std::isfinite(interval.low) && std::isfinite(interval.high))
    text += " (" + digits(interval.low) + " to " + digits(interval.high) + ")";
  return text;
}

}  // namespace

MedianInterval median_interval(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  const double median = 0.5 * (values[(n - 1) / 2] + values[n / 2]);
  // P(at most k of n values lie below the median) = sum_(i <= k) binomial(n, i) / 2^n, by logarithms.
  constexpr double kEitherTail = 0.025;
  double term = -static_cast<double>(n) * std::numbers::ln2, tail = 0.0;
  std::size_t rank = 0;  // of values from either end that are left out
  for (std::size_t i = 0; i < n / 2; ++i) {
    tail += std::exp(term);
    if (tail > kEitherTail) break;
    rank = i + 1;
    term += std::log(static_cast<double>(n - i) / static_cast<double>(i + 1));
  }
  if (rank == 0) return {median, -HUGE_VAL, HUGE_VAL};
  return {median, values[rank - 1], values[n - rank]};
}

std::string name_of(PlacingMeans means) {
  constexpr std::array<const char*, kPlacingMeansCount> kNames{
      "hand alone",         "grid, free along the axis", "grid with detents",
      "grid with landmark", "plane widget, free",        "plane widget, constrained"};
  return kNames[as_size(means)];
}

PlacingTrial place_plane(PlacingMeans means, const PlacingSettings& settings, int trial) {
  constexpr double kNearest = 0.02, kFarthest = 0.08;  // [m]
  std::mt19937_64 random(settings.seed + 1000003U * static_cast<std::uint64_t>(trial));
  std::uniform_real_distribution<double> away{kNearest, kFarthest};
  const double wanted = away(random) * ((random() & 1U) != 0 ? 1.0 : -1.0);
  const Vec3 target{0.0, 0.0, settings.voxel * std::round(wanted / settings.voxel)};

  Rig rig = rig_of(means, settings.voxel, target.z);
  const DeviceProfile& profile = find_profile("premium3");
  SimulatedDeviceOptions options{.profile = profile, .hand = kFirmHand, .limits = safe_limits(profile)};
  options.operator_settings.tremor = settings.tremor;
  options.operator_settings.seed = random();
  Vec3 looked = rig.start;
  Aim aim(looked);
  SimulatedDevice device(options, aim);
  const std::shared_ptr<PlaneWidget> widget = rig.widget;
  HandStepper stepper(std::move(rig.chain), options.limits);

  PlacingTrial result;
  HandInput hand{.present = true};
  double within_since = -1.0;
  for (int n = 0; n < static_cast<int>(kRate * (kSettle + kLongest)); ++n) {
    hand.time = n / kRate;
    if (!device.read(hand.time, hand.sample)) break;
    const HandStep step = stepper.step(hand);
    device.command(step.force);
    const double since = hand.time - kSettle;
    if (since < 0.0) continue;
    aim.press();
    const Vec3 missing = target - rig.plane(step);
    looked += (kGain / kRate) * missing;
    aim.look(looked);
    const bool within = std::abs(missing.z) <= 0.5 * settings.voxel;
    if (!within) within_since = -1.0;
    if (within && within_since < 0.0) within_since = since;
    if (!within || since - within_since < kDwell) continue;
    result.placed = true;
    result.seconds = since;
    result.off = std::abs(missing.z);
    result.sideways = std::hypot(missing.x, missing.y);
    break;
  }
  return result;
}

std::vector<PlacingRow> run_plane_placing(const PlacingSettings& settings, Progress* progress) {
  if (progress != nullptr)
    progress->begin("placing planes", std::size_t{kPlacingMeansCount} * as_size(settings.trials));
  std::vector<PlacingRow> rows;
  std::vector<double> alone;  // [s] of each trial by the first means
  for (int m = 0; m < kPlacingMeansCount; ++m) {
    PlacingRow row{.means = static_cast<PlacingMeans>(m), .trials = settings.trials};
    std::vector<double> seconds, off, sideways, gains;
    for (int trial = 0; trial < settings.trials; ++trial) {
      if (progress != nullptr) {
        progress->check();
        progress->advance();
      }
      const PlacingTrial one = place_plane(row.means, settings, trial);
      const double taken = one.placed ? one.seconds : kLongest;
      if (row.means == PlacingMeans::kHandAlone) alone.push_back(taken);
      gains.push_back(alone[as_size(trial)] - taken);
      if (!one.placed) continue;
      ++row.placed;
      seconds.push_back(one.seconds);
      off.push_back(one.off);
      sideways.push_back(one.sideways);
    }
    constexpr double kMost = 0.9;
    if (!gains.empty()) row.gain = median_interval(std::move(gains));
    if (!seconds.empty()) row.seconds = median_interval(seconds);
    row.seconds_p90 = at_part(seconds, kMost);
    if (!off.empty()) row.off = median_interval(off);
    row.off_p90 = at_part(off, kMost);
    row.sideways_p90 = at_part(sideways, kMost);
    rows.push_back(row);
  }
  return rows;
}

ReportSection plane_placing_section(const std::vector<PlacingRow>& rows, const PlacingSettings& settings) {
  ReportSection section;
  section.title = "Placing a cutting plane by hand";
  section.columns = {"means",    "placed",          "sooner than alone [s]", "median [s]",
                     "90 % [s]", "median off [mm]", "90 % off [mm]",         "90 % sideways [mm]"};
  for (const PlacingRow& row : rows) {
    const std::string name = name_of(row.means);
    section.table.push_back({name, std::to_string(row.placed) + " of " + std::to_string(row.trials),
                             row.means == PlacingMeans::kHandAlone ? "" : interval_text(row.gain),
                             row.placed > 0 ? interval_text(row.seconds) : "", short_number(row.seconds_p90),
                             row.placed > 0 ? interval_text(row.off, 1e3) : "", millimetres(row.off_p90),
                             millimetres(row.sideways_p90)});
    const std::string tremor = "tremor=" + millimetres(settings.tremor) + " mm";
    section.measurements.push_back({"placing a plane", name, tremor, "placed [part]",
                                    static_cast<double>(row.placed) / std::max(row.trials, 1)});
    if (row.means != PlacingMeans::kHandAlone) {
      section.measurements.push_back(
          {"placing a plane", name, tremor, "median gain over the hand alone [s]", row.gain.median});
      if (std::isfinite(row.gain.low)) {
        section.measurements.push_back(
            {"placing a plane", name, tremor, "gain, lower end of 95 % [s]", row.gain.low});
        section.measurements.push_back(
            {"placing a plane", name, tremor, "gain, upper end of 95 % [s]", row.gain.high});
      }
    }
    if (row.placed == 0) continue;
    section.measurements.push_back({"placing a plane", name, tremor, "median time [s]", row.seconds.median});
    section.measurements.push_back(
        {"placing a plane", name, tremor, "median distance off [mm]", 1e3 * row.off.median});
    section.measurements.push_back(
        {"placing a plane", name, tremor, "90 % distance sideways [mm]", 1e3 * row.sideways_p90});
  }
  section.paragraphs = {
      "A simulated hand (reaction 0.2 s, lag 0.1 s, tremor " + millimetres(settings.tremor) +
          " mm on each axis) on a simulated arm brings a plane to a node of the grid 20 to 80 mm away, and "
          "has placed "
          "it once it has stayed within half a voxel (" +
          millimetres(0.5 * settings.voxel) + " mm) for 0.3 s; 10 s at most. " +
          "'Off' is the distance along the normal then, 'sideways' that of the plane's centre across it. "
          "Times and "
          "distances are of those that were placed; the same targets and tremor for every means. 'Sooner "
          "than "
          "alone' pairs each with the hand alone at the same target; one that was never placed counts as 10 "
          "s. In "
          "brackets: the interval that holds the true median with 95 % probability, by order statistics.",
      "It is a model of a hand, and no person: it aims steadily, never looks away, and knows the target to "
      "rounding."};
  return section;
}

std::vector<StabilityCase> plane_placing_cases(const std::vector<PlacingRow>& rows) {
  std::vector<StabilityCase> cases;
  for (const PlacingRow& row : rows) {
    const bool holds_line = row.means == PlacingMeans::kGrid || row.means == PlacingMeans::kGridDetents ||
                            row.means == PlacingMeans::kGridLandmark ||
                            row.means == PlacingMeans::kWidgetConstrained;
    if (!holds_line || row.placed == 0) continue;
    StabilityCase c;
    c.row = {name_of(row.means) + ": the other axes stay", row.sideways_p90, 0.0, row.sideways_p90 == 0.0};
    c.unit = "m";
    c.meaning = "90 % of " + std::to_string(row.placed) + " planes, placed by a hand of tremor and delay";
    cases.push_back(c);
  }
  return cases;
}

}  // namespace palpate
