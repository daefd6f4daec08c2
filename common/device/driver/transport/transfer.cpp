#include "common/device/driver/transport/transfer.h"

#include <array>

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

}  // namespace palpate
