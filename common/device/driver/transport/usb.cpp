#include "common/device/driver/transport/usb.h"

#include <string_view>

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

}  // namespace palpate
