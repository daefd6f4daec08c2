#include "common/device/driver/transfer.h"

#include <array>

namespace palpate {

std::string_view name_of(TransferStatus status) noexcept {
  constexpr std::array<std::string_view, 7> kNames{"ok",     "timeout", "stall", "gone",
                                                   "denied", "busy",    "failed"};
  return kNames[static_cast<std::size_t>(status)];
}

}  // namespace palpate
