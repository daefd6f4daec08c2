/// A link to a Fakespace Pinch Glove at a serial line: ten buttons, fingers that touch another one.
///
/// It speaks when something changes, so it is asked now and then whether it is still there; unheard for
/// kSilence all fingers are apart. It is no dead-man switch: a message that is lost leaves what was before.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "common/device/driver/transport/byte_stream.h"
#include "common/device/driver_link.h"

namespace palpate {

// Messages of the Fakespace Pinch Glove: which fingers touch each other. Pure, allocates nothing.
//
//   0x80, pairs (left, right), 0x8F        0x81 … two bytes of time, 0x8F        0x82, text, 0x8F
//
// A pair is a group of fingers in mutual contact, bits 0x10 thumb to 0x01 little finger of each hand; an
// empty message: none touch. A message with anything else in it says nothing that could be relied on.

enum class PinchNews : std::uint8_t {
  kNothing,
  kContacts,  ///< contacts() are new
  kText,      ///< it answered
  kDamaged    ///< a message that cannot be: what touches now is not known
};

class PinchParser {
 public:
  [[nodiscard]] PinchNews push(std::uint8_t byte) noexcept;
  /// Bits 0 to 4: the right hand's fingers from the thumb on that touch another one; 5 to 9: the left hand's.
  [[nodiscard]] std::uint32_t contacts() const noexcept { return contacts_; }
  void clear() noexcept { state_ = State::kNone; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }  ///< bytes of no message

 private:
  enum class State : std::uint8_t { kNone, kContacts, kTimedContacts, kText };

  [[nodiscard]] PinchNews ended() noexcept;

  static constexpr std::size_t kMostGroups = 5, kMost = 2 * kMostGroups + 2;
  State state_ = State::kNone;
  std::array<std::uint8_t, kMost> bytes_{};
  std::size_t size_ = 0, text_ = 0;
  std::uint32_t contacts_ = 0;
  std::uint64_t dropped_ = 0;
};

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

  bool round() noexcept override;
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
