/// What the window shows of a volume: its voxels, read on the window's background thread.
#pragma once

#include <string>

#include "common/compose/input_model.h"
#include "common/compose/volume_scene.h"

namespace palpate {

class GridModel final : public InputModel<TangibleVolume> {
 public:
  GridModel(Options options, std::string program);

 private:
  [[nodiscard]] TangibleVolume read(Input& input, const Options& options, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const TangibleVolume& volume, const Options& options,
                                   const SceneSettings& settings, const SceneState* before,
                                   Progress& progress) const override;
  void begin(SceneSettings& settings, const Input& input, const Options& options) const override;
  void describe_session(Session& session, const InputSpec& spec, const Options& options,
                        const SceneSettings& settings, const SceneView& view) const override;
};

}  // namespace palpate
