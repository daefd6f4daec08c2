#include "common/device/driver/link_clock.h"

#include <chrono>
#include <thread>

namespace palpate {

double SystemLinkClock::now() const noexcept {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void SystemLinkClock::sleep(double seconds) noexcept {
  if (seconds > 0.0) std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

}  // namespace palpate
