/// A field of symmetric tensors: a grid and six numbers at each of its points; immutable and shared.
///
/// Tensors are in the axes of the data frame X, to which loaders turn them from those of their measurement,
/// and in the data's units. Boxes interpolate trilinearly, tetrahedra linearly: the components, or the logarithm (Arsigny et al. 2006), which keeps every
/// eigenvalue above zero and determinants between those of the points. Where some corners of a cell have no
/// tensor (masked images), the others are taken as long as they have more than half of the weight: a field
/// reaches half way into the voxels around its mask.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/sample.h"
#include "common/field/vector_field.h"
#include "common/math/vec.h"

namespace palpate {

class PeakField;

/// What the numbers of a tuple are, in order.
enum class TensorOrder : std::uint8_t {
  kRows,      ///< xx xy xz yy yz zz: FSL's dtifit, NRRD's 3D-symmetric-matrix
  kMask,      ///< a mask, then as kRows: NRRD's 3D-masked-symmetric-matrix; below 0.5 there is no tensor
  kDiagonal,  ///< xx yy zz xy xz yz: MRtrix
  kLower,     ///< xx xy yy xz yz zz: NIfTI's symmetric-matrix intent
  kFull,      ///< all nine; the symmetric part is taken
  kAxis       ///< a direction v without a sign, such as a fibre's: v v^T / |v|^2 (Ikits 2006, sec. 8.2)
};
/// Numbers a tuple has.
[[nodiscard]] int component_count(TensorOrder order) noexcept;

/// xx xy xz yy yz zz of a tuple as stored, of all nine their symmetric part; NaN where a mask says that there
/// is no tensor. @pre tuple < array.tuples, array.components == component_count(order).
[[nodiscard]] std::array<double, 6> read_tensor(const DataArray& array, std::size_t tuple,
                                                TensorOrder order) noexcept;

enum class TensorInterpolation : std::uint8_t { kComponents, kLogEuclidean };

struct TensorChoice {
  std::string array;
  TensorOrder order = TensorOrder::kRows;
  TensorInterpolation interpolation = TensorInterpolation::kComponents;
  /// Tensors of cells are brought to the points: the volume-weighted mean of the cells around each that have
  /// one.
  Association association = Association::kPoint;
  /// Tensors of cells hold all over their cell instead, on tetrahedra; values() are the mean all the same.
  bool constant_cells = false;
  /// Of points of a uniform image: an array of all its peaks (peak_field.h); empty: there are none.
  std::string peaks = {};
};

/// A tensor sample; `value` is zero unless `status` is kOk, and never to be used then.
struct TensorSample {
  Mat3 value{0.0};  ///< symmetric
  SampleStatus status = SampleStatus::kOutside;
};

class TensorField {
 public:
  /// Samples at `x` in data coordinates. @rt Safe.
  [[nodiscard]] TensorSample sample(const Vec3& x_data, CellHint& hint) const noexcept;

  /// Where the voxels of the image stand that the field was made from; none where it was not uniform.
  [[nodiscard]] const std::optional<UniformTopology>& voxels() const noexcept { return voxels_; }
  /// The tensor of one voxel alone: its neighbours may have none. Outside the image there is none either.
  /// @pre voxels(). @rt Safe.
  [[nodiscard]] TensorSample voxel(const Index3& at) const noexcept;
  /// Where an image has several directions a voxel, all of them: lines follow these, and not the tensors, which are
  /// those of the longest. Null where it has not.
  [[nodiscard]] const PeakField* peaks() const noexcept { return peaks_.get(); }

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const std::shared_ptr<const FieldGrid>& grid() const noexcept { return grid_; }
  [[nodiscard]] const Box& bounds() const noexcept;  ///< data coordinates
  [[nodiscard]] const LocalFrame& frame() const noexcept;
  [[nodiscard]] const FieldNotes& notes() const noexcept { return notes_; }
  [[nodiscard]] TensorInterpolation interpolation() const noexcept { return interpolation_; }
  /// Samples are those of their cell in the data, and jump at its faces; values() are their mean at points.
  [[nodiscard]] bool constant_in_cells() const noexcept { return !cells_.empty(); }
  /// What is interpolated, six numbers as TensorOrder::kRows at each point of grid(): tensors, or their
  /// logarithms. NaN where there is no tensor.
  [[nodiscard]] std::variant<std::span<const float>, std::span<const double>> values() const noexcept;
  /// The largest trace of a tensor of the field, a scale for thresholds; 0 where none is above zero.
  [[nodiscard]] double largest_trace() const noexcept { return largest_trace_; }
  /// The median of the traces above zero, which outliers do not move; 0 where there is none.
  [[nodiscard]] double typical_trace() const noexcept { return typical_trace_; }
  /// Points whose tensor has an eigenvalue below zero: measures take it as zero.
  [[nodiscard]] std::size_t negative_tensors() const noexcept { return negative_tensors_; }

 private:
  friend class TensorFieldBuilder;
  using Six = std::array<double, 6>;  ///< as TensorOrder::kRows

  [[nodiscard]] Six stored(std::size_t point) const noexcept;
  [[nodiscard]] TensorSample sample_of(const Six& numbers) const noexcept;

  std::string name_;
  std::shared_ptr<const FieldGrid> grid_;
  std::optional<UniformTopology> voxels_;
  std::shared_ptr<const PeakField> peaks_;
  FieldNotes notes_;
  TensorInterpolation interpolation_ = TensorInterpolation::kComponents;
  /// kRows, in X; of logarithms, where these are interpolated. NaN where there is no tensor.
  std::variant<std::vector<float>, std::vector<double>> values_;
  std::vector<Six> cells_;  ///< of each cell of the data, as `values_`; empty: these are interpolated
  double largest_trace_ = 0.0;
  double typical_trace_ = 0.0;
  std::size_t negative_tensors_ = 0;
};

/// Makes the field from an image. With logarithms, eigenvalues below 1e-6 of largest_trace() are lifted to
/// that: fitted tensors have zero and negative ones.
/// @param notes become the first of the field's.
/// @throws Error (bad input) with `file` where the array is missing or has another number of components, or
/// the topology is hostile or flat.
[[nodiscard]] std::shared_ptr<const TensorField> make_tensor_field(
    const DataSet& image, const TensorChoice& choice, const std::string& file, int threads = 0,
    const std::vector<std::string>& notes = {});

}  // namespace palpate
