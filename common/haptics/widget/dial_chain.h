/// What a hand feels of a slider or knob in space: its way holds it, and detents along it catch (Ikits 2006,
/// sec. 3.2: physical and virtual constraints for precision; sec. 8.6: constraints of user interfaces).
///
/// Two links: the segment or circle, and marks on it at equal distances. A pull of the second reaches the
/// hand through the Jacobian of the first, so that detents are felt along the way alone.
///
/// As words, with numbers that read back to the same bits:
///
///   slider:ax,ay,az,bx,by,bz,N              from a to b, N detents
///   knob:cx,cy,cz,nx,ny,nz,sx,sy,sz,N       about n at c, through s, where the first of N detents is
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "common/haptics/proxy_chain.h"

namespace palpate {

/// The way of a slider or knob: of the length and frame that its user says, the workspace's in a chain.
struct Dial {
  enum class Kind : std::uint8_t { kSlider, kKnob };

  Kind kind = Kind::kSlider;
  Vec3 start{0.0};             ///< one end of a slider; of a knob where the first detent is
  Vec3 end{1.0, 0.0, 0.0};     ///< the other end of a slider; the centre of a knob
  Vec3 normal{0.0, 0.0, 1.0};  ///< of a knob, any length but zero
  /// On the whole of it, both ends of a slider among them, up to DetentMarks::kMost; below 2: none.
  int detents = 0;

  bool operator==(const Dial&) const = default;
};

/// @pre start and end differ, not along the normal of a knob. @throws std::length_error for too many detents.
[[nodiscard]] std::unique_ptr<ProxyChain> make_dial_chain(const Dial& dial, const ChainSettings& settings);

[[nodiscard]] std::string text_of(const Dial& dial);
/// Whether a word is that of a dial, well formed or not.
[[nodiscard]] bool names_dial(std::string_view text) noexcept;
/// @return what is wrong, in a few words; nothing where `dial` has been read.
[[nodiscard]] std::optional<std::string> read_text(std::string_view text, Dial& dial);

}  // namespace palpate
