#include "common/device/driver/polhemus/polhemus_port.h"

#include <algorithm>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/device/driver/transport/serial_line.h"
#include "common/device/driver/transport/usb_search.h"

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

/// Fastraks on USB; all others speak as the Liberty does.
constexpr std::uint16_t kLastFastrak = 0x0003;

class UsbPolhemus final : public PolhemusPort {
 public:
  explicit UsbPolhemus(UsbTransport& transport) : transport_(transport) {}

  PolhemusOpened open() override {
    UsbFound found = open_first(transport_, "polhemus", false);
    PolhemusOpened opened{.refused = found.refused};
    if (!found.connection) return opened;
    const auto endpoint = [&](bool in, bool interrupt) -> const UsbEndpoint* {
      const auto at = std::find_if(
          found.device.endpoints.begin(), found.device.endpoints.end(), [&](const UsbEndpoint& e) {
            return e.interface == found.endpoint.interface && e.in() == in && e.interrupt == interrupt;
          });
      return at != found.device.endpoints.end() ? &*at : nullptr;
    };
    const UsbEndpoint* const out = endpoint(false, false);
    if (out == nullptr) {
      opened.refused = TransferStatus::kFailed;
      return opened;
    }
    const std::shared_ptr<UsbConnection> connection = std::move(found.connection);
    if (found.device.id.product <= kLastFastrak) opened.family = PolhemusFamily::kFastrak;
    opened.commands = std::make_unique<UsbStream>(connection, *out, found.endpoint);
    // A Fastrak says what it was asked by one endpoint, and what it says by itself by another.
    const UsbEndpoint* const continuous = endpoint(true, true);
    if (opened.family == PolhemusFamily::kFastrak && continuous != nullptr)
      opened.data = std::make_unique<UsbStream>(connection, *out, *continuous);
    opened.place = "usb " + found.device.path;
    return opened;
  }

  [[nodiscard]] double now() const noexcept override { return transport_.now(); }
  void await(double seconds) noexcept override { transport_.await_arrival(seconds); }
  [[nodiscard]] bool serial() const noexcept override { return false; }

 private:
  UsbTransport& transport_;
};

class LinePolhemus final : public PolhemusPort {
 public:
  LinePolhemus(std::unique_ptr<StreamPlace> line, PolhemusFamily family)
      : line_(std::move(line)), family_(family) {}

  PolhemusOpened open() override {
    StreamOpened stream = line_->open();
    PolhemusOpened opened{.refused = stream.status, .family = family_};
    // A line that is not there is one that is not plugged in.
    if (opened.refused == TransferStatus::kGone) opened.refused = TransferStatus::kOk;
    opened.commands = std::move(stream.stream);
    if (opened.commands) opened.place = line_->name();
    return opened;
  }

  [[nodiscard]] double now() const noexcept override { return line_->now(); }
  void await(double seconds) noexcept override { line_->sleep(seconds); }
  [[nodiscard]] bool serial() const noexcept override { return true; }

 private:
  std::unique_ptr<StreamPlace> line_;
  PolhemusFamily family_;
};

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

std::unique_ptr<PolhemusPort> polhemus_on_usb(UsbTransport& transport) {
  return std::make_unique<UsbPolhemus>(transport);
}

std::unique_ptr<PolhemusPort> polhemus_on_line(std::unique_ptr<StreamPlace> line, PolhemusFamily family) {
  return std::make_unique<LinePolhemus>(std::move(line), family);
}

}  // namespace palpate
