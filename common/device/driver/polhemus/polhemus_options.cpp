#include "common/device/driver/polhemus/polhemus_options.h"

#include <string_view>

#include "common/base/error.h"
#include "common/device/driver/transport/serial_line.h"

namespace palpate {
namespace {

Vec3 hemisphere_of(const std::string& value) {
  constexpr std::string_view kAxes = "xyz";
  const std::size_t axis = value.size() == 2 ? kAxes.find(value[1]) : std::string_view::npos;
  if (axis == std::string_view::npos || (value[0] != '+' && value[0] != '-')) {
    throw usage_error("polhemus: hemisphere takes +x, -x, +y, -y, +z or -z, found '" + value + "'");
  }
  Vec3 zenith{0.0};
  zenith[static_cast<int>(axis)] = value[0] == '+' ? 1.0 : -1.0;
  return zenith;
}

}  // namespace

PolhemusSettings polhemus_settings(const DriverOptions& options) {
  PolhemusSettings settings;
  bool of_line = false;
  for (const auto& [name, value] : options) {
    if (name == "port") {
      settings.port = value;
    } else if (name == "baud") {
      settings.baud = baud_of("polhemus", value);
      of_line = true;
    } else if (name == "model") {
      if (value != "fastrak" && value != "liberty" && value != "patriot") {
        throw usage_error("polhemus: model takes fastrak, liberty or patriot, found '" + value + "'");
      }
      settings.family = value == "fastrak" ? PolhemusFamily::kFastrak : PolhemusFamily::kLiberty;
      of_line = true;
    } else if (name == "hemisphere") {
      settings.hemisphere = hemisphere_of(value);
    } else {
      throw usage_error("the driver polhemus knows no option '" + name +
                        "'; known are port, baud, model, hemisphere");
    }
  }
  if (of_line && settings.port.empty()) {
    throw usage_error(
        "polhemus: baud and model are of a tracker at a serial line: name it, too, as in "
        "port=/dev/ttyUSB0");
  }
  return settings;
}

std::string polhemus_help() {
  return "port=FILE        a serial line; left out: USB\n"
         "baud=N           of that line; default 115200\n"
         "model=NAME       at that line: fastrak, the default, liberty or patriot\n"
         "hemisphere=AXIS  +x, the default, -x, +y, -y, +z or -z: where from the transmitter sensors are\n";
}

std::unique_ptr<PolhemusPort> polhemus_port(const PolhemusSettings& settings, UsbTransport& transport) {
  if (settings.port.empty()) return polhemus_on_usb(transport);
  return polhemus_on_line(std::make_unique<SerialLine>(settings.port, settings.baud), settings.family);
}

}  // namespace palpate
