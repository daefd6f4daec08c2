// palpate-guardian TIMES HEX usb NODE INTERFACE ENDPOINT, or … file PATH: see guardian.h. It allocates nothing
// once it watches, and does nothing but that.

#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <span>
#include <string_view>

#include <fcntl.h>
#include <linux/usbdevice_fs.h>
#include <sys/ioctl.h>
#include <unistd.h>

namespace {

struct Line {
  int file = -1;
  bool usb = false;
  unsigned interface = 0, endpoint = 0;
};

void pause_for(long milliseconds) {
  const timespec time{.tv_sec = 0, .tv_nsec = 1'000'000 * milliseconds};
  nanosleep(&time, nullptr);
}

/// Once the process that had the interface is gone it is free.
bool claim(const Line& line) {
  constexpr int kTries = 100;
  for (int n = 0; n < kTries; ++n) {
    unsigned interface = line.interface;
    if (::ioctl(line.file, USBDEVFS_CLAIMINTERFACE, &interface) == 0) return true;
    pause_for(2);
  }
  return false;
}

void say(const Line& line, std::span<std::uint8_t> word) {
  if (!line.usb) {
    (void)!::write(line.file, word.data(), word.size());
    return;
  }
  constexpr unsigned kTime = 50;  // [ms]
  usbdevfs_bulktransfer transfer{
      .ep = line.endpoint, .len = static_cast<unsigned>(word.size()), .timeout = kTime, .data = word.data()};
  (void)::ioctl(line.file, USBDEVFS_BULK, &transfer);
}

unsigned digit(char letter) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  return static_cast<unsigned>(std::min(kDigits.find(letter), std::size_t{15}));
}

}  // namespace

int main(int count, char** words) {
  constexpr int kFile = 5, kUsb = 7, kWrong = 2;
  const bool usb = count == kUsb && std::strcmp(words[3], "usb") == 0;
  if (!usb && !(count == kFile && std::strcmp(words[3], "file") == 0)) return kWrong;
  std::array<std::uint8_t, 64> memory{};
  const std::string_view hex = words[2];
  const std::size_t bytes = std::min(hex.size() / 2, memory.size());
  for (std::size_t i = 0; i < bytes; ++i) {
    memory[i] = static_cast<std::uint8_t>(16 * digit(hex[2 * i]) + digit(hex[2 * i + 1]));
  }
  sigset_t all;
  sigfillset(&all);
  sigprocmask(SIG_BLOCK, &all, nullptr);

  Line line{.file = ::open(words[4], (usb ? O_RDWR : O_WRONLY) | O_NOCTTY), .usb = usb};
  if (line.file < 0) return kWrong;
  if (usb) {
    line.interface = static_cast<unsigned>(std::atoi(words[5]));
    line.endpoint = static_cast<unsigned>(std::atoi(words[6]));
  }
  char letter = 'r';
  (void)!::write(STDIN_FILENO, &letter, 1);
  if (::read(STDIN_FILENO, &letter, 1) > 0) return 0;  // it was let go of
  if (usb && !claim(line)) return 1;
  for (int n = std::atoi(words[1]); n > 0; --n) say(line, std::span(memory).first(bytes));
  return 0;
}
