/// Records of the Polhemus trackers, and finding them in a stream of bytes. Pure, allocates nothing.
///
/// Liberty, Patriot: 8 bytes of header, then what was ordered. Numbers are little-endian, floats of 4 bytes.
///
///   0 "LY" "PA" or "LU"    2 station, from 1    3 command    4 error, ' ': none    6 bytes that follow
///
/// Fastrak: '0', the station as '1' to '4', a status (' ', or a letter: the signal is poor), position,
/// quaternion, button as ' ' and '0' or '1', ' '.
///
/// Neither has a checksum, so a record counts only where every byte of it that is known beforehand is right
/// and the quaternion is one; else the search goes on one byte later. One record is lost for each that is
/// damaged, none that comes whole after it.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

#include "common/math/quaternion.h"

namespace palpate {

/// Of one sensor. The position is in whatever unit the tracker was told to use.
struct PolhemusRecord {
  int station = 0;  ///< from 1
  char error = ' ';
  Vec3 position{0.0};
  Quat orientation{1.0, 0.0, 0.0, 0.0};  ///< unit
  bool button = false;
  std::uint32_t frame = 0;  ///< counted by the tracker; Liberty and Patriot, where ordered
  std::uint32_t time = 0;   ///< [ms] of the tracker's clock; likewise
};

/// Sensors that are plugged in and switched on; bit i: station i + 1.
struct PolhemusStations {
  std::uint16_t detected = 0, active = 0;
};

using PolhemusNews = std::variant<PolhemusRecord, PolhemusStations>;

/// What a Liberty or Patriot can be ordered to say, by its number in the command O.
enum class LibertyItem : std::uint8_t {
  kSpace = 0,
  kLineEnd = 1,
  kPosition = 2,
  kPositionExtended = 3,
  kEuler = 4,
  kEulerExtended = 5,
  kQuaternion = 7,
  kTime = 8,
  kFrame = 9,
  kButton = 10,
  kDistortion = 11
};
[[nodiscard]] std::size_t bytes_of(LibertyItem item) noexcept;

class LibertyParser {
 public:
  static constexpr std::size_t kHeader = 8, kMostItems = 10, kMostStations = 16;

  /// @pre `items` are at most kMostItems, with a position and a quaternion.
  explicit LibertyParser(std::span<const LibertyItem> items) noexcept;

  [[nodiscard]] std::optional<PolhemusNews> push(std::uint8_t byte) noexcept;
  /// Forgets what is half there.
  void clear() noexcept { size_ = 0; }
  [[nodiscard]] std::size_t record_bytes() const noexcept { return kHeader + payload_; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }  ///< bytes of no record

 private:
  static constexpr std::size_t kMost = kHeader + kMostItems * 16;

  [[nodiscard]] bool could_begin() const noexcept;
  [[nodiscard]] std::optional<PolhemusNews> decoded() const noexcept;
  void drop_first() noexcept;

  std::array<LibertyItem, kMostItems> items_{};
  std::size_t item_count_ = 0, payload_ = 0;
  std::array<std::uint8_t, kMost> bytes_{};
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

class FastrakParser {
 public:
  static constexpr std::size_t kRecord = 34;
  static constexpr int kMostStations = 4;

  [[nodiscard]] std::optional<PolhemusNews> push(std::uint8_t byte) noexcept;
  void clear() noexcept { size_ = 0; }
  [[nodiscard]] std::uint64_t dropped() const noexcept { return dropped_; }

 private:
  [[nodiscard]] bool could_begin() const noexcept;
  [[nodiscard]] std::optional<PolhemusNews> decoded() const noexcept;
  void drop_first() noexcept;

  std::array<std::uint8_t, kRecord> bytes_{};
  std::size_t size_ = 0;
  std::uint64_t dropped_ = 0;
};

}  // namespace palpate
