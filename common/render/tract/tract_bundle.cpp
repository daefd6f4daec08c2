#include "common/render/tract/tract_bundle.h"

#include <algorithm>
#include <random>
#include <utility>

namespace palpate {
namespace {

/// Fisher and Yates with a generator whose numbers the standard fixes; std::shuffle's use of it is not.
void shuffle(std::vector<std::uint32_t>& order) {
  std::mt19937_64 random{7};
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
}

}  // namespace

std::shared_ptr<const TractBundle> make_tract_bundle(std::shared_ptr<const Tractogram> lines) {
  auto bundle = std::make_shared<TractBundle>();
  for (std::size_t i = 0; i < lines->line_count(); ++i) {
    if (lines->line(i).size() > 1) bundle->order.push_back(static_cast<std::uint32_t>(i));
  }
  shuffle(bundle->order);
  std::size_t first = 0, points = 0;
  for (std::size_t i = 0; i < bundle->order.size(); ++i) {
    points += lines->line(bundle->order[i]).size();
    if (points < TractBundle::kPiecePoints && i + 1 < bundle->order.size()) continue;
    bundle->pieces.emplace_back(first, i + 1);
    first = i + 1;
    points = 0;
  }
  for (const Vec3f& point : lines->points) {
    if (is_finite(Vec3(point))) bundle->bounds.include(Vec3(point));
  }
  bundle->lines = std::move(lines);
  return bundle;
}

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
