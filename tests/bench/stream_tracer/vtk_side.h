/// vtkStreamTracer: its lines, the exact curves of its own interpolation, and a sweep of its settings.
#pragma once

#include <utility>
#include <vector>

#include "tests/bench/stream_tracer/case.h"
#include "tests/bench/stream_tracer/curve_error.h"
#include "tests/bench/stream_tracer/rows.h"

namespace palpate::bench {

/// Fourth-order Runge-Kutta in doubles with a step of 2e-5 diagonals on VTK's interpolation.
[[nodiscard]] std::vector<Curve> vtk_exact(const Case& c);

struct VtkSetting {
  bool rk45 = false;
  bool cell_unit = false;
  bool cell_locator = false;
  double step = 0.0;
  double max_error = 0.0;
};

/// @param seconds processor time of the filter.
[[nodiscard]] std::vector<Curve> vtk_lines(const Case& c, const VtkSetting& s, double& seconds);

/// Step-size sweeps of vtkStreamTracer on the seeds of `c`. A sweep ends where VTK is past the last bar, or
/// where a run takes longer than anyone would wait.
[[nodiscard]] std::vector<std::pair<Row, VtkSetting>> sweep_vtk(const Case& c,
                                                                const std::vector<Curve>& exact);

}  // namespace palpate::bench
