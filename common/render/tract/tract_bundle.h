/// A tractogram prepared for pictures: pure arithmetic, no OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/geometry/tractogram.h"
#include "common/math/vec.h"

namespace palpate {

/// Immutable where shared.
struct TractBundle {
  std::shared_ptr<const Tractogram> lines;
  /// Numbers of all lines of two points and more, shuffled: every first part is an even sample of them. The
  /// same for the same number of lines.
  std::vector<std::uint32_t> order;
  /// Parts of `order`, [first, last): each of about kPiecePoints points, one line at least.
  std::vector<std::pair<std::size_t, std::size_t>> pieces;
  Box bounds;  ///< of the finite points

  /// So few that a picture in motion, of at least one piece, keeps to its time without a graphics card too.
  static constexpr std::size_t kPiecePoints = 1U << 14U;
};

/// @param lines not null.
[[nodiscard]] std::shared_ptr<const TractBundle> make_tract_bundle(std::shared_ptr<const Tractogram> lines);

}  // namespace palpate
