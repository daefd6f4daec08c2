/// What the window needs of a program: opening inputs and making scenes of documents, behind plain values.
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

#include "common/base/late.h"
#include "common/base/progress.h"
#include "common/field/heart/regions.h"
#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/vector_field.h"
#include "common/geometry/line.h"
#include "common/load/write/image_origin.h"
#include "common/render/lens/lens.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"
#include "common/scene/input.h"
#include "common/trace/line_errors.h"

namespace palpate {

/// Files that are opened together, or a built-in example.
struct InputFiles {
  std::vector<std::filesystem::path> files;
  std::optional<std::filesystem::path> solution = {};  ///< PLOT3D
  std::string example = {};                            ///< in place of files
  std::filesystem::path session = {};   ///< by which they are shown, or in place of them: those that it names
  std::filesystem::path seeds = {};     ///< a table of places at which lines begin
  std::filesystem::path transfer = {};  ///< a transfer function of a volume
  std::string series = {};              ///< of a folder that holds several, as --series

  bool operator==(const InputFiles&) const = default;
};

/// What is known of an open input.
struct SceneInfo {
  std::string name;                       ///< file or example, for the title
  InputFiles files;                       ///< absolute paths
  std::vector<std::string> facts;         ///< one line each: "legacy VTK, 76x49x45 points", …
  std::vector<std::string> fields;        ///< vector fields that can be chosen
  std::vector<std::string> integrators;   ///< those that this grid can be traced with
  std::vector<std::string> color_arrays;  ///< arrays of the data and measures that can colour the lines
  std::vector<double> times;              ///< empty for a single state
  std::optional<ValueRange> layers;       ///< depths that a heart's wall has
  std::vector<RegionCount> regions;       ///< of a heart's mesh, chosen or not
  std::vector<std::string> plotted;       ///< scalars that can be plotted over time at the probe
  std::vector<std::string> volumes;       ///< scalars of a flow that can be drawn as a volume
  bool resampled = false;                 ///< these can be only where they are resampled
  InputOptions input;                     ///< to read them from; meaningless where there are none
  Box bounds;
  std::vector<std::vector<Vec3>> outline;  ///< edges of the domain; empty: those of `bounds`
  UnitNames units;
  bool anatomical = false;  ///< coordinates are RAS+
  ImageOrigin origin;       ///< of images that are made of it
};

struct BundleSet;  // bundle_view.h

/// Settings that mend what a note warns of, by name and text.
struct SceneFix {
  std::string note;
  std::vector<std::pair<std::string, std::string>> settings;
};

/// A scene with its lines, or its volume.
struct SceneState {
  std::shared_ptr<const SceneInfo> info;
  Document document;                                 ///< as used; what was left to a default is filled in
  std::shared_ptr<const std::vector<Line>> lines;    ///< never null
  std::shared_ptr<const VectorField> probed;         ///< the flow that the hand feels; null: none
  std::shared_ptr<const ScalarField> haptic_scalar;  ///< what modes of a scalar feel; null: the speed, if any
  std::shared_ptr<const TensorField> haptic_tensor;  ///< fibres that the hand feels; null: none
  std::string haptic_scalar_key;                     ///< tells it from other scalars of the same field
  /// What the document colours the lines by, where that is no quantity of theirs.
  std::shared_ptr<const LineArray> color_array;
  std::vector<SurfaceView> surfaces;         ///< drawn with the lines
  std::optional<ColorLens> color_lens;       ///< where the document has one
  std::optional<VolumeView> volume;          ///< in place of lines, or of a flow around them
  std::string volume_label;                  ///< what its values are
  std::vector<std::string> volume_notes;     ///< what resampling it cost, one line each
  std::optional<TensorView> tensors;         ///< likewise, also with a volume
  std::optional<TractView> tracts;           ///< through them
  std::shared_ptr<const BundleSet> bundles;  ///< that the document lists; null: none
  /// How a new lens shows what is in it, by Lens::field; its shape is none. Never empty with a volume.
  std::vector<Late<Lens>> appearances;
  /// Whether a volume of scalars is all that there is.
  [[nodiscard]] bool is_volume_alone() const { return volume && !tensors && !probed; }
  /// The one of a field that has none: as around lenses.
  [[nodiscard]] Lens appearance(std::size_t field) const {
    return field < appearances.size() ? appearances[field].get() : Lens();
  }
  std::array<std::size_t, kEndCount> ends{};
  std::size_t seeds = 0;  ///< those outside the domain too
  std::size_t outside_seeds = 0;
  std::size_t seeds_left_out = 0;  ///< that began no line, for want of memory
  std::string memory_note;         ///< which of `notes` says so; empty: none left out
  LineErrors line_errors;
  bool joined = false;  ///< of open(): the files came beside what was open, in place of nothing
  double seconds_load = 0.0;
  double seconds_trace = 0.0;
  std::vector<std::string> notes;           ///< what the user should know, one line each
  std::vector<SceneFix> fixes;              ///< of some of them
  std::vector<RegionView> regions;          ///< that tracts are traced by
  std::shared_ptr<const SceneView> beside;  ///< as SceneView
};

/// Takes the tables of seeds and colours into `document`.
/// @throws Error (usage) where programs of its kind, or what it shows, have no use for them.
void take_tables(const InputFiles& files, Document& document);

class WindowModel {
 public:
  WindowModel() = default;
  WindowModel(const WindowModel&) = delete;
  WindowModel& operator=(const WindowModel&) = delete;
  virtual ~WindowModel() = default;

  /// What the command line named.
  /// @throws Error, Cancelled.
  virtual SceneState start(Progress& progress) = 0;

  /// Opens another input, chosen in the window or dropped on it, with the program's own settings for a new one;
  /// before start() too. Or shows its files with what is open, where they belong beside it (SceneState::joined).
  /// @throws Error, Cancelled; what was open before then stays open.
  virtual SceneState open(const InputFiles& files, Progress& progress) = 0;

  /// The scene of the open input that `document` describes; only what changed is read or traced again.
  /// @throws Error, Cancelled; what was open before then stays open.
  virtual SceneState update(const Document& document, Progress& progress) = 0;

  /// Writes into `document` what `view` shows, as the program's settings say it: what mouse, hand and panels
  /// did to the picture. The inverse of what update() makes of them. Called on the window's thread, whatever
  /// job runs.
  virtual void keep(const SceneView& view, Document& document) const = 0;

  /// Saves the document as a session, in place of what `file` was.
  /// @return what was written, for the message line. @throws Error.
  virtual std::string save_session(const Document& document, const std::filesystem::path& file) = 0;

  /// Forgets what is open, and gives its memory back. Called while no job runs.
  virtual void close() = 0;
};

/// Which time step a document shows. @param times of the input.
[[nodiscard]] std::size_t time_step_of(const Document& document, const std::vector<double>& times);
/// Shows that one; nothing where there are no times.
void set_time_step(Document& document, const std::vector<double>& times, std::size_t step);

/// Whether both make the same scene, however that is drawn: the same input, lines, tracts, layer and volumes.
[[nodiscard]] bool same_scene(const Document& a, const Document& b);
/// Takes over of `used`, which made a scene, what that scene is made of: defaults are filled in there.
void take_scene(const Document& used, Document& document);

}  // namespace palpate
