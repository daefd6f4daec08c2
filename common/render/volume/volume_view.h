/// What a picture shows of a volume, as plain data.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/late.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/field/value_histogram.h"
#include "common/render/lens/lens.h"
#include "common/render/slice/slice_view.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// A plane that cuts away what lies beyond it, in lenses too.
struct CuttingPlane {
  ConvexShape::HalfSpace kept;  ///< what is left
  bool on = true;

  bool operator==(const CuttingPlane&) const = default;
};
inline constexpr std::size_t kMostCuts = 1024;  ///< of one picture

/// What is saved on all that lies outside lenses, where there are some (context_picture.h; Ikits 2006, sec.
/// 5.7.3).
struct ContextQuality {
  double viewport = 1.0;    ///< its pixels along either edge, as a share of the picture's: in (0, 1]
  int level = 0;            ///< voxels are means of about 2^level an axis: 0 to kCoarsestLevel
  int table_entries = 128;  ///< as VolumeView has them, where it is drawn by itself

  bool operator==(const ContextQuality&) const = default;
};
inline constexpr int kCoarsestLevel = 4;

/// What is drawn of the values on the planes of a view, whether these cut or not
/// (shaders/volume/plane_image.frag). Inside lenses it is what these show: their colours over the grey,
/// matter enlarged, nothing where they cut.
struct PlaneImages {
  bool shown = false;                 ///< the values in grey
  std::optional<ValueWindow> window;  ///< absent: from the lowest value to the highest one
  std::vector<double> contours;       ///< values of lines of equal value; at most kMostContours

  bool operator==(const PlaneImages&) const = default;
};
inline constexpr std::size_t kMostContours = 16;  ///< of one picture

/// Where voxels stand on the GPU. Volumes that do not fit are stored in bricks (voxel_bricks.h), those that
/// the picture looks up alone, and from coarser voxels where these are too many; volumes with colours as a
/// whole.
struct VoxelStorage {
  std::uint64_t memory = 0;  ///< that voxels may take [bytes]; 0: no bound
  /// Cells of bricks an axis, a multiple of kBrickCells; 0: the usual ones, and bricks only where need be.
  int brick_cells = 0;
  /// Of bricks that may be uploaded for one picture [bytes], one of them in any case; coarse ones stand in
  /// for those that are not there yet, and the same picture drawn again has more. 0: all that it looks up.
  std::uint64_t upload = 0;
  /// Where the rasteriser is the processor, voxels of so many bytes and more are read where they stand
  /// (pinned_voxels.h).
  std::uint64_t least_pinned = std::uint64_t{32} << 20U;

  bool operator==(const VoxelStorage&) const = default;
};

/// How many bricks of a volume are there for a picture; zeros where it stands as a whole.
struct BrickShare {
  std::size_t held = 0;       ///< of those that the picture looks up
  std::size_t wanted = 0;     ///< that it looks up
  std::size_t all = 0;        ///< of the volume
  std::uint64_t bytes = 0;    ///< of the pool and the index
  std::uint64_t entered = 0;  ///< bricks that were uploaded so far
  std::uint64_t left = 0;     ///< of these, whose place others took

  [[nodiscard]] bool complete() const noexcept { return held == wanted; }
};

/// What is drawn in place of a volume that does not fit its storage.
struct CoarserVoxels {
  Index3 points{0};  ///< an axis
  double hidden =
      0.0;  ///< share of the parts that show something which show nothing so, at least (hidden_share())
};

/// Another scalar of the scene, on a grid of its own, for lenses that show it, and over slices.
struct VolumeField {
  std::shared_ptr<const VolumeImage> image;
  std::string name;
  Late<ValueWindow> window;  ///< over which its colours on slices are spread: follows from the image

  bool operator==(const VolumeField& other) const { return image == other.image && name == other.name; }
};
inline constexpr std::size_t kMostFields = 4;  ///< of one picture, that of the context included

/// Who fills preintegrated tables (gpu_preintegration.h); the numbers are the same.
enum class TableMaker : std::uint8_t { kFaster, kProcessor, kGpu };
inline constexpr std::array<const char*, 3> kTableMakerNames{"faster", "processor", "gpu"};

struct VolumeView {
  std::shared_ptr<const VolumeImage> image;
  ColorTransfer transfer;
  std::optional<RegionTransfer> regions;  ///< in place of `transfer`, of value and gradient magnitude
  /// Beside `image`, by Lens::field less one; at most kMostFields - 1. Those that no lens shows take nothing.
  std::vector<VolumeField> fields;
  /// Length along which matter has the opacity of the transfer function [data units]; 0: a 512th of the
  /// diagonal, whatever the number of voxels.
  double opacity_length = 0.0;
  double samples_per_voxel = 4.0;  ///< > 0, along the ray, outside lenses
  /// >= 1: where the volume is farthest from the viewer samples are so many times as far apart as where it is
  /// nearest, in lenses too (Ikits 2006, ch. 9; shaders/volume/far.glsl). A context that is drawn alone has
  /// samples of its own.
  double far_sampling = 1.0;
  bool shading = true;  ///< Phong, with gradients of the values as normals
  bool shadows =
      false;  ///< where there is light: what lies between a place and it darkens the place, in lenses too
  /// Outside lenses: opacities by the angle between surface and ray (shaders/volume/illustration.glsl), silhouettes whole.
  bool illustrated = false;
  /// In [0, 1]: share of its opacity that matter before a lens on the ray loses, by that angle (same file).
  double context_fade = 0.0;
  bool colored = false;  ///< as Lens::colored, outside lenses
  bool shown = true;
  /// The first wins; at most kMostLenses, with kMostTransfers transfer functions between them and the
  /// context.
  std::vector<Lens> lenses;
  std::vector<CuttingPlane> cuts;  ///< at most kMostCuts
  PlaneImages planes;
  SlicePanes panes;  ///< beside the picture of the volume itself, which shows nothing of them
  std::vector<SliceImage> slice_images;  ///< that these may show, by SlicePanes::shown

