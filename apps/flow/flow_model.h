/// What the window shows of a flow: opens inputs and traces lines on its background thread.
#pragma once

#include <optional>
#include <string>

#include "common/app/cli/options.h"
#include "common/app/window/window_model.h"
#include "common/scene/input.h"
#include "common/scene/plan.h"

namespace palpate {

class FlowModel final : public WindowModel {
 public:
  FlowModel(Options options, std::string program);

  SceneState start(Progress& progress) override;
  SceneState open(const InputFiles& files, Progress& progress) override;
  SceneState update(const SceneSettings& settings, Progress& progress) override;
  std::string save_session(const SceneSettings& settings, const SceneView& view,
                           const std::vector<std::pair<std::string, std::string>>& touch) override;

  /// What was shown last took; empty where nothing was.
  [[nodiscard]] std::vector<MeasuredCost> costs() const;

 private:
  /// An open input with the field that was made last.
  struct Scene {
    Input input;
    std::shared_ptr<const VectorField> field;
    std::shared_ptr<const SceneInfo> info;
    std::string field_label;
    std::size_t time_step = 0;
    std::shared_ptr<const ScalarField> felt;  ///< as `--scalar` names it; null: the default one
    SceneState shown;                         ///< the lines that were traced last
  };

  /// Reads the scalar that the hand feels, if one was named.
  static void choose_felt(Scene& scene, const Options& options, Progress& progress);
  [[nodiscard]] static Scene load(const Options& options, Progress& progress);
  [[nodiscard]] static SceneState trace(const Scene& scene, const Options& options,
                                        const SceneSettings& settings, Progress& progress);
  /// Samples settings.color_array along the lines of `state`.
  static void color(Scene& scene, const Options& options, SceneState& state, Progress& progress);
  /// Both, for a scene that was just opened with `options`; keeps the scene.
  SceneState show(Scene scene, const Options& options, const std::string& color_array, Progress& progress);

  Options options_;
  std::string program_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
