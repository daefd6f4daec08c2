/// What the window shows of a volume: its voxels, read on the window's background thread.
#pragma once

#include <string>

#include "common/compose/input_model.h"
#include "common/compose/volume_scene.h"

namespace palpate {

class GridModel final : public InputModel<TangibleVolume> {
 public:
  GridModel(Document document, std::string program);

  void keep(const SceneView& view, Document& document) const override;

 private:
  [[nodiscard]] TangibleVolume read(Input& input, const Document& document,
                                    Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const TangibleVolume& volume, const Document& document,
                                   const SceneState* before, Progress& progress) const override;
};

}  // namespace palpate
