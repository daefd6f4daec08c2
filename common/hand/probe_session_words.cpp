// What a ProbeSession says of its settings: limits, ranges of curves, options of the command line.

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/hand/mode/grid_mode.h"
#include "common/hand/probe_session.h"
#include "common/servo/wall_loop.h"

namespace palpate {

std::string ProbeSession::stiffness_note() const {
  const double asked = choice_.settings.stiffness;
  if (asked > options_.most_stiffness) return tuned_note(asked, options_.most_stiffness);
  if (!options_.simulated) return {};
  return stiffness_warning(wall_loop(options_.simulated->profile, options_.servo_rate), asked,
                           choice_.settings.damping);
}

std::string ProbeSession::passive_limit() const {
  if (std::isfinite(options_.most_stiffness))
    return "tuned: up to " + short_number(options_.most_stiffness) + " N/m";
  if (!options_.simulated) return {};
  const StiffnessBound bound =
      stiffness_bound(wall_loop(options_.simulated->profile, options_.servo_rate), choice_.settings.damping);
  return "passive up to " + short_number(bound.stiffness) + " N/m (" + std::string(name_of(bound.limit)) +
         ")";
}

std::pair<double, double> ProbeSession::measure_range() const {
  constexpr double kSteepPart = 0.125;  // of the diagonal
  std::pair<double, double> values{0.0, open_.field ? open_.field->max_speed() : 0.0};
  const LinearMeasure measure = choice_.settings.linear.measure;
  if (measure != LinearMeasure::kSpeed && open_.scalar) {
    values = {open_.scalar->lowest(), open_.scalar->highest()};
  }
  if (measure == LinearMeasure::kGradient && !open_.empty()) {
    values = {0.0, (values.second - values.first) / (kSteepPart * open_.diagonal())};
  }
  if (!(values.first < values.second)) return {values.first, values.first + 1.0};  // one value everywhere
  return values;
}

std::vector<std::pair<std::string, std::string>> ProbeSession::options() const {
  if (!available()) return {};
  auto options = touch_options_of(choice_, options_.modes[choice_.mode].name, has_tensors());
  const auto has = [this](const char* mode) {
    return std::any_of(options_.modes.begin(), options_.modes.end(),
                       [&](const HapticMode& each) { return each.name == mode; });
  };
  if (has(kGridMode)) {
    for (auto& option : grid_options(choice_.settings.grid_axis)) options.push_back(std::move(option));
  }
  if (has(kPlaneWidgetMode)) {
    PlaneWidgetSettings planes = choice_.settings.plane_widget;
    if (this->planes()) planes.poses = this->planes()->poses;
    for (auto& option : plane_options(planes)) options.push_back(std::move(option));
  }
  if (!notes_.entries().empty()) options.emplace_back("annotation", text_of(notes_.entries()));
  if (options_.workspace_scale > 0.0)
    options.emplace_back("workspace-scale", exact_number(options_.workspace_scale));
  return options;
}

}  // namespace palpate
