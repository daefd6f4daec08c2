#include "common/device/driver/usb.h"

#include <array>

namespace palpate {

std::string text_of(UsbId id) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned number : {unsigned{id.vendor}, unsigned{id.product}}) {
    if (!text.empty()) text += ':';
    for (int shift = 12; shift >= 0; shift -= 4)
      text += kDigits[(number >> static_cast<unsigned>(shift)) & 15U];
  }
  return text;
}

std::string_view name_of(UsbStatus status) noexcept {
  constexpr std::array<std::string_view, 7> kNames{"ok",     "timeout", "stall", "gone",
                                                   "denied", "busy",    "failed"};
  return kNames[static_cast<std::size_t>(status)];
}

}  // namespace palpate
