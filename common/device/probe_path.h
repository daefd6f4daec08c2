/// Recorded probe paths: the table of `--path`.
///
///   t,x,y,z[,b0]
///
/// Seconds, data coordinates, and whether the button is down. Columns may stand in any order beside others;
/// comment lines start with '#'.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/device/device.h"
#include "common/math/vec.h"

namespace palpate {

/// One servo step. Nothing in it need be finite, nor do times need to rise: that is for the step to judge.
struct PathRow {
  double time = 0.0;          ///< [s]
  Vec3 position{0.0};         ///< data coordinates
  std::uint32_t buttons = 0;  ///< bit 0 where b0 is a number other than zero
};

/// The rows as samples of a device, in the workspace frame: `scale` metres per data unit.
[[nodiscard]] std::vector<DeviceSample> samples_of(const std::vector<PathRow>& path, double scale);

/// All rows, in memory in proportion to the size of the file; none for a table that ends with its header.
/// @throws Error (bad input) naming the file, the line and what was expected.
[[nodiscard]] std::vector<PathRow> read_probe_path(const std::string& file);

}  // namespace palpate
