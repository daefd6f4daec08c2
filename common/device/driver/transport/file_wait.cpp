#include "common/device/driver/transport/file_wait.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>

#include <poll.h>

namespace palpate {

double steady_seconds() noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TransferStatus wait_for(int file, short events, double until) noexcept {
  for (;;) {
    pollfd line{.fd = file, .events = events, .revents = 0};
    const double left = std::max(until - steady_seconds(), 0.0);
    const int ready = ::poll(&line, 1, static_cast<int>(std::ceil(1e3 * left)));
    if (ready > 0) return (line.revents & events) != 0 ? TransferStatus::kOk : TransferStatus::kGone;
    if (ready == 0) return TransferStatus::kTimeout;
    if (errno != EINTR) return TransferStatus::kFailed;
  }
}

}  // namespace palpate
