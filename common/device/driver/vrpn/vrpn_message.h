/// Messages of VRPN, as its own C++ programs send them over TCP; pure, allocates nothing.
///
/// Both ends greet each other by a cookie, name their senders and types by numbers of their own, and then
/// send
///
///   length, seconds, microseconds, sender, type, a number    6 x 4 bytes, big-endian
///   payload                                                  length - 24 bytes, then filled up to 8
///
/// The other side may be anybody: a length that no message has ends the stream, a payload that is longer than
/// any that is read is skipped, numbers of senders and types are bounded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "common/base/index.h"
#include "common/math/quaternion.h"
#include "common/math/vec.h"

namespace palpate {

inline constexpr std::size_t kVrpnCookie = 24;      ///< [bytes]
inline constexpr std::size_t kVrpnHeader = 24;      ///< [bytes]
inline constexpr std::size_t kVrpnLongest = 65536;  ///< [bytes] of a message: a longer one is none
inline constexpr std::size_t kVrpnKept = 1024;      ///< [bytes] of a payload that is read
inline constexpr std::int32_t kVrpnSenders = -1, kVrpnTypes = -2;  ///< types of descriptions

struct VrpnMessage {
  std::int32_t sender = 0;
  std::int32_t type = 0;
  double time = 0.0;                      ///< [s] of the sender's clock, when it was made
  std::span<const std::uint8_t> payload;  ///< until the next push(); empty where it was too long to keep
};

/// Takes the stream apart, in whatever pieces it comes.
class VrpnParser {
 public:
  enum class Found : std::uint8_t {
    kNothing,  ///< all bytes were taken
    kCookie,
    kMessage,
    kNonsense  ///< it is no VRPN, and will not become it
  };

  /// Takes bytes from the front of `bytes` up to the end of the next message. @rt Safe.
  Found push(std::span<const std::uint8_t>& bytes, VrpnMessage& message) noexcept;
  void reset() noexcept { *this = VrpnParser(); }

 private:
  Found take_header() noexcept;

  std::array<std::uint8_t, kVrpnHeader + kVrpnKept> kept_{};
  std::size_t size_ = 0;              ///< of kept_
  std::size_t wanted_ = kVrpnCookie;  ///< of kept_ and what is skipped, until something is whole
  std::size_t skipped_ = 0;
  std::size_t payload_ = 0;  ///< [bytes] of the message that is under way
  bool greeted_ = false, in_body_ = false, broken_ = false;
};

/// The types that are understood.
enum class VrpnType : std::uint8_t {
  kOther,
  kPosQuat,
  kButtonChange,
  kButtonStates,
  kAnalog,
  kForceError,
  kForceField,
  kPing,
  kPong
};
[[nodiscard]] std::string_view name_of(VrpnType type) noexcept;  ///< "vrpn_Tracker Pos_Quat"

/// What the other side calls things: its numbers for one sender, and for the types above.
class VrpnNames {
 public:
  static constexpr std::size_t kMost = 2000;  ///< numbers a kind; higher ones are not known

  /// @param device the name of the sender; outlives this.
  explicit VrpnNames(std::string_view device) noexcept : device_(device) {}

  /// Takes a description; others are nothing to it. @rt Safe.
  void take(const VrpnMessage& message) noexcept;
  [[nodiscard]] bool is_device(std::int32_t sender) const noexcept {
    return sender >= 0 && as_size(sender) < kMost && senders_[as_size(sender)];
  }
  [[nodiscard]] VrpnType type(std::int32_t number) const noexcept {
    const bool known = number >= 0 && as_size(number) < kMost;
    return known ? types_[as_size(number)] : VrpnType::kOther;
  }
  [[nodiscard]] bool has_device() const noexcept { return has_device_; }
  void reset() noexcept { *this = VrpnNames(device_); }

 private:
  std::string_view device_;
  std::array<bool, kMost> senders_{};
  std::array<VrpnType, kMost> types_{};
  bool has_device_ = false;
};

/// @name Payloads; nothing where one is none
/// @{
struct VrpnPose {
  std::int32_t sensor = 0;
  Vec3 position{0.0};                    ///< [m]
  Quat orientation{1.0, 0.0, 0.0, 0.0};  ///< of unit length
};
[[nodiscard]] std::optional<VrpnPose> vrpn_pose(std::span<const std::uint8_t> payload) noexcept;
/// `buttons` after a Change or States; buttons from 32 on are not known.
[[nodiscard]] std::optional<std::uint32_t> vrpn_button_change(std::span<const std::uint8_t> payload,
                                                              std::uint32_t buttons) noexcept;
[[nodiscard]] std::optional<std::uint32_t> vrpn_button_states(std::span<const std::uint8_t> payload) noexcept;
/// The first channels into `values`, clamped to [-1, 1]. @return how many there were.
[[nodiscard]] std::optional<std::size_t> vrpn_channels(std::span<const std::uint8_t> payload,
                                                       std::span<double> values) noexcept;
/// @}

/// A force around a point: F = force + jacobian (p - origin) while |p - origin| < radius, else none.
struct VrpnForceField {
  Vec3 origin{0.0};     ///< [m]
  Vec3 force{0.0};      ///< [N]
  Mat3 jacobian{0.0};   ///< [N/m], columns as everywhere here
  double radius = 0.0;  ///< [m]
};

/// Packs messages one after another into memory that is given.
class VrpnWriter {
 public:
  explicit VrpnWriter(std::span<std::uint8_t> memory) noexcept : memory_(memory) {}

  void cookie() noexcept;
  /// @param kind kVrpnSenders or kVrpnTypes.
  void description(std::int32_t kind, std::int32_t number, std::string_view name) noexcept;
  void empty(double time, std::int32_t sender, std::int32_t type) noexcept {
    message(time, sender, type, {});
  }
  void force_field(double time, std::int32_t sender, std::int32_t type, const VrpnForceField& field) noexcept;

  [[nodiscard]] std::span<const std::uint8_t> bytes() const noexcept { return memory_.first(size_); }
  [[nodiscard]] bool overflowed() const noexcept { return overflowed_; }  ///< something did not fit

 private:
  void message(double time, std::int32_t sender, std::int32_t type,
               std::span<const std::uint8_t> payload) noexcept;

  std::span<std::uint8_t> memory_;
  std::size_t size_ = 0;
  std::uint32_t number_ = 0;
  bool overflowed_ = false;
};

}  // namespace palpate
