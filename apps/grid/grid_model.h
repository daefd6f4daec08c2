/// What the window shows of a volume: its voxels, read on the window's background thread.
#pragma once

#include <string>

#include "common/compose/input_model.h"
#include "common/compose/volume_scene.h"

namespace palpate {

/// What was read, and how.
struct GridContent {
  TangibleVolume volume;
  Resampling resampling;
};

class GridModel final : public InputModel<GridContent> {
 public:
  GridModel(Document document, std::string program);

  void keep(const SceneView& view, Document& document) const override;

 private:
  [[nodiscard]] GridContent read(Input& input, const Document& document, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const GridContent& content, const Document& document,
                                   const SceneState* before, Progress& progress) const override;
};

}  // namespace palpate
