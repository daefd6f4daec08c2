/// What the window needs of a program: opening inputs, tracing lines and reading volumes, behind plain
/// values.
///
/// The window calls these functions on a background thread, one at a time; the picture goes on meanwhile.
/// What they return is immutable. Words are those of the command line (design: command line).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/vector_field.h"
#include "common/geometry/line.h"
#include "common/render/lens/lens.h"
#include "common/render/scene_view.h"
#include "common/scene/input.h"

namespace palpate {

/// Files that are opened together.
struct InputFiles {
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> solution;  ///< PLOT3D

  bool operator==(const InputFiles&) const = default;
};

/// What the panel can change about the lines.
struct SceneSettings {
  std::string field;                ///< one of SceneInfo::fields
  std::vector<std::string> beside;  ///< of a volume: other scalars, for lenses (InputSpec::beside)
  std::size_t time_step = 0;        ///< index into SceneInfo::times
  std::string integrator;           ///< "dp54"; empty: the default for the grid
  std::string seeds;                ///< grammar of --seeds: "grid:8,8,8"
  std::string direction = "both";   ///< forward, backward, both
  double tolerance = 1e-6;
  double step = 0.0;        ///< as --step; 0: the default
  double max_length = 0.0;  ///< data units; 0: the default
  std::uint64_t random_seed = 1;
  int seeds_per_voxel = 1;  ///< of tracts, as --seeds-per-voxel; `seeds` is empty where none are wanted
  double cutoff = 0.2;      ///< of tracts, as --cutoff
  std::string tracts;       ///< a file of tracts, as --tracts; empty where they are traced, or none are there
  std::string underlay;     ///< a scalar image below slices, as --underlay; empty: none
  std::string color_array;  ///< one of SceneInfo::color_arrays; empty: a quantity of the lines colours them
  double layer = 0.5;       ///< of a heart: the depth that is shown
  double contours = 0.0;    ///< of a heart: distance of lines of equal value on the layer; 0: none
  /// Of a heart: what is not in it is left out of the picture, as --cut; none: nothing is.
  std::optional<ConvexShape::HalfSpace> cut;
  std::string lens_array;  ///< of a heart: what a lens shows in place of color_array; empty: there is none
  /// Of a flow: scalars that are a volume around the lines, as --volume; the first one is seen around lenses,
  /// none: no volume.
  std::vector<std::string> volumes;
  std::string resample;  ///< of those, as --resample; empty: at the points of an image
  std::string transfer;  ///< of a volume, as --transfer-function; empty: from the histogram
  std::string focus;     ///< of lenses, as --focus-tf; empty: the model's own

  bool operator==(const SceneSettings&) const = default;
};

/// What is known of an open input.
struct SceneInfo {
  std::string name;                       ///< file or example, for the title
  InputFiles files;                       ///< absolute paths; none of an example
  std::vector<std::string> facts;         ///< one line each: "legacy VTK, 76x49x45 points", …
  std::vector<std::string> fields;        ///< vector fields that can be chosen
  std::vector<std::string> integrators;   ///< those that this grid can be traced with
  std::vector<std::string> color_arrays;  ///< arrays of the data and measures that can colour the lines
  std::vector<double> times;              ///< empty for a single state
  std::optional<ValueRange> layers;       ///< depths that a heart's wall has
  std::vector<std::string> plotted;       ///< scalars that can be plotted over time at the probe
  std::vector<std::string> volumes;       ///< scalars of a flow that can be drawn as a volume
  bool resampled = false;                 ///< these can be only where they are resampled
  InputSpec input;                        ///< to read them from; meaningless where there are none
  Box bounds;
  std::vector<std::vector<Vec3>> outline;  ///< edges of the domain; empty: those of `bounds`
  UnitNames units;
  bool anatomical = false;  ///< coordinates are RAS+
};

/// A scene with its lines, or its volume.
struct SceneState {
  std::shared_ptr<const SceneInfo> info;
  SceneSettings settings;                          ///< as used; what was left to a default is filled in
  std::shared_ptr<const std::vector<Line>> lines;  ///< never null
  std::shared_ptr<const VectorField> probed;       ///< the flow that the hand feels; null: none
  std::shared_ptr<const ScalarField> felt_scalar;  ///< what modes of a scalar feel; null: the speed, if any
  std::shared_ptr<const TensorField> felt_tensor;  ///< fibres that the hand feels; null: none
  std::string felt_scalar_key;                     ///< tells it from other scalars of the same field
  std::shared_ptr<const LineArray> color_array;    ///< settings.color_array along the lines, or null
  std::vector<SurfaceView> surfaces;               ///< drawn with the lines
  std::optional<ColorLens> color_lens;             ///< where the settings want one; its ball is the first one
  std::optional<LineStyle> style;                  ///< of the lines at the start; none: the window's
  std::optional<VolumeView> volume;                ///< in place of lines, or of a flow around them
  std::string volume_label;                        ///< what its values are
  std::vector<std::string> volume_notes;           ///< what resampling it cost, one line each
  std::optional<TensorView> tensors;               ///< likewise, also with a volume
  std::optional<TractView> tracts;                 ///< through them
  /// How a new lens shows what is in it, by Lens::field; its shape is none. Never empty with a volume.
  std::vector<Lens> looks;
  /// Whether a volume of scalars is all that there is.
  [[nodiscard]] bool is_volume_alone() const { return volume && !tensors && !probed; }
  /// The one of a field that has none: as around lenses.
  [[nodiscard]] Lens look(std::size_t field) const { return field < looks.size() ? looks[field] : Lens(); }
  std::array<std::size_t, kEndCount> ends{};
  std::size_t seeds = 0;  ///< those outside the domain too
  std::size_t outside_seeds = 0;
  double error_max = 0.0;  ///< data units
  bool joined = false;     ///< of open(): the files came beside what was open, in place of nothing
  double seconds_load = 0.0;
  double seconds_trace = 0.0;
  std::vector<std::string> notes;  ///< what the user should know, one line each
};

class WindowModel {
 public:
  WindowModel() = default;
  WindowModel(const WindowModel&) = delete;
  WindowModel& operator=(const WindowModel&) = delete;
  virtual ~WindowModel() = default;

  /// What the command line named.
  /// @throws Error, Cancelled.
  virtual SceneState start(Progress& progress) = 0;

  /// Opens other files, dropped on the window or opened before, with the program's own settings for a new
  /// input; or shows them with what is open, where they belong beside it (SceneState::joined).
  /// @throws Error, Cancelled; what was open before then stays open.
  virtual SceneState open(const InputFiles& files, Progress& progress) = 0;

  /// Lines of the open input with other settings; only what changed is read or traced again.
  /// @throws Error, Cancelled; what was open before then stays open.
  virtual SceneState update(const SceneSettings& settings, Progress& progress) = 0;

  /// Saves scene, view and what the window has set beside the input.
  /// @param set options of the command line and their values: of touch, of playing and of what is plotted.
  /// @return what was written, for the message line.
  /// @throws Error.
  virtual std::string save_session(const SceneSettings& settings, const SceneView& view,
                                   const std::vector<std::pair<std::string, std::string>>& set) = 0;

  /// A line on what the scene shown last took, for `--explain`; empty where nothing was or it is not known.
  [[nodiscard]] virtual std::string measured() const { return {}; }
};

}  // namespace palpate
