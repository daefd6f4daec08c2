/// A scalar field: a grid and a number at each of its points, or a formula; immutable and shared. A
/// component or the magnitude of any point or cell array, to colour lines by, to draw and to feel.
///
/// Frame L (local_frame.h) has local lengths; local values are those of the data times value_scale(), a power
/// of two by which their range is from 1 to 2. A field scaled by powers of two has the same bits there.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/analytic/analytic_scalar.h"
#include "common/field/data_set.h"
#include "common/field/grid/scalar_cell.h"
#include "common/field/sample.h"
#include "common/field/vector_field.h"

namespace palpate {

/// Which number of an array's tuples.
struct ScalarChoice {
  std::string array;
  Association association = Association::kPoint;
  int component = 0;  ///< or kMagnitude
  static constexpr int kMagnitude = -1;
};

class ScalarField {
 public:
  /// Samples at `x` in data coordinates: trilinear or linear, as the vector field. @rt Safe.
  [[nodiscard]] ScalarSample sample(const Vec3& x_data, CellHint& hint) const noexcept;
  /// Gradient of the interpolant, value units per length unit; status as sample. @rt Safe.
  [[nodiscard]] VectorSample gradient(const Vec3& x_data, CellHint& hint) const noexcept;
  /// Value, gradient and Hessian of the cell's interpolant at `x` in frame L, local values; `out` is zero
  /// unless the status is kOk. On a face the derivatives are those of the cell that locate() finds. @rt Safe.
  [[nodiscard]] SampleStatus jet(const Vec3& x_local, CellHint& hint, Jet3& out) const noexcept;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }  ///< data coordinates
  [[nodiscard]] double diagonal() const noexcept { return bounds_.diagonal(); }
  [[nodiscard]] const LocalFrame& frame() const noexcept { return frame_; }  ///< its speed exponent is zero
  [[nodiscard]] const FieldNotes& notes() const noexcept { return notes_; }

  /// @name Values; lowest() > highest() where none is finite
  /// @{
  [[nodiscard]] double lowest() const noexcept {
    return lowest_;
  }  ///< of the finite ones; a formula's on a
     ///< lattice
  [[nodiscard]] double highest() const noexcept { return highest_; }
  /// Local values per value of the data, a power of two.
  [[nodiscard]] double value_scale() const noexcept { return values_.scale; }
  /// highest() - lowest() in local values; 0 where there are none.
  [[nodiscard]] double local_range() const noexcept {
    return lowest_ <= highest_ ? highest_ * values_.scale - lowest_ * values_.scale : 0.0;
  }
  /// @}

  /// The grid with its way back to the data, on which further fields can be made; null for a formula.
  [[nodiscard]] const std::shared_ptr<const FieldGrid>& grid() const noexcept { return grid_; }
  /// The kernels that trace/ is written against; exactly one is not null.
  [[nodiscard]] const BoxGrid* box_grid() const noexcept { return box_.get(); }
  [[nodiscard]] const TetMesh* tet_mesh() const noexcept { return tets_.get(); }
  [[nodiscard]] const AnalyticScalar* analytic() const noexcept { return analytic_.get(); }
  [[nodiscard]] const PointScalars& values() const noexcept { return values_; }

 private:
  friend class ScalarFieldBuilder;
  std::string name_;
  LocalFrame frame_;
  Box bounds_;
  FieldNotes notes_;
  std::shared_ptr<const FieldGrid> grid_;
  std::shared_ptr<const BoxGrid> box_;
  std::shared_ptr<const TetMesh> tets_;
  std::shared_ptr<const AnalyticScalar> analytic_;
  PointScalars values_;
  double lowest_ = 0.0;
  double highest_ = -1.0;
};

/// Makes the field that `choice` describes from the blocks of a data set, on a grid of its own: blocks
/// without the array or without cells are left out, and a note says so.
/// @throws Error (bad input) with `file` where no block has the array, or the topology is hostile or flat;
/// (usage) where the component does not exist.
[[nodiscard]] std::shared_ptr<const ScalarField> make_scalar_field(const std::vector<DataSet>& blocks,
                                                                   const ScalarChoice& choice,
                                                                   const std::string& file, int threads = 0);

/// Makes the field that `choice` describes on the grid of `like`. `blocks` are those that `like` was made
/// from, perhaps with other arrays. Blocks without the array have no values: bad data there.
/// @throws Error (bad input) with `file` where no block has the array or its shape is wrong; (usage) where
/// `like` is a formula or the component does not exist.
[[nodiscard]] std::shared_ptr<const ScalarField> make_scalar_field(const VectorField& like,
                                                                   const std::vector<DataSet>& blocks,
                                                                   const ScalarChoice& choice,
                                                                   const std::string& file, int threads = 0);

/// Makes a field from a formula, whose local units are 2^length_exponent and 2^value_exponent data units.
[[nodiscard]] std::shared_ptr<const ScalarField> make_scalar_field(
    std::shared_ptr<const AnalyticScalar> formula, int length_exponent = 0, int value_exponent = 0);

/// The speed |v| of `field`, named "speed": on a grid the interpolant of the speeds at its points, which is
/// not the speed of the interpolant (they agree at the points); of a formula the very speed.
[[nodiscard]] std::shared_ptr<const ScalarField> make_speed_field(
    const std::shared_ptr<const VectorField>& field);

}  // namespace palpate
