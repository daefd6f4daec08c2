/// Messages of Haply's service for the Inverse3: the state that it sends, the command that it takes.
///
/// It may be anybody who speaks: nesting, sizes and names are bounded, and a state counts only if it is
/// whole. Frame of the maker: x right, y forward, z up, from the mounting plate; metres, newtons.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

/// The name of a force's components in a command, which differs by the version of the service.
enum class HaplySpelling : std::uint8_t { kValues, kVector };

/// "3.5.1" or a text with such a number after the word version. Up to 3.4 a service takes `values`, later
/// ones `vector`. Nothing where the text tells no version.
[[nodiscard]] std::optional<HaplySpelling> haply_spelling(std::string_view version_text) noexcept;

/// A device's name in the service: letters, digits, '-' and '_', so that nothing else can get into a command.
class HaplyId {
 public:
  static constexpr std::size_t kLongest = 32;

  [[nodiscard]] static std::optional<HaplyId> from(std::string_view text) noexcept;
  [[nodiscard]] std::string_view view() const noexcept { return {letters_.data(), length_}; }

 private:
  std::array<char, kLongest> letters_{};
  std::size_t length_ = 0;
};

/// What one message says of a device and of the first grip.
struct HaplyState {
  std::optional<HaplyId> device;  ///< none: the message has no such device
  std::optional<Vec3> position;   ///< [m] in the maker's frame
  std::uint32_t buttons = 0;      ///< a, b, c or button_0 to button_3 as bits 0 to 3
  bool grip = false;              ///< it has one
  /// Of the device's status, where the message has it: not every one does.
  std::optional<bool> calibrated, powered;
};

inline constexpr std::size_t kHaplyDeepest = 16;  ///< levels of nesting

/// Reads a message, without allocating. @param wanted the device that is asked for; empty: the first one.
/// @return false for what is no message of the service.
[[nodiscard]] bool read_haply_state(std::string_view message, std::string_view wanted,
                                    HaplyState& state) noexcept;

/// The command to show `force` [N, the maker's frame] into `text`, whose memory is used again.
void write_haply_force(std::string& text, const HaplyId& device, const Vec3& force, HaplySpelling spelling);

}  // namespace palpate
