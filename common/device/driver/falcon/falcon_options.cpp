#include "common/device/driver/falcon/falcon_options.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <string_view>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// A number of the settings by its name.
struct NumberOption {
  std::string_view name;
  double& (*in)(FalconSettings&);
  std::string_view help;

  /// @throws Error (usage).
  void set(FalconSettings& settings, const std::string& value) const;
};

const std::array kNumbers{
    NumberOption{"gain", [](FalconSettings& s) -> double& { return s.gain; },
                 "counts of a motor per N m at the arm; default 3500"},
    NumberOption{"cap", [](FalconSettings& s) -> double& { return s.force_cap; },
                 "largest force [N]; default 8"},
    NumberOption{"thigh", [](FalconSettings& s) -> double& { return s.geometry.thigh; },
                 "geometry of the arm [m]"},
    NumberOption{"shin", [](FalconSettings& s) -> double& { return s.geometry.shin; }, "the same"},
    NumberOption{"shin_ends", [](FalconSettings& s) -> double& { return s.geometry.shin_ends; }, "the same"},
    NumberOption{"platform_u", [](FalconSettings& s) -> double& { return s.geometry.platform_u; },
                 "the same"},
    NumberOption{"platform_v", [](FalconSettings& s) -> double& { return s.geometry.platform_v; },
                 "the same"},
    NumberOption{"base_u", [](FalconSettings& s) -> double& { return s.geometry.base_u; }, "the same"},
    NumberOption{"base_v", [](FalconSettings& s) -> double& { return s.geometry.base_v; }, "the same"},
    NumberOption{"zero_angle", [](FalconSettings& s) -> double& { return s.zero_angle; },
                 "of the thighs at count 0 [rad]; default 0.6109"}};

constexpr std::string_view kFirmware = "firmware";

std::vector<std::uint8_t> read_image(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw input_error(
        {.file = file, .found = "cannot be read", .expected = "the image of the Falcon's firmware"});
  }
  std::vector<std::uint8_t> image(FalconSettings::kMostFirmware + 1);
  in.read(reinterpret_cast<char*>(image.data()), static_cast<std::streamsize>(image.size()));
  image.resize(as_size(in.gcount()));
  if (image.size() < FalconSettings::kLeastFirmware || image.size() > FalconSettings::kMostFirmware) {
    throw input_error({.file = file,
                       .found = image.size() > FalconSettings::kMostFirmware
                                    ? "more than 65536 bytes"
                                    : std::to_string(image.size()) + " bytes",
                       .expected = "an image of 1 to 64 kB"});
  }
  return image;
}

const NumberOption& number_option(const std::string& name) {
  const auto* const option = std::find_if(kNumbers.begin(), kNumbers.end(),
                                          [&](const NumberOption& each) { return each.name == name; });
  if (option != kNumbers.end()) return *option;
  std::string known(kFirmware);
  for (const NumberOption& each : kNumbers) (known += ", ") += each.name;
  throw usage_error("the driver falcon knows no option '" + name + "'; known are " + known);
}

void NumberOption::set(FalconSettings& settings, const std::string& value) const {
  const auto parsed = number(value);
  if (!parsed) throw usage_error("falcon: " + std::string(name) + " takes a number, found '" + value + "'");
  in(settings) = *parsed;
  if (!settings.valid()) {
    throw usage_error("falcon: " + std::string(name) + "=" + value + " is out of bounds");
  }
}

}  // namespace

FalconSettings falcon_settings(const DriverOptions& options) {
  FalconSettings settings;
  for (const auto& [name, value] : options) {
    if (name == kFirmware) {
      settings.firmware = read_image(value);
    } else {
      number_option(name).set(settings, value);
    }
  }
  return settings;
}

std::string falcon_help() {
  std::string text = "firmware=FILE  image of the firmware, loaded after power on\n";
  constexpr std::size_t kColumn = 15;
  for (const NumberOption& each : kNumbers) {
    std::string name = std::string(each.name) + "=N";
    name.resize(std::max(kColumn, name.size() + 1), ' ');
    (text += name).append(each.help) += '\n';
  }
  return text;
}

}  // namespace palpate
