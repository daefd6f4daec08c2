/// What the ways to draw a volume faster cost in errors of its picture: root mean square and worst difference
/// of colours (1 is full scale) from a converged picture, against milliseconds a frame.
///
/// The converged picture is that of converged_view(). Frames are timed by the clock, from the call to the end
/// of all drawing: timers of drivers are not trusted. Tables 5.1 and 5.3 of Ikits 2006 are done again beside
/// the printed figures.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "common/base/work_precision.h"
#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

struct VolumeQualityRow {
  std::string method;  ///< "samples a voxel"
  double parameter = 0.0;
  double rms = 0.0;
  double worst = 0.0;
  double milliseconds = 0.0;
};

/// A row of table 5.1: a preintegrated table of 128 x 128 x lengths.
struct TableTime {
  int lengths = 0;
  double printed_gpu = 0.0, printed_cpu = 0.0;  ///< [ms]
  double milliseconds = 0.0;                    ///< by the processor
  /// By a compute shader; absent on a software rasteriser, which is slow at it.
  std::optional<double> compute_ms;
};

/// A row of table 5.3 (FocusTable).
struct FocusRate {
  double axis = 1.0;     ///< share of the volume's sides that the focus has
  double printed = 0.0;  ///< [frames a second]; of 512 x 512 pixels where the picture has another size
  double rate = 0.0;     ///< likewise, here
};

/// Table 5.3 with the parameters of table 5.2, but for the size and number of its scalars: focus shaded at 4
/// samples a voxel; context not shaded, at 1 sample a voxel of twice the size, with a table of half the
/// entries and half the pixels along either edge; both without leaving out what is empty or hidden.
struct FocusTable {
  int pixels = 0;  ///< of the picture along either edge
  std::vector<FocusRate> rows;
};

struct VolumeQuality {
  std::string subject, renderer;
  std::string asked_for;    ///< what the picture was asked for with, in words
  bool made_focus = false;  ///< it has no lens: what lies around lenses was measured around a ball
  int pixels = 0;           ///< of the picture along either edge
  std::vector<VolumeQualityRow> rows;
  std::vector<TableTime> tables;
  std::vector<FocusTable> focus;
};

/// @pre view.image is not null. @throws Error (work failed) without OpenGL, Cancelled.
[[nodiscard]] VolumeQuality run_volume_quality(const VolumeView& view, const std::string& subject,
                                               Effort effort, Progress* progress);

/// The picture's error, the time of tables, the rates of focus and context.
[[nodiscard]] std::vector<ReportSection> volume_quality_sections(const VolumeQuality& quality);

}  // namespace palpate
