/// What a hand feels of a slider or knob in space: its way holds it, and detents along it catch (Ikits 2006,
/// sec. 3.2: physical and virtual constraints for precision; sec. 8.6: constraints of user interfaces).
///
/// Two links: the segment or circle, and marks on it at equal distances. A pull of the second reaches the
/// hand through the Jacobian of the first, so that detents are felt along the way alone.
#pragma once

#include <memory>

#include "common/haptics/proxy_chain.h"

namespace palpate {

/// @param detents on the way, both ends among them, 2 to DetentMarks::kMost; below 2: none.
/// @pre a and b differ. @throws std::length_error for more of them.
[[nodiscard]] std::unique_ptr<ProxyChain> make_slider_chain(const Vec3& a, const Vec3& b, int detents,
                                                            const ChainSettings& settings);

/// @param start where the first detent is, off the axis  @param detents on the whole turn, 2 to
/// DetentMarks::kMost; below 2: none.
/// @pre the normal has a length. @throws std::length_error for more of them.
[[nodiscard]] std::unique_ptr<ProxyChain> make_knob_chain(const Vec3& center, const Vec3& normal,
                                                          const Vec3& start, double radius, int detents,
                                                          const ChainSettings& settings);

}  // namespace palpate
