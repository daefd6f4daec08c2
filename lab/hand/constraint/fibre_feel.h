/// What a hand feels of a heart: how well its proxies keep to layers, what a step costs, and the friction of
/// fibres that leave their layer (Ikits 2006, eqs. 8.1 and 8.2 as corrected).
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/base/progress.h"
#include "common/haptics/constraint/fibre_groove.h"
#include "common/haptics/constraint/layer.h"
#include "common/haptics/proxy_chain.h"
#include "common/trace/layer_fibre.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/hand/streamline_run.h"
#include "lab/page/section.h"

namespace palpate {

/// A stroke over a heart with the chain of layer, groove and friction.
struct FibreFeel {
  std::size_t steps = 0, held = 0;
  double off_layer = 0.0;      ///< largest distance of any proxy from its layer [diagonals]
  double off_threshold = 0.0;  ///< largest difference of the drag threshold from (8.1) [mm]
  StepErrors microseconds;     ///< of a step, this thread's processor time
  double p999 = 0.0;           ///< of them, the 99.9th of a hundred [us]
};

/// Around the ventricle in the middle of its wall, with fibres that rise out of their layer by one angle.
struct FrictionRow {
  double degrees = 0.0;   ///< imbrication
  double expected = 0.0;  ///< tau_f by the corrected eq. 8.1 [mm]
  double lag = 0.0;       ///< mean distance that the last proxy stays behind [mm]
  double worst = 0.0;     ///< largest difference of that from tau_f [mm]
};

/// A slow hand from place to place in the box about the heart's wall, some seconds long. @throws Cancelled.
[[nodiscard]] FibreFeel run_fibre_feel(const std::shared_ptr<const LayeredHeart>& heart, Effort effort,
                                       Progress* progress);
/// @throws Cancelled.
[[nodiscard]] std::vector<FrictionRow> run_friction(Effort effort, Progress* progress);

[[nodiscard]] ReportSection fibre_feel_section(const std::string& subject, const FibreFeel& feel,
                                               const std::vector<FrictionRow>& friction);
/// That proxies lie on their layers and drag as (8.1) says.
[[nodiscard]] std::vector<StabilityCase> fibre_feel_cases(const FibreFeel& feel,
                                                          const std::vector<FrictionRow>& friction);

/// A heart with the likeliest arrays of `mesh`. @throws Error as make_heart().
inline std::shared_ptr<const LayeredHeart> layered(const DataSet& mesh) {
  std::vector<ArrayInfo> arrays;
  for (const DataArray& a : mesh.arrays)
    arrays.push_back({a.name, a.association, a.components, a.type, a.tuples});
  return std::make_shared<const LayeredHeart>(make_heart(mesh, choose_heart(arrays, "", "mesh"), "mesh"));
}

/// Layer, groove and friction in a chain.
class FibreChain {
 public:
  explicit FibreChain(std::shared_ptr<const LayeredHeart> heart, const ChainSettings& settings = {},
                      int links = 3)
      : heart_(std::move(heart)),
        workspace_(Workspace::default_scale(heart_->heart().layer->diagonal()), heart_->frame()) {
    const auto& depth = heart_->heart().layer;
    std::vector<std::unique_ptr<Constraint>> made;
    auto layer = std::make_unique<LayerConstraint>(depth, workspace_, default_layers(*depth));
    layer_ = layer.get();
    made.push_back(std::move(layer));
    auto groove = std::make_unique<FibreGroove>(heart_, *layer_);
    auto friction = std::make_unique<FibreFriction>(heart_, *layer_, *groove);
    friction_ = friction.get();
    if (links > 1) made.push_back(std::move(groove));
    if (links > 2) made.push_back(std::move(friction));
    chain_ = std::make_unique<ProxyChain>(std::move(made), settings);
  }

  /// @param x_data finite.
  ChainStep step(const Vec3& x_data) { return chain_->step(workspace_.workspace_from_data(x_data)); }
  /// Data coordinates.
  [[nodiscard]] Vec3 proxy(const ChainStep& step, std::size_t link) const {
    return workspace_.data_from_workspace(step.proxies[link]);
  }
  /// Which of the default layers holds; -1: none.
  [[nodiscard]] int layer() const { return layer_->surface().held_by(); }
  /// Its depth.
  [[nodiscard]] double level() const {
    return layer_->surface().point().level / heart_->heart().layer->value_scale();
  }
  /// At which friction gives [m]; that of a chain of three.
  [[nodiscard]] double threshold() const { return friction_->threshold(); }
  [[nodiscard]] const Workspace& workspace() const { return workspace_; }
  [[nodiscard]] const LayeredHeart& heart() const { return *heart_; }

 private:
  std::shared_ptr<const LayeredHeart> heart_;
  Workspace workspace_;
  LayerConstraint* layer_ = nullptr;
  FibreFriction* friction_ = nullptr;
  std::unique_ptr<ProxyChain> chain_;
};

}  // namespace palpate
