/// What the window shows of diffusion tensors: their slices and tracts, made on the window's background
/// thread.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/compose/input_model.h"

namespace palpate {

/// The scene of one tensor image, all but the user's settings; without tensors where the input is something
/// else that is shown.
using DtmriContent = std::shared_ptr<const SceneState>;

class DtmriModel final : public InputModel<DtmriContent> {
 public:
  DtmriModel(Options options, std::string program);

 private:
  [[nodiscard]] DtmriContent read(Input& input, const Options& options, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const DtmriContent& content, const Options& options,
                                   const SceneSettings& settings, const SceneState* before,
                                   Progress& progress) const override;
  /// Tracts, and an image of one number a voxel, come beside what is open.
  [[nodiscard]] std::optional<SceneSettings> join(const InputFiles& files, const SceneSettings& now,
                                                  Progress& progress) const override;
  void begin(SceneSettings& settings, const Input& input, const Options& options) const override;
  void describe_session(Session& session, const InputSpec& spec, const Options& options,
                        const SceneSettings& settings, const SceneView& view) const override;
};

}  // namespace palpate
