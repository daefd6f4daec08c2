#include "common/window/panels/probe_plot.h"

#include <algorithm>

#include <GLFW/glfw3.h>

namespace palpate {

void ProbePlot::update(const SceneInfo& info, std::size_t time_step, int threads, PanelState& state) {
  state.series.reset();
  const bool known = std::ranges::find(info.plotted, state.plotted) != info.plotted.end();
  const std::string wanted = known ? state.plotted : std::string();
  if (wanted != name_) {
    if (!series_) series_ = std::make_unique<ProbeSeries>([] { glfwPostEmptyEvent(); });
    series_->choose(info.input, wanted, threads);
    name_ = wanted;
  }
  if (wanted.empty()) return;
  series_->keep_steps(state.keep_steps);
  const ProbeReadout& hand = state.touch->readout();
  if (hand.held) series_->request(hand.proxy);
  state.series = SeriesPlot{.curve = series_->curve(),
                            .reading = series_->reading(),
                            .now = info.times.empty() ? 0.0 : info.times[time_step]};
}

}  // namespace palpate
