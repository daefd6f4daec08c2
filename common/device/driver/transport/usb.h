/// USB as drivers see it: what they may ask of a bus, of libusb in a driver module or of a fake in a test.
///
/// Calls block until they are done or their time is over, on whatever clock the transport keeps: that of the
/// system, or one that tests move. One thread at a time uses a connection; a transport may be used by
/// several.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

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

struct UsbId {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;

  auto operator<=>(const UsbId&) const = default;
};

/// "0403:cb48"
[[nodiscard]] std::string text_of(UsbId id);

/// An endpoint of the first setting of an interface.
struct UsbEndpoint {
  std::uint8_t interface = 0;
  std::uint8_t address = 0;  ///< bit 7: towards the host
  std::uint16_t packet = 0;  ///< [bytes] most in one packet
  bool interrupt = false;    ///< else bulk

  [[nodiscard]] bool in() const noexcept { return (address & 0x80U) != 0; }
};

/// A device on the bus, open or not.
struct UsbDevice {
  UsbId id;
  std::string path;  ///< where it is plugged in, "1-2.3": stays while it stays in its socket
  std::vector<UsbEndpoint> endpoints;
};

/// The set-up packet of a control transfer.
struct UsbControl {
  std::uint8_t request_type = 0;
  std::uint8_t request = 0;
  std::uint16_t value = 0;
  std::uint16_t index = 0;
};

/// An interface that was claimed; given back when this is deleted. Times are in seconds, above zero.
class UsbConnection {
 public:
  UsbConnection() = default;
  UsbConnection(const UsbConnection&) = delete;
  UsbConnection& operator=(const UsbConnection&) = delete;
  virtual ~UsbConnection() = default;

  /// With data to the device, or none.
  virtual TransferResult control(const UsbControl& setup, std::span<const std::uint8_t> data,
                                 double seconds) noexcept = 0;
  /// With data from the device; `setup` has bit 7 of its type set.
  virtual TransferResult ask(const UsbControl& setup, std::span<std::uint8_t> data,
                             double seconds) noexcept = 0;
  /// One bulk or interrupt transfer.
  virtual TransferResult write(const UsbEndpoint& endpoint, std::span<const std::uint8_t> data,
                               double seconds) noexcept = 0;
  virtual TransferResult read(const UsbEndpoint& endpoint, std::span<std::uint8_t> data,
                              double seconds) noexcept = 0;
  /// From now on and until this is deleted, however the program ends: `word` is written to `endpoint` after it
  /// (guardian.h). False where nobody could be found to do so.
  virtual bool leave_last_word(const UsbEndpoint& endpoint, std::span<const std::uint8_t> word) = 0;
};

struct UsbOpened {
  TransferStatus status = TransferStatus::kFailed;
  std::unique_ptr<UsbConnection> connection;  ///< where the status is kOk
};

class UsbTransport {
 public:
  UsbTransport() = default;
  UsbTransport(const UsbTransport&) = delete;
  UsbTransport& operator=(const UsbTransport&) = delete;
  virtual ~UsbTransport() = default;

  /// All that is plugged in now.
  [[nodiscard]] virtual std::vector<UsbDevice> devices() = 0;
  /// Opens the device that is plugged in at `path`, takes `interface` from the system's own driver, if one
  /// has it, and claims it.
  [[nodiscard]] virtual UsbOpened open(const std::string& path, int interface) = 0;
  /// Whether this user may open it; claims nothing, so that a program that has it goes on undisturbed.
  [[nodiscard]] virtual TransferStatus access(const std::string& path) = 0;
  /// [s] of a clock that only goes forward: CLOCK_MONOTONIC but in tests.
  [[nodiscard]] virtual double now() const noexcept = 0;
  virtual void sleep(double seconds) noexcept = 0;
  /// Waits for up to `seconds` for something to be plugged in. A bus that cannot tell of that is to be looked
  /// at again soon.
  virtual void await_arrival(double seconds) noexcept {
    constexpr double kSoon = 0.1;  // [s]
    sleep(std::min(seconds, kSoon));
  }
};

}  // namespace palpate
