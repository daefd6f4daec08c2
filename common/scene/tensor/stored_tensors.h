/// Tensors as files store them, in whatever order and axes, brought into the axes of the coordinates.
#pragma once

#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_source.h"
#include "common/scene/tensor/tensor_spec.h"

namespace palpate {

/// The order of tuples of that size where the file's layout is TensorLayout::kData.
[[nodiscard]] TensorOrder order_of_size(int components) noexcept;

/// xx xy xz yy yz zz of every point, NaN where there is no tensor (a mask, zeros only, not finite).
///
/// Of six numbers in an order that the file does not state, `reading.order` says which it is. kAuto takes the order
/// that makes the most tensors positive definite, and of equals the one whose main directions line up best.
/// The axes are those that `reading` asks for, else those that the file states, else of the likely ones those in
/// which main directions line up best (orientation_check.h): programs write FSL's and the scanner's axes under the
/// same names, and ITK's programs LPS. Notes say what was taken.
/// @throws Error (bad input) with `file` where kAuto finds no order in which half of the tensors are
/// positive.
/// @param source of any kind but kSignals, whose arrays `image` has. @param frame becomes what was taken.
/// @param all_peaks of a peaks image become x y z of all of them, as PeakField takes them, in the same axes.
[[nodiscard]] std::vector<float> read_stored_tensors(const DataSet& image, const UniformTopology& topology,
                                                     const TensorSource& source,
                                                     const DiffusionInfo& diffusion,
                                                     const TensorReading& reading, int threads,
                                                     VectorFrame& frame, std::vector<std::string>& notes,
                                                     const std::string& file, std::vector<float>& all_peaks);

/// v becomes T v for every three numbers.
void turn_vectors(const Mat3& turn, std::vector<float>& vectors);

}  // namespace palpate
