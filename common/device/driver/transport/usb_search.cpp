#include "common/device/driver/transport/usb_search.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "common/device/driver/transport/known_devices.h"

namespace palpate {

UsbFound open_first(UsbTransport& transport, std::string_view driver, bool interrupt) {
  UsbFound found;
  for (UsbDevice& device : transport.devices()) {
    const KnownDevice* const known = find_known(device.id);
    if (known == nullptr || known->driver != driver) continue;
    const auto endpoint =
        std::find_if(device.endpoints.begin(), device.endpoints.end(),
                     [interrupt](const UsbEndpoint& e) { return e.interrupt == interrupt && e.in(); });
    if (endpoint == device.endpoints.end()) continue;
    UsbOpened opened = transport.open(device.path, endpoint->interface);
    if (opened.status != TransferStatus::kOk) {
      found.refused = opened.status;
      continue;
    }
    found.connection = std::move(opened.connection);
    found.endpoint = *endpoint;
    found.device = std::move(device);
    break;
  }
  return found;
}

UsbFound look_for(UsbTransport& transport, std::string_view driver, bool interrupt,
                  LinkStatus& status) noexcept {
  UsbFound found = open_first(transport, driver, interrupt);
  if (found.connection) {
    ++status.opened;
    status.phase = LinkPhase::kLoading;
  } else {
    status.phase = found.refused == TransferStatus::kOk ? LinkPhase::kAbsent : LinkPhase::kRefused;
    transport.await_arrival(kLookPause);
  }
  return found;
}

std::string refusal_advice(std::string_view device, TransferStatus refused) {
  if (refused == TransferStatus::kBusy) return "another program has " + std::string(device) + "; end it";
  return std::string(device) + " cannot be opened (" + std::string(name_of(refused)) +
         "); the verb `doctor` prints the rule that gives access to it";
}

}  // namespace palpate
