/// Waiting for a file of the system that is a stream of bytes: a serial line, a socket.
#pragma once

#include "common/device/driver/transport/transfer.h"

namespace palpate {

/// [s] of CLOCK_MONOTONIC.
[[nodiscard]] double steady_seconds() noexcept;

/// Waits until `file` can be read (POLLIN) or written to (POLLOUT), as `events` of poll() says, at least one
/// look and no later than `until` [s of steady_seconds()].
/// @return kGone: the other side has closed, or nobody was there; what came before that is still read.
[[nodiscard]] TransferStatus wait_for(int file, short events, double until) noexcept;

}  // namespace palpate
