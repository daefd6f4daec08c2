#include "common/device/driver/transport/serial_line.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <thread>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::array<std::pair<int, speed_t>, 8> kSpeeds{{{1200, B1200},
                                                          {2400, B2400},
                                                          {4800, B4800},
                                                          {9600, B9600},
                                                          {19200, B19200},
                                                          {38400, B38400},
                                                          {57600, B57600},
                                                          {115200, B115200}}};

TransferStatus status_of_errno(int error) noexcept {
  switch (error) {
    case ENOENT:
    case ENODEV:
    case ENXIO:
    case EIO:  // a line that was pulled out, or whose other side has closed
    case ENOTDIR:
      return TransferStatus::kGone;
    case EACCES:
    case EPERM:
      return TransferStatus::kDenied;
    case EBUSY:
      return TransferStatus::kBusy;
    default:
      return TransferStatus::kFailed;
  }
}

class SerialStream final : public ByteStream {
 public:
  explicit SerialStream(int file) : file_(file) {}
  ~SerialStream() override { ::close(file_); }

  TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept override {
    for (const double until = steady_seconds() + seconds;;) {
      const TransferStatus ready = wait_for(file_, POLLIN, until);
      if (ready != TransferStatus::kOk) return {ready, 0};
      const ssize_t got = ::read(file_, data.data(), data.size());
      if (got > 0) return {TransferStatus::kOk, as_size(got)};
      if (got == 0) return {TransferStatus::kGone, 0};
      if (errno != EAGAIN && errno != EINTR) return {status_of_errno(errno), 0};
    }
  }

  TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept override {
    std::size_t sent = 0;
    for (const double until = steady_seconds() + seconds; sent < data.size();) {
      const TransferStatus ready = wait_for(file_, POLLOUT, until);
      if (ready != TransferStatus::kOk) return {ready, sent};
      const ssize_t taken = ::write(file_, data.data() + sent, data.size() - sent);
      if (taken >= 0) {
        sent += as_size(taken);
      } else if (errno != EAGAIN && errno != EINTR) {
        return {status_of_errno(errno), sent};
      }
    }
    return {TransferStatus::kOk, sent};
  }

 private:
  int file_;
};

}  // namespace

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

const std::vector<int>& serial_rates() {
  static const std::vector<int> kRates = [] {
    std::vector<int> rates;
    for (const auto& [baud, speed] : kSpeeds) rates.push_back(baud);
    return rates;
  }();
  return kRates;
}

SerialLine::SerialLine(std::string path, int baud) : path_(std::move(path)) {
  const auto* const found =
      std::find_if(kSpeeds.begin(), kSpeeds.end(), [baud](const auto& each) { return each.first == baud; });
  PALPATE_CHECK(found != kSpeeds.end());
  speed_ = found->second;
}

StreamOpened SerialLine::open() {
  const int file = ::open(path_.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return {status_of_errno(errno), nullptr};
  auto stream = std::make_unique<SerialStream>(file);
  // Keeps other programs out, but for root's.
  if (::ioctl(file, TIOCEXCL) != 0) return {TransferStatus::kFailed, nullptr};  // no serial line at all
  termios line{};
  if (::tcgetattr(file, &line) != 0) return {TransferStatus::kFailed, nullptr};
  ::cfmakeraw(&line);
  line.c_cflag &= ~static_cast<tcflag_t>(CSTOPB | PARENB | CRTSCTS | CSIZE);
  line.c_cflag |= static_cast<tcflag_t>(CS8 | CREAD | CLOCAL);
  line.c_cc[VMIN] = 1;  // nothing there is then told apart from a line that has ended
  line.c_cc[VTIME] = 0;
  ::cfsetispeed(&line, speed_);
  ::cfsetospeed(&line, speed_);
  if (::tcsetattr(file, TCSANOW, &line) != 0) return {TransferStatus::kFailed, nullptr};
  ::tcflush(file, TCIOFLUSH);
  return {TransferStatus::kOk, std::move(stream)};
}

double SerialLine::now() const noexcept { return steady_seconds(); }

void SerialLine::sleep(double seconds) noexcept {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

int baud_of(std::string_view driver, const std::string& value) {
  std::string known;
  for (const int rate : serial_rates()) {
    if (value == std::to_string(rate)) return rate;
    (known += known.empty() ? "" : ", ") += std::to_string(rate);
  }
  throw usage_error(std::string(driver) + ": baud takes one of " + known + ", found '" + value + "'");
}

}  // namespace palpate
