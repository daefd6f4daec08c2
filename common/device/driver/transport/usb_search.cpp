#include "common/device/driver/transport/usb_search.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace palpate {
namespace {

constexpr std::string_view kFalconDriver = "falcon", kMouseDriver = "spacemouse", kPedalDriver = "pedal",
                           kTrackerDriver = "polhemus", kGloveDriver = "dataglove";
constexpr std::string_view kUnloaded = "waits for its firmware, which its maker's software loads (fxload)";

constexpr std::array kKnown{
    KnownDevice{{0x0403, 0xcb48}, "Novint Falcon", kFalconDriver, ""},
    KnownDevice{{0x05f3, 0x042c}, "X-keys XK-3 foot switch", kPedalDriver, ""},
    KnownDevice{{0x05f3, 0x00ff}, "VEC Infinity foot switch", kPedalDriver, ""},
    KnownDevice{{0x0c45, 0x7403}, "PCsensor foot switch", kPedalDriver, ""},
    KnownDevice{{0x0c45, 0x7404}, "PCsensor foot switch", kPedalDriver, ""},
    KnownDevice{{0x413d, 0x2107}, "PCsensor foot switch", kPedalDriver, ""},
    KnownDevice{{0x1a86, 0xe026}, "PCsensor foot switch", kPedalDriver, ""},
    KnownDevice{{0x3553, 0xb001}, "PCsensor foot switch", kPedalDriver, ""},
    KnownDevice{{0x0426, 0x3011}, "Scythe foot switch", kPedalDriver, ""},
    KnownDevice{{0x055a, 0x0998}, "Scythe foot switch", kPedalDriver, ""},
    KnownDevice{{0x5131, 0x2019}, "FS1-P foot switch", kPedalDriver, ""},
    KnownDevice{{0x046d, 0xc603}, "SpaceMouse Plus XT", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc605}, "CadMan", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc606}, "SpaceMouse Classic", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc621}, "SpaceBall 5000", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc623}, "SpaceTraveler", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc625}, "SpacePilot", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc626}, "SpaceNavigator", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc627}, "SpaceExplorer", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc628}, "SpaceNavigator for Notebooks", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc629}, "SpacePilot Pro", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc62b}, "SpaceMouse Pro", kMouseDriver, ""},
    KnownDevice{{0x046d, 0xc640}, "NuLooq", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc62e}, "SpaceMouse Wireless (cable)", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc62f}, "SpaceMouse Wireless receiver", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc631}, "SpaceMouse Pro Wireless (cable)", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc632}, "SpaceMouse Pro Wireless receiver", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc633}, "SpaceMouse Enterprise", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc635}, "SpaceMouse Compact", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc636}, "SpaceMouse Module", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc638}, "SpaceMouse Pro Wireless Bluetooth (cable)", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc63a}, "SpaceMouse Wireless Bluetooth", kMouseDriver, ""},
    KnownDevice{{0x256f, 0xc652}, "3Dconnexion Universal Receiver", kMouseDriver, ""},
    KnownDevice{{0x0f44, 0x0001}, "Polhemus Fastrak", "", kUnloaded},
    KnownDevice{{0x0f44, 0x0002}, "Polhemus Fastrak", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0x0003}, "Polhemus Fastrak 3", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0xef11}, "Polhemus Patriot", "", kUnloaded},
    KnownDevice{{0x0f44, 0xef12}, "Polhemus Patriot", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0xef20}, "Polhemus Patriot HS", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0xef21}, "Polhemus Patriot HS", "", kUnloaded},
    KnownDevice{{0x0f44, 0xff11}, "Polhemus Liberty", "", kUnloaded},
    KnownDevice{{0x0f44, 0xff12}, "Polhemus Liberty", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0xff20}, "Polhemus Liberty 2", kTrackerDriver, ""},
    KnownDevice{{0x0f44, 0xff21}, "Polhemus Liberty 2", "", kUnloaded},
    KnownDevice{{0x5d70, 0x0000}, "5DT Data Glove 14, right", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0001}, "5DT Data Glove 14, left", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0010}, "5DT Data Glove 5, right", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0011}, "5DT Data Glove 5, left", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0002}, "5DT Data Glove 14, right, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0003}, "5DT Data Glove 14, left, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0012}, "5DT Data Glove 5, right, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0013}, "5DT Data Glove 5, left, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0006}, "5DT Data Glove 14, right, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0007}, "5DT Data Glove 14, left, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0016}, "5DT Data Glove 5, right, wireless", kGloveDriver, ""},
    KnownDevice{{0x5d70, 0x0017}, "5DT Data Glove 5, left, wireless", kGloveDriver, ""},
    KnownDevice{{0x0f44, 0xcf01}, "Polhemus G4", "", "speaks through its maker's library only"},
};

}  // namespace

const KnownDevice* find_known(UsbId id) noexcept {
  const auto* const found =
      std::find_if(kKnown.begin(), kKnown.end(), [id](const KnownDevice& each) { return each.id == id; });
  return found != kKnown.end() ? found : nullptr;
}

std::vector<FoundDevice> find_devices(UsbTransport& transport) {
  std::vector<FoundDevice> found;
  for (const UsbDevice& device : transport.devices()) {
    const KnownDevice* const known = find_known(device.id);
    if (known == nullptr) continue;
    found.push_back({.name = std::string(known->name),
                     .id = text_of(device.id),
                     .place = "usb " + device.path,
                     .access = std::string(name_of(transport.access(device.path))),
                     .driver = std::string(known->driver),
                     .note = std::string(known->note)});
  }
  return found;
}

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
