/// What the window shows of a flow: its lines, traced on the window's background thread.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/compose/input_model.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// What is made of one field of a flow.
struct FlowContent {
  std::shared_ptr<const VectorField> field;
  std::shared_ptr<const SceneInfo> info;
  std::shared_ptr<const ScalarField> haptic;  ///< as `--scalar` names it; null: the default one
};

class FlowModel final : public InputModel<FlowContent> {
 public:
  FlowModel(Document document, std::string program);

  void keep(const SceneView& view, Document& document) const override;

 private:
  [[nodiscard]] FlowContent read(Input& input, const Document& document, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const FlowContent& content, const Document& document,
                                   const SceneState* before, Progress& progress) const override;
  void complete(Document& document, Input& input, Progress& progress) const override;
};

[[nodiscard]] std::vector<PanelPart> flow_panels();

}  // namespace palpate
