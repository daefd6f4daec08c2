/// Error of traced tracts against run time, on bundles that are known in closed form.
///
/// An image of a bundle without noise is traced by every integrator over its steps or tolerances. Two errors
/// are told apart: that of the integrator, against the same image traced so tightly that nothing changes any
/// more; and that of the image, how far its trilinear interpolation leads that line away from the formula's.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/base/progress.h"
#include "lab/data/stability.h"
#include "lab/data/sweep.h"
#include "lab/page/section.h"

namespace palpate {

struct TractErrorRow {
  std::string method;               ///< "euler"
  double setting = 0.0;             ///< step [mm], or tolerance [mm/mm] of dp54
  double end = 0.0, end_p95 = 0.0;  ///< distance of end points from the reference's [mm], median and 95 %
  double excess_p95 = 0.0;          ///< that distance over the error stated there, 95 %
  double direction = 0.0;           ///< angle between the main directions there, median [degrees]
  double seconds = 0.0;             ///< of all lines, one thread
};

/// Of lines from the centres of voxels, against the formula's curves: what an image costs is part of it.
struct TractPeerRow {
  std::string method;     ///< "tckgen Tensor_Det", "dp54"
  std::string setting;    ///< "step=0.5"
  std::size_t lines = 0;  ///< that come the whole length
  double end = 0.0;       ///< distance of end points, median [mm]
  double seconds = 0.0;   ///< processor time a line
};

struct TractErrors {
  std::string bundle;                ///< "helix"
  double voxel = 0.0, length = 0.0;  ///< [mm]
  std::size_t lines = 0;
  std::vector<TractErrorRow> rows;  ///< by method, loose to tight
  double image_end = 0.0;           ///< median distance of the reference's end points from the formula's [mm]
  std::vector<TractPeerRow> peers;  ///< the peer, and our own methods beside it
  std::string why_no_peer;          ///< empty: there is one
};

/// "helix" and "kissing", whose lines are curved (Euler's method is exact on straight ones). @throws
/// Cancelled.
[[nodiscard]] std::vector<TractErrors> run_tract_errors(Effort effort, Progress* progress);

[[nodiscard]] ReportSection tract_errors_section(const std::vector<TractErrors>& errors);
/// That errors fall with the order of the method, and stay within the tolerance and within what is stated.
[[nodiscard]] std::vector<StabilityCase> tract_error_cases(const std::vector<TractErrors>& errors);

/// d log(error) / d log(setting) of a method, over its settings with errors of at least `floor`, by least
/// squares; NaN for fewer than two.
[[nodiscard]] double observed_order(const TractErrors& errors, const std::string& method, double floor);

}  // namespace palpate
