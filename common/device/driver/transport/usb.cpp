#include "common/device/driver/transport/usb.h"

#include <array>
#include <string_view>

#include "common/base/index.h"

namespace palpate {

std::string_view name_of(TransferStatus status) noexcept {
  constexpr std::array<std::string_view, 7> kNames{"ok",     "timeout", "stall", "gone",
                                                   "denied", "busy",    "failed"};
  return kNames[as_size(status)];
}

bool given_up(TransferStatus status, int most, int& misses) noexcept {
  if (status == TransferStatus::kGone) return true;
  if (status == TransferStatus::kOk || status == TransferStatus::kTimeout) return false;
  return ++misses >= most;
}

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
