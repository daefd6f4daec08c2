/// What the window shows of diffusion tensors: opens inputs and makes their fields on its background thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/app/cli/options.h"
#include "common/app/window/window_model.h"
#include "common/scene/input.h"

namespace palpate {

class DtmriModel final : public WindowModel {
 public:
  DtmriModel(Options options, std::string program);

  SceneState start(Progress& progress) override;
  SceneState open(const InputFiles& files, Progress& progress) override;
  SceneState update(const SceneSettings& settings, Progress& progress) override;
  std::string save_session(const SceneSettings& settings, const SceneView& view,
                           const std::vector<std::pair<std::string, std::string>>& touch) override;

 private:
  /// An open input with the tensors that were read last.
  struct Scene {
    Input input;
    SceneState shown;
  };

  /// Opens what `options` name and keeps it.
  SceneState show(const Options& options, Progress& progress);
  /// Reads the field that the input's spec names, and describes it.
  [[nodiscard]] static SceneState read(Input& input, const Options& options, const SceneSettings& settings,
                                       Progress& progress);

  Options options_;
  std::string program_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
