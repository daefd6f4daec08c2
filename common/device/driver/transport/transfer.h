/// How a transfer of bytes ended, whatever carries it: a bus, a serial line, a socket.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace palpate {

enum class TransferStatus : std::uint8_t {
  kOk,
  kTimeout,  ///< nothing, or not all, within the time that was given
  kStall,    ///< the device refused
  kGone,     ///< it is no longer plugged in, or the other side has closed
  kDenied,   ///< this user may not open it
  kBusy,     ///< another program has it
  kFailed    ///< anything else
};
[[nodiscard]] std::string_view name_of(TransferStatus status) noexcept;  ///< "timeout"

struct TransferResult {
  TransferStatus status = TransferStatus::kOk;
  std::size_t bytes = 0;  ///< moved, whatever the status

  [[nodiscard]] bool ok() const noexcept { return status == TransferStatus::kOk; }
};

/// Whether a device is to be given up after a transfer: it is gone, or `most` have failed in a row. That
/// nothing came within its time is no failure.
/// @param misses that failed in a row, counted on; the caller begins anew after one that was ok.
[[nodiscard]] bool given_up(TransferStatus status, int most, int& misses) noexcept;

}  // namespace palpate
