/// What all verbs of cardiac make of an input: the heart, its long axis, angles along lines, and the scene of
/// one layer.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/cardiac/bare_heart.h"
#include "common/base/progress.h"
#include "common/field/heart/fibre_angles.h"
#include "common/geometry/line.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/scene/wall/heart_layer.h"
#include "common/trace/fibre_lines.h"
#include "common/trace/isosurface/isosurface_mesh.h"
#include "common/trace/layer_fibre.h"

namespace palpate {

/// Seeds and length [diagonals] of the fibres that are drawn on it: short ones, close together.
inline constexpr const char* kViewFibres = "random:2500";
inline constexpr double kViewFibreLength = 0.12;
/// Their step [diagonals]: every second one is a corner, some eight pixels apart in a picture of a thousand,
/// where a fibre that turns as tightly as the wall bends by some hundredths of a pixel.
inline constexpr double kViewFibreStep = 4e-3;

/// With the scalar that `--angle` names, where it is none of cardiac's own words.
/// @throws Error, Cancelled.
[[nodiscard]] std::shared_ptr<const LayeredHeart> load_layered_heart(Input& input,
                                                                     const HeartOptions& options, int threads,
                                                                     Progress* progress);

/// What a heart is shown as: exactly one is not null.
struct OpenHeart {
  std::shared_ptr<const LayeredHeart> layered;
  std::shared_ptr<const BareHeart> bare;
  std::vector<std::string> notes;
};
/// Of all that the heart is made of, at the input's time step, so that other steps know it again; never 0.
/// @throws Error, Cancelled.
[[nodiscard]] std::uint64_t fingerprint(Input& input, Progress* progress);
/// Without layers where there are no fibres, no volume or no two sides of the wall.
/// @throws Error, Cancelled.
[[nodiscard]] OpenHeart open_heart(Input& input, int threads, Progress* progress);

/// `--axis`, or the axis of the file's coordinates, or as the wall opens.
/// @throws Error (usage) where it is no direction, or is not given for a closed wall.
[[nodiscard]] Vec3 axis_of(const HeartOptions& options, const Heart& heart);

/// What `--angle` names, at a place. The directions of sheets are looked up for sheet angles only.
class AngleProbe {
 public:
  /// @param value the scalar that is named, on the heart's mesh; null: Heart::value.
  /// @throws Error (usage) where the convention does not define the angle, sheets are not known, or there is
  /// no axis.
  AngleProbe(std::shared_ptr<const LayeredHeart> heart, const HeartOptions& options,
             const std::shared_ptr<const ScalarField>& value = nullptr);
  /// Degrees, a number without a unit for "gap" and "depth", or the value of a scalar of the file; NaN where
  /// it is not defined.
  /// @param x data coordinates.
  [[nodiscard]] double at(const Vec3& x, CellHint& hint) const;
  [[nodiscard]] const std::string& name() const noexcept { return options_.angle; }
  /// Of the points of the heart's mesh.
  [[nodiscard]] std::vector<double> map() const;
  /// Zero where it is not asked for.
  [[nodiscard]] const Vec3& axis() const noexcept { return axis_; }
  /// Whether it is one of the three angles.
  [[nodiscard]] bool is_angle() const noexcept { return angle_.has_value(); }

 private:
  std::shared_ptr<const LayeredHeart> heart_;
  HeartOptions options_;
  std::shared_ptr<const ScalarField> value_;
  std::optional<WallAngle> angle_;
  AngleConvention convention_ = AngleConvention::kStreeter;
  Vec3 axis_{0.0};
};

/// Its values at the points of the lines, line after line.
[[nodiscard]] std::vector<double> angles_along(const AngleProbe& probe, const std::vector<Line>& lines,
                                               int threads);

/// The same at places in data coordinates.
[[nodiscard]] std::vector<double> values_at(const AngleProbe& probe, const std::vector<Vec3>& places,
                                            int threads);

/// A layer as lines and triangles, whatever colours them.
struct LayerGeometry {
  double depth = 0.0;
  FibreLineResult fibres;                          ///< its lines are in `lines`
  std::size_t seeds = 0;                           ///< each with a line both ways
  std::shared_ptr<const std::vector<Line>> lines;  ///< cut
  std::shared_ptr<const IsosurfaceMesh> mesh;      ///< cut
};

/// The triangles of a layer. @throws Error (usage) where it is none of the wall's; Cancelled.
[[nodiscard]] IsosurfaceMesh layer_mesh(const LayeredHeart& heart, double depth, Progress* progress);

/// @param settings of tracing; zeros and empty words stand for the view's own defaults.
/// @throws Error, Cancelled.
[[nodiscard]] LayerGeometry make_layer_geometry(const LayeredHeart& heart, const Document& options,
                                                Progress* progress);

/// What colours a layer: numbers of its lines and of its triangles' corners, and how they are shown.
struct LayerColors {
  LineStyle style;  ///< with the array of the lines
  std::shared_ptr<const std::vector<float>> values;
  std::shared_ptr<const AngleProbe> probe;  ///< what gave them, for other places
};

/// @param options which angle or scalar; that of the file is read at the input's time step.
/// @param before what coloured this heart at another time step; the range of all steps goes on from it
/// (default_appearance.h). Null: nothing.
/// @throws Error, Cancelled.
[[nodiscard]] LayerColors color_layer(Input& input, const std::shared_ptr<const LayeredHeart>& heart,
                                      const LayerGeometry& layer, const HeartOptions& options, int threads,
                                      const LineArray* before = nullptr);

/// @param contours distance of lines of equal value; 0: none.
[[nodiscard]] SurfaceView surface_of(const LayerGeometry& layer, const LayerColors& colors, double contours);

[[nodiscard]] UnitNames units_of(const Input& input);

/// `--lens` as a ball; its style is that of no colours yet. @throws Error (usage).
[[nodiscard]] std::optional<ColorLens> lens_of(const HeartOptions& options);

/// A layer with its fibres, as options say.
struct LayerScene {
  SceneView view;
  LayerGeometry layer;
};

/// @throws Error, Cancelled.
[[nodiscard]] LayerScene make_layer_scene(Input& input, const std::shared_ptr<const LayeredHeart>& heart,
                                          const Document& options, double aspect, Progress* progress);

}  // namespace palpate
