/// What the window shows of a heart: a layer with its fibres, made on the window's background thread.
#pragma once

#include <memory>
#include <string>

#include "common/app/cli/input_model.h"
#include "common/trace/layer_fibre.h"

namespace palpate {

using CardiacContent = std::shared_ptr<const LayeredHeart>;

class CardiacModel final : public InputModel<CardiacContent> {
 public:
  CardiacModel(Options options, std::string program);

 private:
  [[nodiscard]] CardiacContent read(Input& input, const Options& options, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const CardiacContent& heart, const Options& options,
                                   const SceneSettings& settings, const SceneState* before,
                                   Progress& progress) const override;
  void begin(SceneSettings& settings, const Input& input, const Options& options) const override;
  void describe_session(Session& session, const InputSpec& spec, const Options& options,
                        const SceneSettings& settings, const SceneView& view) const override;
};

}  // namespace palpate
