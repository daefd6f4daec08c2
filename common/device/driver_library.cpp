#include "common/device/driver_library.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>

#include <dlfcn.h>

#include "common/base/error.h"
#include "common/base/find_helper.h"
#include "common/base/number_text.h"

namespace palpate {
namespace {

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
      throw work_error("the driver '" + name + "' was left out of this build; it needs libusb-1.0-0-dev");
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
  static const std::vector<std::string> kNames{"falcon", "spacemouse"};
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

DeviceText parse_device(std::string_view text) {
  const std::size_t colon = text.find(':');
  DeviceText device{.name = std::string(text.substr(0, colon)), .options = {}};
  if (colon == std::string_view::npos) return device;
  for (const std::string_view item : split(text.substr(colon + 1), ',')) {
    const std::size_t equals = item.find('=');
    if (equals == 0 || equals == std::string_view::npos) {
      throw usage_error("--device " + std::string(text) + ": OPTION=VALUE is expected, found '" +
                        std::string(item) + "'");
    }
    device.options.emplace_back(item.substr(0, equals), item.substr(equals + 1));
  }
  return device;
}

std::unique_ptr<DriverLink> open_link(const std::string& device) {
  const DeviceText parsed = parse_device(device);
  DriverModule& module = open_driver(parsed.name);
  std::string error;
  std::unique_ptr<DriverLink> link = module.make_link(parsed.options, error);
  if (!link) throw usage_error("--device " + device + ": " + error);
  return link;
}

}  // namespace palpate
