#include "lab/workbench/described_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <sstream>

#include <toml++/toml.h>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

struct Quantity {
  const char* key;
  double DeviceProfile::*value;
  bool positive;  ///< else zero will do
  bool needed;
};
constexpr std::array kQuantities{Quantity{"mass", &DeviceProfile::mass, true, true},
                                 Quantity{"damping", &DeviceProfile::damping, false, true},
                                 Quantity{"friction", &DeviceProfile::friction, false, false},
                                 Quantity{"encoder_step", &DeviceProfile::encoder_step, false, false},
                                 Quantity{"sensor_delay", &DeviceProfile::sensor_delay, false, false},
                                 Quantity{"actuator_delay", &DeviceProfile::actuator_delay, false, false},
                                 Quantity{"peak_force", &DeviceProfile::peak_force, true, false},
                                 Quantity{"max_stiffness", &DeviceProfile::max_stiffness, true, false}};

std::string known_keys() {
  std::string keys = "title";
  for (const Quantity& each : kQuantities) keys += std::string(", ") + each.key;
  return keys;
}

toml::table table_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  if (in.is_open()) text << in.rdbuf();
  if (!in.is_open() || in.bad())
    throw input_error({file, "", "cannot be read", "a device in TOML: mass, damping, …", ""});
  try {
    return toml::parse(text.str(), file);
  } catch (const toml::parse_error& error) {
    throw input_error({file, "line " + std::to_string(error.source().begin.line),
                       std::string(error.description()), "TOML", ""});
  }
}

std::unique_ptr<const DescribedDevice> read_device(const std::string& file) {
  const toml::table table = table_of(file);
  auto device = std::make_unique<DescribedDevice>();
  device->name = std::filesystem::path(file).filename().string();
  device->title = table["title"].value<std::string>().value_or(device->name);
  const auto line = [](const toml::node& node) { return "line " + std::to_string(node.source().begin.line); };
  for (const auto& [key, node] : table) {
    const std::string word(key.str());
    if (word == "title") continue;
    const auto known = std::find_if(kQuantities.begin(), kQuantities.end(),
                                    [&](const Quantity& each) { return each.key == word; });
    if (known == kQuantities.end())
      throw input_error({file, line(node), "unknown key '" + word + "'", known_keys(), ""});
    const auto value = node.value<double>();
    if (!value || !std::isfinite(*value) || *value < 0.0 || (known->positive && *value == 0.0))
      throw input_error({file, line(node), "'" + word + "' is no such number",
                         known->positive ? "a number above zero" : "a number, zero at least", ""});
    device->profile.*(known->value) = *value;
  }
  for (const Quantity& each : kQuantities) {
    if (each.needed && !table.contains(each.key))
      throw input_error({file, "", std::string("no '") + each.key + "'", known_keys(), ""});
  }
  device->profile.name = device->name;
  device->profile.title = device->title;
  return device;
}

}  // namespace

std::unique_ptr<const DescribedDevice> described_device(const std::string& model) {
  if (model.ends_with(".toml")) return read_device(model);
  auto device = std::make_unique<DescribedDevice>();
  device->profile = find_profile(model);
  return device;
}

}  // namespace palpate
