/// Voxels on the GPU in bricks: those that are seen stand in one pool, an index finds them (Ikits 2006, sec.
/// 5.6).
///
/// Symbols.  c cells of a brick an axis; g grid coordinates; b = floor(g / c) brick; p_b the voxel of the
/// pool at which it begins. A brick has c + 1 points an axis: neighbours share the layer between them, so
/// values between points, and differences of these for gradients, are those of the whole. A point of the
/// volume is found in the pool at
///   p_b + g - b c,      b <= bricks - 1: the last brick owns the upper end of the volume
/// (derived anew: eq. 5.1 of the reference counts shared layers twice).
///
/// A brick need not stand in the pool where all its numbers are the same, and where nothing is seen of it: a
/// number of its range then stands for all of it. Where lenses blend values with coarser ones, all others
/// are needed. Of those that are needed, the ones that a picture looks up are paged in (brick_demand.h), in
/// the place of those that were looked up the longest ago. Where a picture may go without some of them, these
/// have a coarse one in the same pool, with means about every kBrickCells-th point: a 300th of
/// its voxels, that meet those of their neighbours at the faces.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

#include "common/math/vec.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_view.h"
#include "common/render/volume/voxels/brick_map.h"

namespace palpate {

/// Cells an axis: the layers shared are a tenth of the voxels.
inline constexpr int kPoolBrickCells = 32;

struct BrickLayout {
  int cells = kPoolBrickCells;  ///< an axis: c
  Index3 bricks{1};             ///< an axis
  Index3 points{2};             ///< of a brick, an axis; fewer than c + 1 along short axes
};
/// @pre cells is a positive multiple of kBrickCells.
[[nodiscard]] BrickLayout brick_layout(const VolumeImage& image, int cells);

/// A box along the axes of an image, in data coordinates: the columns of `half` are its half edges.
struct PointsPlace {
  Vec3 center{0.0};
  Mat3 half{1.0};
};
/// That of so many points from `first` on, and so many voxels beyond them on every side.
[[nodiscard]] PointsPlace place_of_points(const VolumeImage& image, const Index3& first, const Index3& points,
                                          double beyond);

/// For each brick, x fastest, whether it must stand in the pool for the picture of `view`.
/// @param ranges brick_ranges(*view.image).
[[nodiscard]] std::vector<bool> needed_bricks(const VolumeView& view, const BrickRanges& ranges,
                                              const BrickLayout& layout);

/// Places of a pool that coarse bricks for so many bricks take.
[[nodiscard]] std::size_t coarse_places(std::size_t bricks, const BrickLayout& layout);

/// Bricks an axis of a pool for `count` of them, as small as may be.
/// @pre count > 0. @param largest side of a texture [voxels].
/// @return zeros where no pool is large enough.
[[nodiscard]] Index3 pool_size(std::size_t count, const BrickLayout& layout, int largest);

/// Bytes of the index.
[[nodiscard]] std::uint64_t brick_index_bytes(const BrickLayout& layout);

/// Bytes of the index and of a pool for `count` bricks; the largest number where no pool is large enough.
[[nodiscard]] std::uint64_t bricked_bytes(std::size_t count, const BrickLayout& layout, ScalarType type,
                                          int largest);

/// Where bricks stand. One of enough places serves other levels of the same volume, too: to make a large one
/// takes longer than a picture. What a level leaves there stays until its place is needed.
struct BrickPool {
  struct Place {
    std::weak_ptr<const VolumeImage> image;  ///< whose brick stands there; none: nothing does
    std::size_t brick = 0;
    std::uint64_t looked_up = 0;  ///< the last of `pictures` that did
  };
  GlTexture texture;
  Index3 bricks{0};  ///< an axis
  Index3 points{0};  ///< of a brick, an axis
  ScalarType type = ScalarType::kFloat32;
  std::vector<Place> places;
  std::uint64_t pictures = 0;  ///< drawn from it
};

/// What a pool is to serve besides: finer levels of the volume.
struct FinerBricks {
  std::size_t needed = 0;         ///< of the level that needs most
  std::uint64_t index_bytes = 0;  ///< of its index
};

/// The pool and the index. Needs the context current in which it was made.
class VoxelBricks {
 public:
  /// @param ranges brick_ranges(*image). @param coarse whether coarse bricks stand in for those that are not
  /// there: what hold() may leave out.
  /// @param finer the pool is made for, too. @param pool to be used where it does for these bricks.
  VoxelBricks(std::shared_ptr<const VolumeImage> image, const BrickLayout& layout, const BrickRanges& ranges,
              bool coarse, const FinerBricks& finer = {}, BrickPool pool = {});

  /// Uploads those of the bricks that a picture looks up that are not there, in place of those that were
  /// looked up the longest ago.
  /// @param needed one for each brick. @param wanted of these, the most urgent one first.
  /// @param storage its memory bounds the pool: @pre bricked_bytes() of the places of wanted and coarse
  /// bricks
  /// <= memory, or memory is 0. Its upload bounds what is uploaded of `wanted`, where there are coarse
  /// bricks.
  void hold(const std::vector<bool>& needed, const std::vector<std::size_t>& wanted,
            const VoxelStorage& storage);

  /// The pool, for other bricks; these hold none then.
  [[nodiscard]] BrickPool give_pool() &&;

  /// Binds the pool as the voxels, and the index (shaders/volume/voxels.glsl).
  void bind() const;
  [[nodiscard]] const BrickLayout& layout() const noexcept { return layout_; }
  [[nodiscard]] bool coarse() const noexcept { return coarse_; }
  [[nodiscard]] std::uint64_t bytes() const noexcept { return bytes_; }
  [[nodiscard]] const BrickShare& share() const noexcept { return share_; }  ///< of the last hold()
  /// Bricks that came with the pool and were of use.
  [[nodiscard]] std::uint64_t kept() const noexcept { return kept_; }

 private:
  void find_pool(std::size_t needed, std::size_t wanted, std::uint64_t memory);
  void take_places();
  void find_room(std::size_t places);
  void upload(std::size_t brick, std::size_t slot);
  void hold_coarse(std::vector<std::size_t> bricks);
  void write_index(const std::vector<bool>& needed);
  [[nodiscard]] Index3 place_of(std::size_t slot) const;
  [[nodiscard]] Index3 coarse_place_of(std::size_t brick) const;

  std::shared_ptr<const VolumeImage> image_;
  BrickLayout layout_;
  bool coarse_;
  Index3 coarse_points_{2}, coarse_rows_{1};  ///< of a coarse brick; of these in a place
  std::vector<float> stand_ins_;     ///< for each brick the number that stands for it, as textures give it
  std::vector<int> slots_;           ///< for each brick its place in the pool; -1: none
  std::vector<int> coarse_numbers_;  ///< likewise its number among the coarse ones
  std::vector<std::uint64_t> looked_up_;  ///< for each brick the last picture that did
  std::vector<int> free_;                 ///< places
  FinerBricks finer_;
  BrickPool pool_;
  bool placed_ = false;           ///< the pool is divided up
  std::size_t first_coarse_ = 0;  ///< place from which on there are coarse ones
  std::size_t coarse_room_ = 0, coarse_held_ = 0;
  GlTexture index_;
  std::vector<std::byte> scratch_;
  std::uint64_t bytes_ = 0, kept_ = 0;
  BrickShare share_;
};

}  // namespace palpate
