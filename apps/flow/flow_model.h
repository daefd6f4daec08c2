/// What the window shows of a flow: its lines, traced on the window's background thread.
#pragma once

#include <memory>
#include <string>

#include "common/compose/input_model.h"

namespace palpate {

/// What is made of one field of a flow.
struct FlowContent {
  std::shared_ptr<const VectorField> field;
  std::shared_ptr<const SceneInfo> info;
  std::shared_ptr<const ScalarField> felt;  ///< as `--scalar` names it; null: the default one
};

class FlowModel final : public InputModel<FlowContent> {
 public:
  FlowModel(Options options, std::string program);

  [[nodiscard]] std::string measured() const override;

 private:
  [[nodiscard]] FlowContent read(Input& input, const Options& options, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const FlowContent& content, const Options& options,
                                   const SceneSettings& settings, const SceneState* before,
                                   Progress& progress) const override;
  void begin(SceneSettings& settings, const Input& input, const Options& options) const override;
  void describe_session(Session& session, const InputSpec& spec, const Options& options,
                        const SceneSettings& settings, const SceneView& view) const override;
};

}  // namespace palpate
