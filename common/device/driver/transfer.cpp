#include "common/device/driver/transfer.h"

#include <array>

namespace palpate {

std::string_view name_of(TransferStatus status) noexcept {
  constexpr std::array<std::string_view, 7> kNames{"ok",     "timeout", "stall", "gone",
                                                   "denied", "busy",    "failed"};
  return kNames[static_cast<std::size_t>(status)];
}

bool given_up(TransferStatus status, int most, int& misses) noexcept {
  if (status == TransferStatus::kGone) return true;
  if (status == TransferStatus::kOk || status == TransferStatus::kTimeout) return false;
  return ++misses >= most;
}

}  // namespace palpate