  /// Entries of the preintegrated table an axis, and lengths: a multiple of 8.
  int table_entries = 256;
  int table_lengths = 32;
  bool preintegrate = true;  ///< false: tables of classify_fronts(), made by the processor
  TableMaker table_maker = TableMaker::kFaster;  ///< kGpu where the driver can
  bool skip_empty = true;  ///< leave out bricks in which nothing is seen; changes no pixel by 1/255
  /// Keep pictures of slabs while one cut moves (slab_cache.h); changes no pixel by 1/255.
  bool cache_slabs = true;
  /// Keep the picture of a volume that stands still, so that rays are cast anew only where opaque things move
  /// (cached_volume.h); changes no pixel by 1/255.
  bool cache_picture = false;
  ContextQuality context;  ///< samples_per_voxel are of voxels of its level
  VoxelStorage storage;
  bool stop_where_opaque = true;  ///< end rays that let less than 1/512 of the light through
};

/// Whether both give the same picture, by the same means but for cache_picture and table_maker; images count
/// as the same where they are the same objects.
[[nodiscard]] bool same_picture(const VolumeView& a, const VolumeView& b);

/// A transfer function and the field whose values it shows.
struct FieldTransfer {
  std::size_t field = 0;  ///< Lens::field
  ColorTransfer colors;
  std::optional<RegionTransfer> regions;  ///< in place of `colors`

  bool operator==(const FieldTransfer&) const = default;
};
/// Each has tables of its own on the GPU.
inline constexpr std::size_t kMostTransfers = 9;
/// What a lens shows. @pre lens.field <= view.fields.size().
[[nodiscard]] FieldTransfer transfer_of(const VolumeView& view, const Lens& lens);
/// The transfer functions of a view, each once: that of the context, then others of lenses.
[[nodiscard]] std::vector<FieldTransfer> transfers_of(const VolumeView& view);

/// The image of Lens::field. @pre field <= view.fields.size().
[[nodiscard]] const std::shared_ptr<const VolumeImage>& image_of(const VolumeView& view, std::size_t field);
/// Whether some lens shows that field, or it is that of the context.
[[nodiscard]] bool shows_field(const VolumeView& view, std::size_t field);
/// How many fields there are up to the last one that is shown: 1 where no lens has another than the context.
[[nodiscard]] std::size_t field_count(const VolumeView& view);
/// Whether some part is shown by value and gradient magnitude.
[[nodiscard]] bool has_regions(const VolumeView& view);

/// Whether some part takes its colours from the voxels; never where these have none.
[[nodiscard]] bool has_colored_parts(const VolumeView& view) noexcept;

/// Whether some part is drawn as lines are, or fades.
[[nodiscard]] bool has_illustration(const VolumeView& view) noexcept;

/// Whether the voxels of some field that is shown lie at uneven steps. Rays ask no tiles then, keep no slabs, and
/// join no samples far away.
[[nodiscard]] bool has_uneven_steps(const VolumeView& view);

/// Whether samples far from the viewer are fewer.
[[nodiscard]] bool samples_less_far(const VolumeView& view);

/// Whether some plane cuts.
[[nodiscard]] bool is_cut(const VolumeView& view);
/// Whether something is drawn on its planes.
[[nodiscard]] bool shows_planes(const VolumeView& view);
/// The grey values of its planes.
[[nodiscard]] ValueWindow window_of(const VolumeView& view);
/// What slices show, with the window that is chosen: one of `slice_images`, or the volume's own values.
[[nodiscard]] SliceImage shown_in_slices(const VolumeView& view);
/// Where plane `cut` meets the volume and is not cut away by the others, in data coordinates: corners in
/// order; empty where it is not seen. @pre view.image is not null.
[[nodiscard]] std::vector<Vec3> shown_section(const VolumeView& view, std::size_t cut);
/// Whether some lens enlarges.
[[nodiscard]] bool has_magnified_parts(const VolumeView& view);
/// Whether what lies outside lenses is a picture of its own: where there are some, quality is saved on it,
/// and its colours are not those of the voxels.
[[nodiscard]] bool draws_context_alone(const VolumeView& view);
/// Whether values go over at the border of some lens: where the context has voxels of its own.
[[nodiscard]] bool blends_values(const VolumeView& view);
/// Whether rays are asked by tiles of the picture where matter lies: not where it is seen elsewhere, and not
/// where values are seen that no fine voxel of the context's field has.
[[nodiscard]] bool asks_tiles(const VolumeView& view);

/// Length in data units that `view` uses for its opacities.
[[nodiscard]] double opacity_length_of(const VolumeView& view) noexcept;

}  // namespace palpate
