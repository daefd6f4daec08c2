/// What a picture shows, as plain data: the same description makes the window's picture and the one
/// that is drawn without a display.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/line.h"
#include "common/math/vec.h"
#include "common/render/camera.h"
#include "common/render/label/label_view.h"
#include "common/render/line_style.h"
#include "common/render/probe_view.h"
#include "common/render/slice/slice_view.h"
#include "common/render/stereo/stereo_view.h"
#include "common/render/surface/surface_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/render/tract/tract_bundle.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// sRGB; a gradient between the two.
struct Background {
  Rgb top, bottom;

  static const Background kDark, kLight;

  /// Whether dark words stand out from it more than light ones.
  [[nodiscard]] bool is_light() const noexcept;
  bool operator==(const Background&) const = default;
};
inline constexpr Background Background::kDark{{0.125F, 0.135F, 0.150F}, {0.055F, 0.060F, 0.068F}};
inline constexpr Background Background::kLight{{1.0F, 1.0F, 1.0F}, {0.955F, 0.960F, 0.968F}};

/// Something that is marked in the data: drawn over everything, in colours that stand out from it.
struct NoteView {
  std::vector<Vec3> points;
  std::vector<Vec3> outline;  ///< may be empty
  std::string words;          ///< beside its middle

  bool operator==(const NoteView&) const = default;
};

/// A region that is outlined in slices and in the scene.
struct RegionView {
  std::vector<ConvexShape> shapes;  ///< it is all of them together
  Rgb color;

  bool operator==(const RegionView&) const = default;
};

/// A ball in which lines and coloured surfaces show another number than around it.
struct ColorLens {
  Vec3 center{0.0};
  double radius = 0.0;  ///< data units
  LineStyle style;      ///< what it shows: array, range and map

  bool operator==(const ColorLens&) const = default;
};

struct SceneView {
  Box bounds;                                      ///< of the domain
  std::shared_ptr<const std::vector<Line>> lines;  ///< may be null
  /// Edges of the domain; where empty, those of `bounds`.
  std::vector<std::vector<Vec3>> outline;
  LineStyle style;
  UnitNames units;
  Background background = Background::kDark;
  bool show_outline = true;
  bool show_axes = true;
  bool show_color_bar = true;
  bool color_bar_left = false;  ///< colour bars and legends are at the left border
  bool show_scale_bar = false;  ///< of a round length, of what lies in the plane of the focal point
  std::string caption;          ///< words at the lower border, in the middle; empty: none
  std::string title;            ///< top left; empty: none
  std::string subtitle;         ///< smaller, below it
  Camera camera;
  double aspect =
      1.5;  ///< width / height of the window's picture, for one eye, for which a kept zoom is stated
  StereoView stereo;  ///< of a perspective camera; an orthographic one has one eye
  std::optional<ProbeView> probe;
  std::vector<SurfaceView> surfaces;
  std::optional<ColorLens> color_lens;
  std::optional<VolumeView> volume;
  std::optional<SliceView> slice;  ///< of an orthographic camera: what all else lies before
  std::optional<TensorView> tensors;
  std::optional<TractView> tracts;
  std::vector<NoteView> notes;
  std::vector<RegionView> regions;
  std::vector<LabelView> labels;  ///< menus and words in space
  std::string volume_label;       ///< what its values are, for the colour bar
  bool anatomical = false;        ///< data coordinates are RAS+: letters say where right, front and up are
  /// Another scene, in the right half of the picture (beside_view()), but not for two eyes; null: none.
  std::shared_ptr<const SceneView> beside;
};

/// Whether both give the same picture; lines and arrays count as the same where they are the same objects.
[[nodiscard]] bool same_picture(const SceneView& a, const SceneView& b);

/// Whether it is drawn for two eyes: an orthographic camera has one.
[[nodiscard]] bool has_two_eyes(const SceneView& view) noexcept;

/// Of lengths in the picture; empty where it is not known.
[[nodiscard]] std::string length_unit(const SceneView& view);

/// Whether both show the same tensors in the same way.
[[nodiscard]] bool same_tensors(const SceneView& a, const SceneView& b);

/// An image: `rgba` has 4 * width * height bytes, sRGB, rows from the top.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgba;

  /// @pre 0 <= x < width, 0 <= y < height.
  [[nodiscard]] std::array<int, 4> pixel(int x, int y) const noexcept;
};

}  // namespace palpate
