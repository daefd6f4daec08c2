#include "common/kinematics/workbench_devices.h"

#include <algorithm>
#include <cmath>

#include "common/base/text.h"
#include "common/kinematics/workbench_section.h"

namespace palpate {
namespace {

/// Tables within `name`, one a device.
std::vector<std::pair<std::string, const toml::table*>> tables_of(const toml::table& root, const char* name,
                                                                  const std::filesystem::path& path) {
  std::vector<std::pair<std::string, const toml::table*>> out;
  const toml::node* node = root.get(name);
  if (!node) return out;
  const std::string expected = "[" + std::string(name) + ".NAME] with the name that --device has";
  const toml::table* all = node->as_table();
  if (!all) refuse(path, line_of(*node), "'" + std::string(name) + "' is no section", expected);
  for (const auto& [key, inner] : *all) {
    if (!inner.is_table())
      refuse(path, line_of(inner), "'" + std::string(key.str()) + "' of no device in [" + name + "]",
             expected);
    out.emplace_back(key.str(), inner.as_table());
  }
  return out;
}

}  // namespace

const TunedDevice* find_tuned(const std::vector<TunedDevice>& all, std::string_view device) {
  for (const std::string_view name : {device, device.substr(0, device.find(':'))}) {
    const auto found =
        std::find_if(all.begin(), all.end(), [name](const TunedDevice& each) { return each.device == name; });
    if (found != all.end()) return &*found;
  }
  return nullptr;
}

std::vector<std::pair<std::string, std::string>> with_device_options(
    const std::vector<DeviceOptions>& all, std::string_view device,
    const std::vector<std::pair<std::string, std::string>>& given) {
  std::vector<std::pair<std::string, std::string>> out = given;
  for (const std::string_view name : {device, device.substr(0, device.find(':'))}) {
    for (const DeviceOptions& each : all) {
      if (each.device != name) continue;
      for (const auto& option : each.options) {
        const bool named = std::any_of(out.begin(), out.end(),
                                       [&](const auto& other) { return other.first == option.first; });
        if (!named) out.insert(out.end() - static_cast<std::ptrdiff_t>(given.size()), option);
      }
    }
  }
  return out;
}

std::string section_text(const TunedDevice& tuned) {
  const bool bare = std::all_of(tuned.device.begin(), tuned.device.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
  std::string out = bare ? "[tuned." + tuned.device + "]\n" : "[tuned.\"" + tuned.device + "\"]\n";
  out += "stiffness = " + exact_number(tuned.stiffness) + "\nrate = " + exact_number(tuned.rate) +
         "\nplaces = [\n";
  for (const TunedPlace& each : tuned.places) {
    out += "  [";
    for (int a = 0; a < 3; ++a) out += exact_number(each.place[a]) + ", ";
    out += exact_number(each.stiffness) + "],\n";
  }
  return out + "]\n";
}

std::vector<DeviceOptions> device_options_of(const toml::table& root, const std::filesystem::path& path) {
  std::vector<DeviceOptions> out;
  for (const auto& [name, table] : tables_of(root, "device", path)) {
    DeviceOptions device{name, {}};
    for (const auto& [key, node] : *table) {
      std::string text = node.value_exact<std::string>().value_or("");
      const auto number = node.value<double>();
      if (text.empty() && number && std::isfinite(*number)) text = exact_number(*number);
      if (text.empty())
        refuse(path, line_of(node), "'" + std::string(key.str()) + "' of [device." + name + "]",
               "a number or a text, as an option of the driver");
      device.options.emplace_back(key.str(), std::move(text));
    }
    out.push_back(std::move(device));
  }
  return out;
}

std::vector<TunedDevice> tuned_of(const toml::table& root, const std::filesystem::path& path) {
  std::vector<TunedDevice> out;
  for (const auto& [name, table] : tables_of(root, "tuned", path)) {
    const WorkbenchSection s(*table, "tuned." + name, path, {"stiffness", "rate", "places"});
    TunedDevice tuned{.device = name, .stiffness = s.number("stiffness"), .rate = 0.0, .places = {}};
    tuned.rate = s.has("rate") ? s.number("rate") : TunedDevice{}.rate;
    if (!(tuned.stiffness > 0.0))
      s.refuse_at("stiffness", short_number(tuned.stiffness), "a stiffness above zero, in N/m");
    if (!(tuned.rate > 0.0)) s.refuse_at("rate", short_number(tuned.rate), "a rate above zero, in Hz");
    if (s.has("places")) {
      for (const toml::node& node : s.array("places")) {
        const auto row = s.numbers(node, 4);
        tuned.places.push_back({{row[0], row[1], row[2]}, row[3]});
      }
    }
    out.push_back(std::move(tuned));
  }
  return out;
}

}  // namespace palpate
