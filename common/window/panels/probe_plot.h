/// The scalar that is plotted over time where the hand is, or was last: which one, and what of it is there.
#pragma once

#include <memory>
#include <string>

#include "common/compose/window_model.h"
#include "common/hand/probe_series.h"
#include "common/window/panels/panel.h"

namespace palpate {

class ProbePlot {
 public:
  /// Of another input: what was read means nothing to it.
  void forget() { name_.clear(); }
  /// Once a frame: reads on what state.plotted names, where the hand of state.touch is, and leaves the plot
  /// in state.series, nothing where nothing is plotted. @pre state.touch is not null.
  void update(const SceneInfo& info, std::size_t time_step, int threads, PanelState& state);
  /// What was read last.
  [[nodiscard]] SeriesCurve curve() const { return series_ ? series_->curve() : SeriesCurve{}; }

 private:
  std::string name_;                     ///< that is plotted; empty: nothing
  std::unique_ptr<ProbeSeries> series_;  ///< made when something is first plotted
};

}  // namespace palpate
