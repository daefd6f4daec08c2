#include "tests/common/device/driver/transport/pty_pair.h"

#include <array>
#include <chrono>
#include <cstdlib>
#include <stdexcept>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

namespace palpate::test {
namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

PtyPair::PtyPair(std::shared_ptr<Speaker> speaker) : speaker_(std::move(speaker)) {
  master_ = ::posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  std::array<char, 128> name{};
  const bool made = master_ >= 0 && ::grantpt(master_) == 0 && ::unlockpt(master_) == 0 &&
                    ::ptsname_r(master_, name.data(), name.size()) == 0;
  if (!made) throw std::runtime_error("no pseudo terminals");
  path_ = name.data();
  speaker_->opened(steady_seconds());
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

PtyPair::~PtyPair() {
  if (thread_.joinable()) {
    thread_.request_stop();
    thread_.join();
  }
  if (master_ >= 0) ::close(master_);
}

void PtyPair::work(const std::stop_token& stop) {
  std::array<std::uint8_t, 256> heard{};
  std::vector<std::uint8_t> said;
  while (!stop.stop_requested()) {
    constexpr int kWait = 1;  // [ms]
    pollfd line{.fd = master_, .events = POLLIN, .revents = 0};
    (void)::poll(&line, 1, kWait);
    const ssize_t got = ::read(master_, heard.data(), heard.size());
    // Nobody has the other side open.
    if ((line.revents & POLLHUP) != 0) std::this_thread::sleep_for(std::chrono::milliseconds(kWait));
    const std::lock_guard lock(mutex_);
    if (got > 0) speaker_->hear(steady_seconds(), std::span(heard).first(static_cast<std::size_t>(got)));
    said.clear();
    speaker_->speak(steady_seconds(), said);
    if (said.empty()) continue;
    // What the line has no room for is lost.
    [[maybe_unused]] const ssize_t sent = ::write(master_, said.data(), said.size());
  }
}

}  // namespace palpate::test
