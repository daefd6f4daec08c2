/// The model behind the window of cardiac: a heart, and one layer of it with its fibres.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "apps/cardiac/heart_scene.h"
#include "common/compose/input_model.h"
#include "common/trace/layer_fibre.h"

namespace palpate {

struct CardiacContent {
  std::shared_ptr<const LayeredHeart> heart;
  std::uint64_t print =
      0;  ///< of what it was made from, so that other time steps know it again; 0: not taken
};

class CardiacModel final : public InputModel<CardiacContent> {
 public:
  CardiacModel(Options options, std::string program);

 private:
  [[nodiscard]] CardiacContent read(Input& input, const Options& options, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const CardiacContent& content, const Options& options,
                                   const SceneSettings& settings, const SceneState* before,
                                   Progress& progress) const override;
  void complete(Options& options, Input& input, Progress& progress) const override;
  void begin(SceneSettings& settings, const Input& input, const Options& options) const override;
  void describe_session(Session& session, const InputSpec& spec, const Options& options,
                        const SceneSettings& settings, const SceneView& view) const override;
};

}  // namespace palpate
