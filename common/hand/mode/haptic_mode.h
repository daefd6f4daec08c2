/// A way of feeling data, as `--mode` and the window's keys name it.
#pragma once

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/vector_field.h"
#include "common/hand/mode/fixture.h"
#include "common/haptics/proxy_chain.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/haptics/workspace.h"
#include "common/scene/input.h"
#include "common/trace/live_line.h"

namespace palpate {

/// A chain that is ready for the servo, and what is to be drawn of it.
struct HapticChain {
  std::unique_ptr<ProxyChain> chain;
  std::shared_ptr<const LiveLine> followed;  ///< null where the mode follows no line
  /// Whose isosurfaces are felt, at ChainSettings::isosurface or where that has none at `isovalues`; null
  /// where none are.
  std::shared_ptr<const ScalarField> surfaces_of = nullptr;
  Isovalues isovalues = {};
  std::shared_ptr<WidgetNewsBuffer> planes =
      nullptr;  ///< cutting planes that the hand moves; null where none
  std::shared_ptr<const ScalarField> noise = nullptr;  ///< that is felt as a texture; null where none is
  std::vector<Vec4> landmarks = {};  ///< of a grid: planes n, d with n.x = d in data coordinates
  std::string note = {};             ///< what the user is to know of what is felt; empty: nothing
  FixtureList fixtures = {};         ///< around it
};

/// What a chain is built over.
struct HapticScene {
  std::shared_ptr<const VectorField> field;  ///< null for volumes of scalars and tensors
  Workspace workspace;
  ChainSettings settings;
  int threads = 0;                            ///< for the preparation; 0: all cores
  std::shared_ptr<const ScalarField> scalar;  ///< what modes of a scalar work on; null where there is none
  std::shared_ptr<const TensorField> tensor = nullptr;  ///< of an image of tensors, else null
  std::shared_ptr<const ScalarField> noise = nullptr;  ///< of `scalar`; null: it is measured where it is felt
  FixtureList fixtures = {};
};

/// The frame of the fields that are there. @pre One of them is.
[[nodiscard]] inline const LocalFrame& frame_of(const VectorField* field, const ScalarField* scalar,
                                                const TensorField* tensor) noexcept {
  if (tensor != nullptr) return tensor->frame();
  return field != nullptr ? field->frame() : scalar->frame();
}

/// @name Modes that settings, panels and summaries name.
/// @{
inline constexpr const char* kDensityMode = "density";
inline constexpr const char* kGridMode = "grid";
inline constexpr const char* kIsosurfaceMode = "isosurface";
inline constexpr const char* kLinearMode = "linear";
inline constexpr const char* kPlaneWidgetMode = "plane-widget";
/// @}

/// A row of modes.def.
struct HapticMode {
  std::string name;     ///< "streamline"
  std::string summary;  ///< what the hand feels, for help and panels
  /// Builds the chain, without fixtures (make_chain()); allocates all that the servo will need.
  std::function<HapticChain(const HapticScene&)> make;
  std::vector<FieldKind> fields = {};  ///< kinds of field that can be felt so
  bool texture = false;                ///< appends a texture by noise where one is asked for
};

/// The modes by which fields of a kind are felt, the default one first.
[[nodiscard]] std::vector<HapticMode> modes_of(FieldKind kind);

/// The chain of a mode with the fixtures of `scene` around it.
[[nodiscard]] HapticChain make_chain(const HapticMode& mode, const HapticScene& scene);

/// A chain of one link with the settings of `scene`.
[[nodiscard]] HapticChain chain_of(std::unique_ptr<Constraint> link, const HapticScene& scene);
/// scene.scalar, or the speed of the flow where no scalar was chosen. @pre There is one of them.
[[nodiscard]] std::shared_ptr<const ScalarField> scalar_or_speed(const HapticScene& scene);

/// @param name empty: the first of `modes`, the default one.
/// @throws Error (usage) that lists the known modes.
[[nodiscard]] const HapticMode& find_mode(std::span<const HapticMode> modes, const std::string& name);

/// The time of the flow between tick marks that puts them 10 mm apart where it is fastest [data units].
[[nodiscard]] double default_tick_interval(const VectorField& field, const Workspace& workspace) noexcept;

}  // namespace palpate
