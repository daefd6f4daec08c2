/// A stream of bytes as drivers see it: a serial line, a socket or the bulk endpoints of a USB device in use,
/// one in memory with a virtual clock in a test.
///
/// Calls block until they are done or their time is over. One thread at a time uses a stream.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "common/device/driver/transport/usb.h"

namespace palpate {

/// Closed when this is deleted. Times are in seconds, above zero.
class ByteStream {
 public:
  ByteStream() = default;
  ByteStream(const ByteStream&) = delete;
  ByteStream& operator=(const ByteStream&) = delete;
  virtual ~ByteStream() = default;

  /// What has come, at least one byte and at most what `data` holds; kTimeout where nothing came.
  virtual TransferResult read(std::span<std::uint8_t> data, double seconds) noexcept = 0;
  /// All of `data`, else kTimeout and how many bytes were taken.
  virtual TransferResult write(std::span<const std::uint8_t> data, double seconds) noexcept = 0;
};

struct StreamOpened {
  TransferStatus status = TransferStatus::kFailed;
  std::unique_ptr<ByteStream> stream;  ///< where the status is kOk
};

/// Where a stream can be opened, again after it was lost, and the clock that its reader keeps.
class StreamPlace {
 public:
  StreamPlace() = default;
  StreamPlace(const StreamPlace&) = delete;
  StreamPlace& operator=(const StreamPlace&) = delete;
  virtual ~StreamPlace() = default;

  /// kGone: there is no such line, or nobody listens there.
  [[nodiscard]] virtual StreamOpened open() = 0;
  [[nodiscard]] virtual std::string name() const = 0;  ///< "/dev/ttyUSB0", "localhost:3883"
  /// [s] of a clock that only goes forward: CLOCK_MONOTONIC but in tests.
  [[nodiscard]] virtual double now() const noexcept = 0;
  virtual void sleep(double seconds) noexcept = 0;
};

}  // namespace palpate
