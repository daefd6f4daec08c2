/// What the window shows of diffusion tensors: their slices and tracts, made on the window's background
/// thread.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/dtmri/tract_request.h"
#include "common/compose/input_model.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// The scene of one tensor image, all but the user's settings; without tensors where the input is something
/// else that is shown.
struct DtmriScene {
  SceneState state;
  std::optional<DataArray> cones;    ///< of the voxels [degrees]; none: the tensors were not fitted
  std::optional<ViewTracts> tracts;  ///< that the input holds in place of tensors
  std::shared_ptr<const TensorVoxels> lattice;  ///< of these tracts, where no image says where voxels lie
};
using DtmriContent = std::shared_ptr<const DtmriScene>;

class DtmriModel final : public InputModel<DtmriContent> {
 public:
  DtmriModel(Document document, std::string program);

  void keep(const SceneView& view, Document& document) const override;

 private:
  [[nodiscard]] DtmriContent read(Input& input, const Document& document, Progress& progress) const override;
  [[nodiscard]] SceneState present(Input& input, const DtmriContent& content, const Document& document,
                                   const SceneState* before, Progress& progress) const override;
  /// Tracts, and an image of one number a voxel, come beside what is open.
  [[nodiscard]] std::optional<Document> join(const InputFiles& files, const Document& now,
                                             Progress& progress) const override;
};

[[nodiscard]] std::vector<PanelPart> dtmri_panels();

}  // namespace palpate
