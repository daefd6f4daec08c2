/// A link to a Fakespace Pinch Glove at a serial line: ten buttons, fingers that touch another one.
///
/// It speaks when something changes, so it is asked now and then whether it is still there; unheard for
/// kSilence all fingers are apart. It is no dead-man switch: a message that is lost leaves what was before.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "common/device/driver/pinchglove/pinch_message.h"
#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver_link.h"

namespace palpate {

struct PinchSettings {
  std::string port;
  int baud = 9600;
};

/// The options of `--device pinchglove:port=/dev/ttyUSB0,baud=9600`. @throws Error (usage).
[[nodiscard]] PinchSettings pinch_settings(const DriverOptions& options);
[[nodiscard]] std::string pinch_help();

class PinchLink final : public DriverLink {
 public:
  static constexpr double kAskEvery = 0.5;  ///< [s] unheard for so long it is asked
  static constexpr double kSilence = 1.2;   ///< [s] unheard for so long it is gone

  explicit PinchLink(std::unique_ptr<StreamPlace> line) : line_(std::move(line)) {}

  bool round(const Vec3& force) noexcept override;
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override;
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return stream_ ? line_->name() : std::string(); }

 private:
  void search() noexcept;
  bool listen() noexcept;
  /// Its fingers are apart from now on. @return whether that is new.
  bool release() noexcept;
  bool close() noexcept;

  std::unique_ptr<StreamPlace> line_;
  DeviceLimits limits_;  ///< it shows no force
  LinkStatus status_;
  DeviceAtoms atoms_;
  std::unique_ptr<ByteStream> stream_;
  PinchParser parser_;
  TransferStatus refused_ = TransferStatus::kOk;
  double heard_ = 0.0, ask_at_ = 0.0;  ///< [s]
  int misses_ = 0;
};

}  // namespace palpate
