/// The model behind the window of cardiac: a heart, and one layer of it with its fibres.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/cardiac/beside_heart.h"
#include "apps/cardiac/heart_scene.h"
#include "apps/cardiac/wall_view.h"
#include "common/compose/input_model.h"
#include "common/trace/layer_fibre.h"
#include "common/window/panels/panel.h"

namespace palpate {

struct CardiacContent {
  OpenHeart heart;
  std::shared_ptr<WallPictures> walls = std::make_shared<WallPictures>();  ///< made when they are asked for
  std::shared_ptr<BesideHeart> beside = std::make_shared<BesideHeart>();
  std::uint64_t print =
      0;  ///< of what it was made from, so that other time steps know it again; 0: not taken
};

class CardiacModel final : public InputModel<CardiacContent> {
 public:
  CardiacModel(Document document, std::string program);

  void keep(const SceneView& view, Document& document) const override;

 private:
  [[nodiscard]] CardiacContent read(Input& input, const Document& document,
                                    Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const CardiacContent& content, const Document& document,
                                   const SceneState* before, Progress& progress) const override;
  [[nodiscard]] static SceneState present_bare(Input& input, const CardiacContent& content,
                                               const Document& document, const SceneState* before,
                                               Progress& progress);
  void complete(Document& document, Input& input, Progress& progress) const override;
};

[[nodiscard]] std::vector<PanelPart> cardiac_panels();

}  // namespace palpate
