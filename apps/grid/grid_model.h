/// What the window shows of a volume: opens inputs and reads voxels on its background thread.
#pragma once

#include <optional>
#include <string>

#include "common/app/cli/options.h"
#include "common/app/cli/volume_scene.h"
#include "common/app/window/window_model.h"
#include "common/scene/input.h"

namespace palpate {

class GridModel final : public WindowModel {
 public:
  GridModel(Options options, std::string program);

  SceneState start(Progress& progress) override;
  SceneState open(const InputFiles& files, Progress& progress) override;
  SceneState update(const SceneSettings& settings, Progress& progress) override;
  std::string save_session(const SceneSettings& settings, const SceneView& view,
                           const std::vector<std::pair<std::string, std::string>>& touch) override;

 private:
  /// An open input with the voxels that were read last.
  struct Scene {
    Input input;
    TangibleVolume volume;
    SceneState shown;
  };

  /// Opens what `options` name and keeps it.
  SceneState show(const Options& options, Progress& progress);
  /// The scene of `volume` with its transfer function.
  [[nodiscard]] static SceneState describe(const Input& input, const Options& options,
                                           const SceneSettings& settings, const TangibleVolume& volume);

  Options options_;
  std::string program_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
