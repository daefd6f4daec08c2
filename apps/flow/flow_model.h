/// What the window shows of a flow: opens inputs and traces lines on its background thread.
#pragma once

#include <optional>
#include <string>

#include "common/app/cli/options.h"
#include "common/app/window/window_model.h"
#include "common/scene/input.h"

namespace palpate {

class FlowModel final : public WindowModel {
 public:
  FlowModel(Options options, std::string program);

  SceneState start(Progress& progress) override;
  SceneState open(const std::vector<std::filesystem::path>& files, Progress& progress) override;
  SceneState update(const SceneSettings& settings, Progress& progress) override;
  std::string save_session(const SceneSettings& settings, const SceneView& view) override;

 private:
  /// An open input with the field that was made last.
  struct Scene {
    Input input;
    std::shared_ptr<const VectorField> field;
    std::shared_ptr<const SceneInfo> info;
    std::string field_label;
    std::size_t time_step = 0;
  };

  [[nodiscard]] static Scene load(const Options& options, Progress& progress);
  [[nodiscard]] SceneState trace(const Scene& scene, const Options& options, const SceneSettings& settings,
                                 Progress& progress) const;

  Options options_;
  std::string program_;
  std::optional<Scene> scene_;
};

}  // namespace palpate
