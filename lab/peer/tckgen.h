/// MRtrix's tckgen on the signals of a bundle: what a peer makes of the tracts of a report.
///
/// Tensor_Det interpolates the diffusion-weighted signals and fits a tensor at each step, so that its curves are not those of
/// an image of tensors: what both are off is measured from the formula's curves. It is run as it is installed, as a program
/// of its own; nothing of it is compiled into other programs.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "common/field/analytic/tensor_examples.h"
#include "common/field/data_set.h"
#include "common/field/tensor/gradient_table.h"

namespace palpate {

/// Lines from their seeds on, one way.
struct TckgenLines {
  std::vector<std::vector<Vec3>> lines;
  double seconds =
      0.0;  ///< processor time a line, of 27 seeds a voxel and without that of a run from one seed
};

class Tckgen {
 public:
  /// Why it cannot be run here; empty: it can.
  [[nodiscard]] static std::string why_none();

  /// Signals of the formula at the voxels of `image`. @param seeds numbers of voxels, whose centres are the seeds; some.
  /// @throws Error (work failed) where the files cannot be written. @pre why_none() is empty.
  Tckgen(const AnalyticTensor& formula, const UniformTopology& image, const GradientTable& gradients,
         std::span<const std::size_t> seeds);
  Tckgen(const Tckgen&) = delete;
  Tckgen& operator=(const Tckgen&) = delete;
  ~Tckgen();

  /// By Euler steps of that length, for `length`; both in mm. @throws Error (work failed) where tckgen fails.
  [[nodiscard]] TckgenLines trace(double step, double length, double cutoff, double max_angle) const;

 private:
  std::filesystem::path folder_;
};

}  // namespace palpate
