#include "common/render/tract/tract_room.h"

#include <algorithm>

namespace palpate {

std::size_t pieces_with_room(const TractBundle& bundle, std::size_t room) noexcept {
  return std::min(bundle.pieces.size(), room);
}

std::string tracts_left_out(const TractBundle& bundle, std::size_t room) {
  const std::size_t pieces = pieces_with_room(bundle, room);
  if (pieces == bundle.pieces.size()) return {};
  const std::size_t drawn = pieces > 0 ? bundle.pieces[pieces - 1].second : 0;
  return std::to_string(drawn) + " of " + std::to_string(bundle.order.size()) +
         " tracts are drawn, an even sample: all have " + std::to_string(bundle.lines->points.size()) +
         " points, and a picture has room for about " + std::to_string(room * TractBundle::kPiecePoints) +
         "; trace with a longer --step to see more of them";
}

}  // namespace palpate
