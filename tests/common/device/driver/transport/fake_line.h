/// A serial line or socket without wires: what speaks at its other end is a model in this process, time is
/// what the test says, and anything that a line does to bytes can be made to happen.
#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "common/device/driver/transport/byte_stream.h"

namespace palpate::test {

/// What speaks and listens in bytes. Times are in seconds and never fall.
class Speaker {
 public:
  virtual ~Speaker() = default;

  virtual void opened(double /*now*/) {}
  virtual void hear(double now, std::span<const std::uint8_t> bytes) = 0;
  /// Appends what it has said since the last call, by `now`.
  virtual void speak(double now, std::vector<std::uint8_t>& bytes) = 0;
};

/// What goes wrong: the first three with a probability per byte, the others per call.
struct LineFaults {
  double lost_byte = 0.0;
  double corrupt_byte = 0.0;  ///< one bit of it is flipped
  double foreign_byte = 0.0;  ///< one that nobody sent comes before it
  double split_read = 0.0;    ///< some of what is there comes only with the next read
  double late_read = 0.0;     ///< nothing is seen for `lateness`
  double lost_write = 0.0;    ///< it never arrives, and looks as if it did
  double short_write = 0.0;   ///< half of it is taken, and no more in time
  double lateness = 0.030;    ///< [s]
  std::uint64_t seed = 1;
};

class FakeLine final : public StreamPlace {
 public:
  void plug(std::shared_ptr<Speaker> speaker) { speaker_ = std::move(speaker); }
  /// Every call ends with kGone from now on.
  void unplug() { speaker_.reset(); }
  void refuse(TransferStatus status) { refused_ = status; }  ///< to open it; kOk: no longer
  void set_faults(const LineFaults& faults) {
    faults_ = faults;
    random_.seed(faults.seed);
  }
  /// Unplugs with the `count`-th call from now on.
  void unplug_at_call(std::uint64_t count) { unplug_after_ = count; }
  [[nodiscard]] bool plugged() const { return speaker_ != nullptr; }
  [[nodiscard]] int open_streams() const { return open_; }

  StreamOpened open() override;
  [[nodiscard]] std::string name() const override { return "/dev/ttyFAKE"; }
  [[nodiscard]] double now() const noexcept override { return now_; }
  void sleep(double seconds) noexcept override { now_ += seconds; }

 private:
  class Stream;

  [[nodiscard]] bool happens(double probability);
  /// Takes what the speaker has said, as the line lets it through.
  void carry(Speaker& speaker);
  Speaker* call(const std::shared_ptr<Speaker>& opened);

  double now_ = 0.0;
  std::shared_ptr<Speaker> speaker_;
  std::deque<std::uint8_t> waiting_;  ///< for the reader
  TransferStatus refused_ = TransferStatus::kOk;
  LineFaults faults_;
  std::mt19937_64 random_{1};
  std::uint64_t unplug_after_ = 0;
  int open_ = 0;
};

}  // namespace palpate::test
