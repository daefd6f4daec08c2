/// What the rays of a volume look up, on the GPU: voxels, preintegrated tables, where nothing is seen.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/render/gl/object.h"
#include "common/render/volume/table/gpu_preintegration.h"
#include "common/render/volume/tile_pass.h"
#include "common/render/volume/volume_block.h"
#include "common/render/volume/volume_view.h"
#include "common/render/volume/voxels/brick_demand.h"
#include "common/render/volume/voxels/brick_map.h"
#include "common/render/volume/voxels/field_voxels.h"
#include "common/render/volume/voxels/pinned_voxels.h"
#include "common/render/volume/voxels/voxel_bricks.h"

namespace palpate {

class VolumeTextures {
 public:
  /// Uploads what `view` changes: voxels when the image is another one or others are seen of a volume in
  /// bricks, colours when some part is first drawn
  /// in them, tables and bricks when transfer functions or lengths are others.
  /// @pre view.image is not null; samples a voxel are positive and finite; at least two table entries, and
  /// lengths a multiple of kLengthGroup.
  /// @throws Error (usage) where a volume with colours is larger than the driver's textures, or no memory is
  /// given.
  /// @param other whose voxels and colours on the GPU are these, too, where it has the same images, and whose
  /// program for tiles is; null: none.
  /// @param sight from where the picture is taken, which of a volume in bricks holds what it looks up.
  void update(const VolumeView& view, const BrickSight& sight, const VolumeTextures* other = nullptr);

  /// Gives up bricks that are another one's, which then may use their pool for others.
  void release_bricks() { bricks_.reset(); }

  /// To the units of shaders/volume/volume_block.glsl. @param colors of the voxels, too.
  void bind(bool colors) const;
  /// The voxels alone, to another unit. @pre they stand as a whole, and not pinned: shader_defines() is empty.
  void bind_voxels(std::uint32_t unit) const;

  /// What shaders that look up voxels are told (compile_program()): others only after update() for another
  /// image, other storage, other fields or another kind of transfer functions.
  [[nodiscard]] std::vector<std::string> shader_defines() const;

  /// What is drawn: the view's, or a coarser one where that does not fit its storage.
  [[nodiscard]] const std::shared_ptr<const VolumeImage>& image() const noexcept { return image_; }
  /// The view with what is drawn in place of its images.
  [[nodiscard]] VolumeView drawn(VolumeView view) const;
  [[nodiscard]] const Index3& bricks() const noexcept {
    return bricks_of_image_.ranges().bricks;
  }  ///< an axis
  /// The same of each field up to the last one that is shown.
  [[nodiscard]] const std::vector<Index3>& field_bricks() const noexcept { return field_bricks_; }
  /// Samples a voxel below which rays of the context's field do not ask for empty bricks: to ask costs more
  /// than it saves where few samples lie in a brick and few bricks between others are empty.
  [[nodiscard]] double fewest_samples_to_leap() const noexcept;
  [[nodiscard]] TilePass& tiles() noexcept { return tiles_; }
  [[nodiscard]] const TilePass& tiles() const noexcept { return tiles_; }

  /// CoarserVoxels::hidden of what is drawn.
  [[nodiscard]] double hidden() const noexcept { return hidden_; }
  /// Of a volume in bricks.
  [[nodiscard]] BrickShare bricks_held() const noexcept;
  /// How often other voxels were uploaded: what was drawn before is no longer what would be.
  [[nodiscard]] std::uint64_t changes() const noexcept { return changes_; }

  struct Cost {
    std::uint64_t voxel_bytes = 0, table_bytes = 0, brick_bytes = 0;
    std::uint64_t field_bytes = 0;  ///< voxels of fields beside that of the context
    double table_ms = 0.0;          ///< of the last preintegration
    int tables_made = 0;            ///< then, preintegrated and of regions
    double segments_made = 0.0;     ///< then, share of the last preintegrated table that was made anew
    double empty_share = 0.0;       ///< of the bricks, for the context
  };
  [[nodiscard]] const Cost& cost() const noexcept { return cost_; }
  [[nodiscard]] const TableChoice& table_choice() const noexcept { return choice_; }

 private:
  /// All that the tables depend on.
  struct TableKey {
    std::vector<FieldTransfer> transfers;
    std::vector<PlaceRange> places;  ///< of each field's tables, in numbers of its image
    double longest = 0.0;            ///< in units of the opacity length
    int entries = 0, lengths = 0;
    bool preintegrate = true;

