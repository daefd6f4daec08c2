/// How much of a bundle there is room for on the GPU, and what to say of the rest.
#pragma once

#include <cstddef>
#include <string>

#include "common/render/tract/tract_bundle.h"

namespace palpate {

/// 64 Mi points as they come; a third of them are left in a picture of the whole, all when it is enlarged: a
/// gigabyte at most.
inline constexpr std::size_t kTractPiecesOfRoom = (std::size_t{1} << 26U) / TractBundle::kPiecePoints;

/// How many of its pieces are drawn at most; the first ones, which are an even sample of the lines.
[[nodiscard]] std::size_t pieces_with_room(const TractBundle& bundle,
                                           std::size_t room = kTractPiecesOfRoom) noexcept;
/// "1200 of 3000 tracts are drawn, …", or empty where there is room for all of them.
[[nodiscard]] std::string tracts_left_out(const TractBundle& bundle, std::size_t room = kTractPiecesOfRoom);

}  // namespace palpate
