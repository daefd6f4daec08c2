#include "common/device/driver_library.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include <dlfcn.h>

#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/ledger.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// The Debian package that a build needs for a driver.
std::string_view needed_by(std::string_view driver) {
  return driver == "inverse3" ? "libboost-dev" : "libusb-1.0-0-dev";
}

/// The Debian package of a library that the loader of modules did not find.
std::string package_of(const std::string& message) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 1> kPackages{
      {{"libusb-1.0.so", "libusb-1.0-0"}}};
  for (const auto& [library, package] : kPackages) {
    if (message.find(library) != std::string::npos) return std::string(package);
  }
  return {};
}

bool is_name(const std::string& name) {
  const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; };
  return !name.empty() && std::all_of(name.begin(), name.end(), fits);
}

DriverModule& open_new(const std::string& name) {
  std::string known;
  for (const std::string& each : driver_names()) (known += known.empty() ? "" : ", ") += each;
  const std::filesystem::path path = is_name(name)
                                         ? find_helper("palpate_driver_" + name + ".so", HelperKind::kModule)
                                         : std::filesystem::path();
  if (path.empty()) {
    const bool should_be =
        std::find(driver_names().begin(), driver_names().end(), name) != driver_names().end();
    if (should_be) {
      throw work_error("the driver '" + name + "' was not built: there is no palpate_driver_" + name +
                       ".so beside this program; build that target, which there is only where " +
                       std::string(needed_by(name)) + " was there, too");
    }
    throw usage_error("unknown device '" + name +
                      "'; known are mouse, replay:FILE.csv, hands:FILE.csv, simulated and the drivers " +
                      known);
  }
  // Its names stay its own, and what it lacks is said now rather than in the servo.
  void* const library = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const said = ::dlerror();  // NOLINT(concurrency-mt-unsafe): under the lock of open_driver()
    const std::string message = said != nullptr ? said : "it cannot be opened";
    const std::string package = package_of(message);
    throw work_error("driver '" + name + "': " + message +
                     (package.empty() ? "" : "; install the package " + package));
  }
  const auto* const entry = static_cast<const DriverEntry*>(::dlsym(library, kDriverEntry));
  if (entry == nullptr || entry->build == nullptr || std::strcmp(entry->build, driver_build()) != 0) {
    throw work_error("driver '" + name + "': " + path.string() + " is of another build (" +
                     (entry != nullptr && entry->build != nullptr ? entry->build : "no driver at all") +
                     "), this program is of " + driver_build() + "; install both from one package");
  }
  std::string error;
  DriverModule* const module = entry->module(error);
  if (module == nullptr) throw work_error("driver '" + name + "': " + error);
  return *module;
}

}  // namespace

const std::vector<std::string>& driver_names() {
  static const std::vector<std::string> kNames{"falcon",   "dataglove",  "pedal", "pinchglove",
                                               "polhemus", "spacemouse", "vrpn",  "inverse3",
                                               "dhd",      "openhaptics"};
  return kNames;
}

DriverModule& open_driver(const std::string& name) {
  static std::mutex mutex;
  static std::map<std::string, DriverModule*> open;
  const std::lock_guard lock(mutex);
  DriverModule*& module = open[name];
  if (module == nullptr) module = &open_new(name);
  return *module;
}

std::optional<int> enabling_button_of(std::string_view text) noexcept {
  if (text == "none") return DeviceLimits::kNoButton;
  const std::optional<int> button = parsed<int>(text);
  return button && *button >= 0 && *button < DeviceLimits::kButtons ? button : std::nullopt;
}

DeviceText parse_device(std::string_view text) {
  const std::size_t colon = text.find(':');
  DeviceText device{.name = std::string(text.substr(0, colon)), .options = {}, .button = {}, .enable = {}};
  if (colon == std::string_view::npos) return device;
  const std::string said = "--device " + std::string(text) + ": ";
  for (const std::string_view item : split(text.substr(colon + 1), ',')) {
    const std::size_t equals = item.find('=');
    if (equals == std::string_view::npos && item.find('@') != std::string_view::npos) {
      device.options.emplace_back("at", item);
      continue;
    }
    if (equals == 0 || equals == std::string_view::npos) {
      throw usage_error(said + "OPTION=VALUE is expected, found '" + std::string(item) + "'");
    }
    const std::string_view name = item.substr(0, equals), value = item.substr(equals + 1);
    if (name == "button") {
      device.button = enabling_button_of(value);
      if (!device.button) {
        throw usage_error(said + "a button from 0 to 31 or none is expected, found '" + std::string(value) +
                          "'");
      }
    } else if (name == "enable") {
      device.enable = value;
      if (device.enable.empty()) throw usage_error(said + "enable takes a driver, such as pedal");
    } else {
      device.options.emplace_back(name, value);
    }
  }
  if (!device.enable.empty() && device.button == DeviceLimits::kNoButton) {
    throw usage_error(said + "button=none and enable=" + device.enable + " contradict each other");
  }
  return device;
}

OpenedDevice open_device(const DeviceText& device) {
  const Work work("drivers of devices", device.name);
  const auto link_to = [](const std::string& name, const DriverOptions& options) {
    std::string error;
    std::unique_ptr<DriverLink> link = open_driver(name).make_link(options, error);
    if (!link) throw usage_error("device " + name + ": " + error);
    return link;
  };
  OpenedDevice opened{.link = link_to(device.name, device.options), .enabling = {}};
  if (!device.enable.empty()) {
    opened.enabling = {.button = device.button.value_or(0), .link = link_to(device.enable, {})};
  } else {
    opened.enabling.button = device.button.value_or(opened.link->limits().enabling_button);
  }
  return opened;
}

std::string description_of(const EnablingSwitch& enabling, const DeviceText& device) {
  if (enabling.button == DeviceLimits::kNoButton) return {};
  return "while button " + std::to_string(enabling.button) + " of " +
         (enabling.link ? device.enable : device.name) + " is held";
}

}  // namespace palpate
