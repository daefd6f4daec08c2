/// The steps of `probe`: a hand along a path, without a device, one step after the other. What they do is
/// logged, drawn, measured and summed up as they go.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "common/base/clock.h"
#include "common/base/files/output_file.h"
#include "common/cli/probe_log.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/device/probe_path.h"
#include "common/device/simulated_device.h"
#include "common/hand/drawn/drawn_tract.h"
#include "common/hand/technique/box_hold.h"
#include "common/hand/technique/immersive_technique.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/servo/hand_step.h"
#include "common/servo/replay_source.h"

namespace palpate {

/// Steps by hand, log and summary.
class ProbeRun {
 public:
  /// All outlive this.
  ProbeRun(ProbeSummary& summary, const Workspace& workspace, const VerbContext& context)
      : summary_(summary), workspace_(workspace), context_(context) {}

  void log_to(OutputFile& file, int links, const ProbeLog::Measured& measured) {
    log_.emplace(file, workspace_, links, measured);
  }
  void draw_on(TractPen& pen) { pen_ = &pen; }
  /// The button takes hold of the faces of summary.box. @param reach, bounds as of BoxHold.
  void hold_box(double reach, const Box& bounds) {
    box_reach_ = reach;
    bounds_ = bounds;
  }
  /// The button takes hold of the view where it is at no face: of summary.focal_point.
  void hold_view() { holds_view_ = true; }

  /// Takes the step that `make_step` makes, and its time.
  /// @param row what stands in the log for where the probe was.
  template <class Step>
  void take(const PathRow& row, const Step& make_step) {
    const double before = thread_microseconds();
    const HandStep step = make_step();
    add(row, step, thread_microseconds() - before);
  }

  /// Counted from 1; 0: none.
  [[nodiscard]] std::size_t first_fault() const noexcept { return first_fault_; }
  [[nodiscard]] ForceCut first_cut() const noexcept { return first_cut_; }

  /// After the last step.
  void finish();

 private:
  /// Processor time of this thread [us].
  [[nodiscard]] static double thread_microseconds();
  void add(const PathRow& row, const HandStep& step, double microseconds);
  void draw(const PathRow& row, const HandStep& step);
  void lead_by_grid(const PathRow& row, const HandStep& step);

  ProbeSummary& summary_;
  const Workspace& workspace_;
  const VerbContext& context_;
  std::optional<ProbeLog> log_;
  TractPen* pen_ = nullptr;
  BoxHold box_hold_;
  ViewHold view_hold_;
  bool holds_view_ = false;
  double box_reach_ = 0.0;  ///< [data units]; 0: there is no box
  Box bounds_;
  std::vector<float> times_;  ///< [us]
  std::size_t first_fault_ = 0;
  ForceCut first_cut_ = ForceCut::kNone;
  Stopwatch watch_;
};

/// One step a row of the path.
void follow_path(const std::vector<PathRow>& path, HandStepper& stepper, const Workspace& workspace,
                 ProbeRun& run, Progress& progress);

/// One step a row of tracked hands; the other hand carries a cutting plane. Rows that do not see the stylus
/// are steps at its last place.
void follow_hands(const std::vector<TrackedHands>& rows, ImmersiveTechnique& technique,
                  ChainSettings settings, WidgetNewsBuffer* planes, HandStepper& stepper,
                  const Workspace& workspace, ProbeRun& run, Progress& progress);

/// A simulated hand that wants to be on the path: steps at the servo's rate, in simulated time, until the
/// path ends. @throws Error (usage) for paths of more than a day.
void follow_operator(const std::vector<PathRow>& path, const SimulatedDeviceOptions& simulated, double rate,
                     HandStepper& stepper, const Workspace& workspace, ProbeRun& run, Progress& progress);

/// The steps of a recording, those without a hand left out of the log.
void follow_recording(ReplaySource& replay, const Workspace& workspace, ProbeRun& run, Progress& progress);

}  // namespace palpate
