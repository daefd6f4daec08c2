/// Slices through a volume beside it, as plain data: how a picture is divided into panes, and what one pane shows.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/value_histogram.h"
#include "common/math/quaternion.h"
#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// What is made of the values through the thickness of a slab.
enum class SlabRule : std::uint8_t { kMean, kHighest, kLowest };
inline constexpr std::array<std::string_view, 3> kSlabRuleNames{"mean", "mip", "minip"};

/// Three planes at right angles through one place; the number is that of the axis that each is across.
enum class SlicePlane : std::uint8_t { kSagittal, kCoronal, kAxial };
inline constexpr std::array<std::string_view, 3> kSlicePlaneNames{"sagittal", "coronal", "axial"};

/// The panes of a picture.
///
///   n_p = turn e_p    normal of plane p                                                        (1)
struct SlicePanes {
  int layout = 1;                         ///< 1: the volume alone; 2: a slice and the volume; 4: three slices
  SlicePlane first = SlicePlane::kAxial;  ///< the one of layout 2
  Vec3 cross{0.0};                        ///< all three planes go through it, data coordinates
  Quat turn{1.0, 0.0, 0.0, 0.0};          ///< unit; the identity: along the axes of the data
  Vec3 center{0.0};                       ///< in the middle of the panes, data coordinates
  double zoom = 1.0;                      ///< > 0; 1 shows all of the volume
  double slab = 0.0;                      ///< thickness [data units]; 0: the plane alone
  SlabRule rule = SlabRule::kMean;
  bool radiological = true;  ///< a patient's right is on the left
  double blend = 0.0;        ///< in [0, 1]: opacity of the second scalar over the first one
  std::string shown;         ///< name of one of VolumeView::slice_images; empty: the volume's own values
  std::optional<ValueWindow> window;  ///< of that image; absent: as it has it

  std::optional<Box> box;  ///< a region of interest, outlined

  friend bool operator==(const SlicePanes& a, const SlicePanes& b) {
    return a.layout == b.layout && a.first == b.first && a.cross == b.cross && a.turn == b.turn &&
           a.center == b.center && a.zoom == b.zoom && a.slab == b.slab && a.rule == b.rule &&
           a.radiological == b.radiological && a.blend == b.blend && a.shown == b.shown &&
           a.window == b.window && same_box(a.box, b.box);
  }

 private:
  static bool same_box(const std::optional<Box>& a, const std::optional<Box>& b) {
    return a.has_value() == b.has_value() && (!a || (a->lower == b->lower && a->upper == b->upper));
  }
};

/// What slices may show in place of a volume's own values.
struct SliceImage {
  std::string name;
  std::shared_ptr<const VolumeImage> image;  ///< not null
  ValueWindow window;                        ///< of black and white, where none is chosen
  bool colored = false;                      ///< the colours of the image, as bright as its values

  bool operator==(const SliceImage&) const = default;
};

/// A second image over the first one, in colours.
struct SliceBlend {
  std::shared_ptr<const VolumeImage> image;
  std::string name;
  ValueWindow window;  ///< from clear to the last colour
  ColorMap map = ColorMap::kHeat;
  /// From `window` up; lower values are clearer, in proportion; of labels, of all of them.
  double opacity = 0.0;

  bool operator==(const SliceBlend&) const = default;
};

/// A line that is drawn over a slice.
struct SliceTrace {
  std::vector<Vec3> points;  ///< in the plane, data coordinates
  Rgb color;

  bool operator==(const SliceTrace&) const = default;
};

/// A slice as the background of a picture: where the plane through the focal point of an orthographic camera,
/// across its line of sight, cuts the volume. Labels have their colours, and no slab. What the slab reaches lies half before and half behind it.
struct SliceView {
  std::shared_ptr<const VolumeImage> image;
  ValueWindow window;    ///< of black and white
  bool colored = false;  ///< SliceImage::colored: grey (1) of slice_raster.h times the colour
  double slab = 0.0;
  SlabRule rule = SlabRule::kMean;
  int most_planes = 0;  ///< that stand for the slab, while something moves; 0: as many as it takes
  std::optional<SliceBlend> blend;
  /// Planes that cross this one, and what else has an outline in it.
  std::vector<SliceTrace> traces;

  bool operator==(const SliceView&) const = default;
};

}  // namespace palpate
