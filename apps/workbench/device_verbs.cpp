#include <algorithm>
#include <cmath>
#include <exception>
#include <optional>
#include <utility>

#include "apps/workbench/link_check.h"
#include "apps/workbench/workbench_device.h"
#include "apps/workbench/workbench_verbs.h"
#include "common/base/error.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/device/driver_library.h"
#include "common/device/workbench_option.h"
#include "common/haptics/coupling.h"
#include "common/servo/real_time.h"

namespace palpate {
namespace {

/// A driver and whether it can start on this machine.
struct DriverState {
  std::string name;
  std::string problem;  ///< empty: none
};

/// What the drivers see on this machine's buses.
struct Survey {
  std::vector<DriverState> drivers;
  std::vector<FoundDevice> devices;
};

/// Asks every driver, and the one of `device` where that is another.
Survey survey(const std::string& device) {
  std::vector<std::string> names = driver_names();
  if (const std::string asked = parse_device(device).name;
      !asked.empty() && std::find(names.begin(), names.end(), asked) == names.end()) {
    names.push_back(asked);
  }
  Survey seen;
  for (const std::string& name : names) {
    DriverState state{name, {}};
    try {
      std::vector<FoundDevice> found = open_driver(name).find(state.problem);
      // Drivers on one bus see the same devices.
      for (FoundDevice& each : found) {
        const bool known = std::any_of(seen.devices.begin(), seen.devices.end(),
                                       [&](const FoundDevice& d) { return d.place == each.place; });
        if (!known) seen.devices.push_back(std::move(each));
      }
    } catch (const Error& error) {
      if (error.code() == ExitCode::kUsage) throw;
      state.problem = error.what();
    }
    seen.drivers.push_back(std::move(state));
  }
  return seen;
}

std::string left_column(std::string text, std::size_t width) {
  text.resize(std::max(text.size() + 2, width), ' ');
  return text;
}

std::string devices_text(const Survey& seen) {
  std::string text;
  for (const FoundDevice& each : seen.devices) {
    text += left_column(each.name, 34) + left_column(each.id, 11) + left_column(each.place, 12);
    text += each.access == "ok" ? left_column("", 10) : left_column(each.access, 10);
    text += each.driver.empty() ? each.note : "--device " + each.driver;
    text += "\n";
  }
  if (seen.devices.empty()) text = "no device that this version knows is plugged in\n";
  for (const DriverState& each : seen.drivers) {
    if (!each.problem.empty()) text += "driver " + each.name + ": " + each.problem + "\n";
  }
  return text;
}

Json devices_json(const Survey& seen) {
  Json devices = Json::array(), drivers = Json::array();
  for (const FoundDevice& each : seen.devices) {
    devices.push_back({{"name", each.name},
                       {"id", each.id},
                       {"place", each.place},
                       {"access", each.access},
                       {"driver", each.driver},
                       {"note", each.note}});
  }
  for (const DriverState& each : seen.drivers) {
    drivers.push_back({{"name", each.name}, {"ok", each.problem.empty()}, {"problem", each.problem}});
  }
  return {{"devices", devices}, {"drivers", drivers}};
}

std::string milliseconds(std::uint64_t ns) {
  constexpr double kMicro = 1e-3;  // [ms] of a microsecond: as many digits as say something
  return short_number(kMicro * std::round(1e-3 * static_cast<double>(ns))) + " ms";
}

std::string check_text(const LinkCheck& check) {
  std::string text;
  for (const LinkCheck::Step& step : check.steps) {
    text += "  " + left_column(short_number(std::round(1e3 * step.time)) + " ms", 12) +
            std::string(name_of(step.phase)) + "\n";
  }
  if (check.status.uploads > 0) text += "  firmware    " + counted(check.status.uploads, "try") + "\n";
  if (check.intervals.count() == 0) return text;
  text += "  rate        " + short_number(std::round(check.rate())) + " samples a second\n";
  text += "  evenness    half within " + milliseconds(check.intervals.percentile_ns(0.5)) + ", 99 % within " +
          milliseconds(check.intervals.percentile_ns(0.99)) + ", at most " +
          milliseconds(check.intervals.max_ns()) + "\n";
  text += "  round       half within " + milliseconds(check.rounds.percentile_ns(0.5)) + ", 99 % within " +
          milliseconds(check.rounds.percentile_ns(0.99)) + ", from command to position\n";
  text += "  answers     " + std::to_string(check.status.rounds) + ", lost " +
          std::to_string(check.status.lost) + ", implausible " + std::to_string(check.status.implausible) +
          ", faults " + std::to_string(check.status.faults) + "\n";
  return text;
}

Json check_json(const LinkCheck& check) {
  Json steps = Json::array();
  for (const LinkCheck::Step& step : check.steps) {
    steps.push_back({{"seconds", step.time}, {"phase", name_of(step.phase)}});
  }
  const auto ms = [](std::uint64_t ns) { return 1e-6 * static_cast<double>(ns); };
  return {{"phases", steps},
          {"ready", check.ready},
          {"place", check.place},
          {"rate_hz", check.rate()},
          {"interval_ms_p50", ms(check.intervals.percentile_ns(0.5))},
          {"interval_ms_p99", ms(check.intervals.percentile_ns(0.99))},
          {"interval_ms_max", ms(check.intervals.max_ns())},
          {"round_ms_p50", ms(check.rounds.percentile_ns(0.5))},
          {"round_ms_p99", ms(check.rounds.percentile_ns(0.99))},
          {"rounds", check.status.rounds},
          {"lost", check.status.lost},
          {"implausible", check.status.implausible},
          {"faults", check.status.faults},
          {"uploads", check.status.uploads}};
}

/// How old a sample is when its force is told to the device, and what that means for walls, by (3) of
/// haptics/coupling.h at the longest of 99 in 100.
std::string delay_text(const TimeHistogram& delays) {
  if (delays.count() == 0) return {};
  const double longest = 1e-9 * static_cast<double>(delays.percentile_ns(0.99));
  const double bound = stiffness_bound({.damping = 1.0, .delay = longest}, 0.0).stiffness;
  return "  force       half " + milliseconds(delays.percentile_ns(0.5)) + " after its sample, 99 % within " +
         milliseconds(delays.percentile_ns(0.99)) + ": walls up to " + short_number(std::round(bound)) +
         " N/m for each N s/m of the arm's own damping\n";
}

/// The device that is asked for, or all that are plugged in, may be opened and have a driver; a driver works
/// the first of its devices.
std::vector<std::string> devices_to_check(const std::string& asked, const Survey& seen) {
  if (!asked.empty()) return {asked};
  std::vector<std::string> drivers;
  for (const FoundDevice& each : seen.devices) {
    const bool usable = !each.driver.empty() && each.access == "ok";
    if (usable && std::find(drivers.begin(), drivers.end(), each.driver) == drivers.end()) {
      drivers.push_back(each.driver);
    }
  }
  return drivers;
}

/// What stands in the way of each device on the buses and of each driver, a line each; the udev rules that
/// help go into `rules`.
std::vector<std::string> obstacles(const Survey& seen, Json& rules) {
  std::vector<std::string> lines;
  for (const FoundDevice& each : seen.devices) {
    if (each.access == "denied") {
      rules.push_back(udev_rule(each.id));
      lines.push_back("the " + each.name +
                      " may not be opened by you: put this line into /etc/udev/rules.d/70-palpate.rules, run "
                      "`udevadm control --reload`, and plug it in anew:\n    " +
                      udev_rule(each.id));
    } else if (each.access != "ok") {
      lines.push_back("the " + each.name + " at " + each.place + " cannot be opened (" + each.access +
                      "): end other programs that use it, or plug it in anew");
    } else if (each.driver.empty()) {
      lines.push_back("the " + each.name + " at " + each.place + " cannot be used: " + each.note);
    }
  }
  for (const DriverState& each : seen.drivers) {
    if (!each.problem.empty()) lines.push_back("driver " + each.name + ": " + each.problem);
  }
  return lines;
}

ExitCode run_devices(const Document& options, const VerbContext& context) {
  const Survey seen = survey(options.trial.device);
  context.console.print(devices_text(seen));
  context.console.print_json(json_text(devices_json(seen)));
  return ExitCode::kDone;
}

ExitCode run_doctor(const Document& document, const VerbContext& context) {
  const TrialOptions& options = document.trial;
  const WorkbenchGeometry workbench = workbench_of(document.hand.workbench);
  const Survey seen = survey(options.device);
  std::string text = devices_text(seen);
  Json json = devices_json(seen);
  Json rules = Json::array(), checks = Json::array();
  std::vector<std::string> advice = obstacles(seen, rules);
  // Who asks for one device is told of the others, and answered for that one.
  bool usable = !options.device.empty() || advice.empty();
  const bool real_time = request_real_time_priority(1);
  text += std::string("real-time priority is ") + (real_time ? "allowed\n" : "refused\n");
  const std::vector<std::string> devices = devices_to_check(options.device, seen);
  for (const std::string& device : devices) {
    const DeviceText named = device_at_workbench(device, workbench);
    OpenedDevice opened =
        open_at_workbench(named, workbench, [&](const std::string& line) { context.console.note(line); });
    const auto work = [&](DriverLink& link, const std::string& name) -> Json& {
      context.progress.begin("working the device", 0);
      const LinkCheck check = check_link(link, options.seconds, options.patience, context.progress);
      text += name + (check.ready ? "\n" : ": not ready\n") + check_text(check);
      Json checked = check_json(check);
      checked["device"] = name;
      checks.push_back(std::move(checked));
      for (std::string& line : advice_on(check)) advice.push_back(std::move(line));
      usable = usable && check.ready;
      return checks.back();
    };
    Json& checked = work(*opened.link, device);
    if (checked["ready"] == true && opened.link->atoms().has_position && opened.link->poses() == nullptr) {
      context.progress.begin("timing its forces", 0);
      const TimeHistogram delays = force_delays(std::move(opened.link), options.seconds, context.progress);
      text += delay_text(delays);
      checked["force_delay_ms_p50"] = 1e-6 * static_cast<double>(delays.percentile_ns(0.5));
      checked["force_delay_ms_p99"] = 1e-6 * static_cast<double>(delays.percentile_ns(0.99));
    }
    if (opened.enabling.link) work(*opened.enabling.link, named.enable);
    if (const std::string held = description_of(opened.enabling, named); !held.empty()) {
      text += "  force       only " + held + "\n";
    }
  }
  for (const std::string& line : advice) text += "- " + line + "\n";
  if (usable && !devices.empty() && advice.empty()) text += "all is well\n";
  json["checks"] = checks;
  json["usable"] = usable;
  json["real_time_priority"] = real_time;
  json["udev_rules"] = rules;
  json["advice"] = advice;
  context.console.print(text);
  context.console.print_json(json_text(json));
  if (!usable) throw work_error("not all that was found can be used; the lines above say what to do");
  return ExitCode::kDone;
}

}  // namespace

Verb devices_verb(std::vector<UsageExample> examples) {
  return {.name = "devices",
          .summary = "devices that are plugged in, and drivers for them",
          .groups = {Group::kSurvey},
          .examples = std::move(examples),
          .run = run_devices};
}

Verb doctor_verb(std::vector<UsageExample> examples) {
  return {
      .name = "doctor",
      .summary = "permissions, firmware, rate, jitter and latency of a device, and what to do about them",
      .details =
          "Without --device all that are plugged in. Ends with 0 where every device that it found, or the one of\n"
          "--device, is ready, else with 1.",
      .groups = {Group::kCheck},
      .examples = std::move(examples),
      .run = run_doctor};
}

}  // namespace palpate