    bool operator==(const TableKey& other) const;
    /// Whether tables of both are as large, stand in the same places and are of the same matter but for some
    /// transfer functions.
    [[nodiscard]] bool same_places(const TableKey& other) const;
  };
  /// All that decides where the voxels of a view stand.
  struct PlaceKey {
    std::shared_ptr<const VolumeImage> image;
    VoxelStorage storage;
    std::vector<FieldTransfer> transfers;  ///< this and what follows: of volumes in bricks alone
    double step = 0.0, opacity_length = 0.0;
    bool magnified = false, blended = false;
    std::vector<CuttingPlane> cuts;  ///< on which values are drawn

    bool operator==(const PlaceKey&) const = default;
  };
  /// The volume from means of 2^n voxels an axis, n its place in `levels_`.
  struct Level {
    std::shared_ptr<const VolumeImage> image;
    BrickRanges ranges;
    std::vector<bool> needed;  ///< bricks, by `placed_`; empty: not asked for yet
  };
  void share_voxels(const VolumeTextures& other);
  void place_voxels(const VolumeView& view, const BrickSight& sight);
  void place_bricks(VolumeView view, const BrickSight& sight);
  bool add_level(const VolumeView& view, bool wait);
  void forget_bricks();
  void place_whole(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges,
                   const VoxelStorage& storage);
  void take_image(const std::shared_ptr<const VolumeImage>& image, const BrickRanges& ranges);
  void update_colors(const VolumeView& view);
  void update_lines(const VolumeView& view);
  void update_tables(const VolumeView& view);
  void allocate_tables(const VolumeView& view);
  void fill_table(const VolumeView& view, const std::vector<OpticalEntry>& entries, EntryRange changed,
                  int first_layer);
  void upload_table(std::size_t lengths, const EntryRange& changed, std::size_t entries, int first_layer);
  std::vector<std::uint8_t> update_preintegrated(const VolumeView& view, const FieldTransfer& transfer,
                                                 const TransferBlock& place,
                                                 std::vector<OpticalEntry>& before);
  std::vector<std::uint8_t> update_regions(const VolumeView& view, const FieldTransfer& transfer,
                                           const TransferBlock& place);

  std::shared_ptr<const GlTexture> voxels_;  ///< null where they stand in bricks, or are pinned
  std::shared_ptr<const PinnedVoxels> pinned_;
  std::shared_ptr<VoxelBricks> bricks_;
  std::uint64_t entered_before_ = 0;  ///< bricks of this volume, into other places than `bricks_`
  PlaceKey placed_;
  std::optional<BrickSight> sight_;  ///< for which all that is looked up is there
  std::vector<Lens> lenses_;         ///< likewise
  std::uint64_t changes_ = 0;
  std::vector<Level> levels_;  ///< of volumes in bricks, as far as they were asked for
  std::future<Level> making_;  ///< the next one
  std::size_t left_out_ = 0;   ///< bricks in sight that have no room until that is there
  FieldVoxels fields_;
  bool regions_ = false;         ///< some part is shown by value and gradient magnitude
  std::size_t field_count_ = 1;  ///< up to the last one that is shown
  std::vector<Index3> field_bricks_;
  std::shared_ptr<const GlTexture> colors_;
  int line_halvings_ = 1;                                  ///< as append_axis_tables() says
  GlBuffer lines_;                                         ///< of axes of uneven steps; none: all are even
  std::vector<std::shared_ptr<const VolumeImage>> lined_;  ///< the images that it is made from
  GlTexture tables_, region_tables_, empty_bricks_;
  std::shared_ptr<const VolumeImage> image_;
  FieldBricks bricks_of_image_;
  TilePass tiles_;
  double gaps_ = 1.0;    ///< gap_share() of the context's field
  double hidden_ = 0.0;  ///< hidden_share()
  TableKey key_;
  std::vector<std::vector<std::uint8_t>> distances_;  ///< between empty bricks, for each transfer function
  std::vector<std::vector<OpticalEntry>> optical_;    ///< of each preintegrated table; empty: not filled
  TableChoice choice_;
  GpuPreintegration gpu_;
  /// Kept: it is large and asked for again while a function is dragged.
  std::vector<std::uint16_t> table_;
  Cost cost_;
};

}  // namespace palpate
