/// A tractogram prepared for pictures: pure arithmetic, no OpenGL.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/tractogram.h"
#include "common/math/vec.h"
#include "common/render/camera.h"

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
  std::vector<std::uint32_t>
      colors;  ///< packed_color() of each point, or kByDirection; empty: all by direction

  static constexpr std::uint32_t kByDirection = 1U << 31U;
  /// So few that a picture in motion, of at least one piece, keeps to its time without a graphics card too.
  static constexpr std::size_t kPiecePoints = 1U << 14U;
};

/// @param lines not null. @param colors as TractBundle::colors.
[[nodiscard]] std::shared_ptr<const TractBundle> make_tract_bundle(std::shared_ptr<const Tractogram> lines,
                                                                   std::vector<std::uint32_t> colors = {});
/// sRGB in three numbers of eight bits, of 255; red in the lowest ones.
[[nodiscard]] std::uint32_t packed_color(const Vec3f& srgb) noexcept;

/// 64 Mi points as they come; a third of them are left in a picture of the whole, all when it is enlarged: a
/// gigabyte at most.
inline constexpr std::size_t kTractPiecesOfRoom = (std::size_t{1} << 26U) / TractBundle::kPiecePoints;

/// How many of its pieces are drawn at most; the first ones, which are an even sample of the lines.
[[nodiscard]] std::size_t pieces_with_room(const TractBundle& bundle,
                                           std::size_t room = kTractPiecesOfRoom) noexcept;
/// "1200 of 3000 tracts are drawn, …", or empty where there is room for all of them.
[[nodiscard]] std::string tracts_left_out(const TractBundle& bundle, std::size_t room = kTractPiecesOfRoom);

/// The tracts of some lengths, to be drawn in place of all; what has been found is kept for the next picture.
class LengthFilter {
 public:
  /// Those of `whole` from `least` to `most` [data units]; `whole` itself where none is left out.
  /// @param whole not null.
  [[nodiscard]] const std::shared_ptr<const TractBundle>& of(const std::shared_ptr<const TractBundle>& whole,
                                                             double least, double most);
  /// Of those that were given last; 0: none.
  [[nodiscard]] double longest() const noexcept { return longest_; }

 private:
  std::shared_ptr<const TractBundle> whole_, part_;
  std::vector<double> lengths_;  ///< in the order of `whole_`
  double longest_ = 0.0, least_ = 0.0, most_ = 0.0;
};

/// The part of tracts that is seen over a slice: |normal . (x - place)| < half. With their distance from its middle
/// they take on the background.
struct TractSlab {
  Vec3 normal{0.0, 0.0, 1.0};  ///< unit
  Vec3 place{0.0};             ///< on its middle, data coordinates
  double half = 0.0;           ///< thickness [data units]; 0: nothing is seen

  bool operator==(const TractSlab&) const = default;
};

/// Lines coloured by their direction, or as the bundle says.
struct TractView {
  std::shared_ptr<const TractBundle> bundle;  ///< not null
  double width = 1.5;                         ///< at the focal point, in thousandths of the picture's height
  double opacity = 1.0;                       ///< in (0, 1]
  bool depth_cue = true;                      ///< farther lines fade into the background
  std::optional<double> slab_thickness;  ///< of what slices show [data units]; absent: two of their steps
  std::optional<TractSlab> slab;         ///< of this picture; absent: all is seen

  bool operator==(const TractView&) const =
      default;  ///< bundles count as the same where they are the same object
};

/// One point, as laid out in the shader's buffer: half of what it takes as three numbers and three more.
struct TractPoint {
  Vec3f position{0.0F};       ///< scene frame
  std::uint32_t tangent = 0;  ///< packed_tangent(), or kBetweenLines

  static constexpr std::uint32_t kBetweenLines = 1U << 30U;
};

/// A unit vector, or zero, in three signed numbers of ten bits, of 511; x in the lowest ones. Each component
/// is off by 1/1022 at most, an eighth of what a screen shows of the colour made of it.
[[nodiscard]] std::uint32_t packed_tangent(const Vec3f& tangent) noexcept;

/// The lines of a piece, each without the points that a picture does not need, and a point between every two
/// of them: what is left lies within `tolerance` (scene frame) of the lines, with tangents of the whole ones.
/// Segments whose ends coincide, or are not finite, are left out. @param colors gets those of the points; null: not
/// asked for. @pre piece < bundle.pieces.size(); `colors` only of a bundle that has some.
[[nodiscard]] std::vector<TractPoint> piece_points(const TractBundle& bundle, std::size_t piece,
                                                   const SceneFrame& frame, double tolerance,
                                                   std::vector<std::uint32_t>* colors = nullptr);

}  // namespace palpate
