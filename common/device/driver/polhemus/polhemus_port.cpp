#include "common/device/driver/polhemus/polhemus_port.h"

#include <algorithm>
#include <utility>

#include "common/device/driver/transport/usb_search.h"
#include "common/device/driver/transport/usb_stream.h"

namespace palpate {
namespace {

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

std::unique_ptr<PolhemusPort> polhemus_on_usb(UsbTransport& transport) {
  return std::make_unique<UsbPolhemus>(transport);
}

std::unique_ptr<PolhemusPort> polhemus_on_line(std::unique_ptr<StreamPlace> line, PolhemusFamily family) {
  return std::make_unique<LinePolhemus>(std::move(line), family);
}

}  // namespace palpate
