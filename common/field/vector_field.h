/// A vector field: a grid and the values at its points, immutable and shared.
///
/// Kinds of grid: uniform and rectilinear boxes with trilinear interpolation, tetrahedra with linear
/// interpolation (curvilinear and mixed cells are split, grid/cell_split.h), and formulas (analytic/).
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/local_frame.h"
#include "common/field/sample.h"
#include "common/field/vector_choice.h"
#include "common/math/vec.h"

namespace palpate {

/// A thing that is made of an immutable object at its first use and lives as long as the object.
class OnceMade {
 public:
  /// What `make` (returns std::shared_ptr<const T>) made at the first call; others wait until it is there.
  /// @pre every call is for the same T. An exception of `make` passes; the next call tries again.
  template <class T, class Make>
  [[nodiscard]] const T& get(const Make& make) const {
    std::call_once(once_, [&] { made_ = make(); });
    return *static_cast<const T*>(made_.get());
  }

 private:
  mutable std::once_flag once_;
  mutable std::shared_ptr<const void> made_;
};

class BoxGrid;        // grid/box_grid.h: uniform and rectilinear
class TetMesh;        // grid/tet_mesh.h
class AnalyticField;  // analytic/analytic_field.h
struct FieldGrid;     // field_grid.h

/// Values at the points of a grid, in local units (multiplied by `scale` on reading), as stored.
struct PointVectors {
  std::variant<std::span<const float>, std::span<const double>> values;  ///< 3 * points, xyz by point
  double scale = 1.0;                                                    ///< a power of two
  std::shared_ptr<const void> owner;
};

/// Where the last sample was found: makes the next one near it quick. Any value is allowed.
struct CellHint {
  std::int64_t cell = -1;
};

/// What was found and done while a field was made, for `info`, summaries and reports.
struct FieldNotes {
  std::vector<std::string> lines;  ///< sentences for the user
  std::size_t zero_volume_cells = 0;
  std::size_t inverted_cells = 0;
  std::size_t bad_values = 0;  ///< points whose value is not finite, or blanked
};

class VectorField {
 public:
  /// Samples at `x` in data coordinates.
  [[nodiscard]] VectorSample sample(const Vec3& x_data, CellHint& hint) const noexcept;
  /// Jacobian dv_i/dx_j of the interpolant, at m[j][i] (GLM column major), data units; status as sample.
  [[nodiscard]] SampleStatus jacobian(const Vec3& x_data, CellHint& hint, Mat3& m) const noexcept;

  [[nodiscard]] const std::string& name() const noexcept { return name_; }
  [[nodiscard]] const Box& bounds() const noexcept { return bounds_; }  ///< data coordinates
  [[nodiscard]] double diagonal() const noexcept { return bounds_.diagonal(); }
  [[nodiscard]] double max_speed() const noexcept { return max_speed_; }  ///< data units
  /// By which part of itself a value may be off, as it is of single precision: value_rounding.h.
  [[nodiscard]] double value_rounding() const noexcept { return value_rounding_; }
  [[nodiscard]] const LocalFrame& frame() const noexcept { return frame_; }
  [[nodiscard]] const FieldNotes& notes() const noexcept { return notes_; }

  /// The kernels that trace/ is written against; exactly one is not null.
  [[nodiscard]] const BoxGrid* box_grid() const noexcept { return box_.get(); }
  [[nodiscard]] const TetMesh* tet_mesh() const noexcept { return tets_.get(); }
  [[nodiscard]] const AnalyticField* analytic() const noexcept { return analytic_.get(); }
  [[nodiscard]] const PointVectors& values() const noexcept { return values_; }
  /// The grid with its way back to the data, on which further fields can be made; null for a formula.
  [[nodiscard]] const std::shared_ptr<const FieldGrid>& grid() const noexcept { return grid_; }
  /// What tracing makes of the field (trace/exact_mesh.h), once however often it is traced.
  [[nodiscard]] const OnceMade& prepared() const noexcept { return prepared_; }
  /// Indices of the blocks of the data set that the grid is made of.
  [[nodiscard]] const std::vector<std::size_t>& blocks() const noexcept { return blocks_; }

 private:
  friend class VectorFieldBuilder;
  std::string name_;
  LocalFrame frame_;
  Box bounds_;
  double max_speed_ = 0.0;
  FieldNotes notes_;
  std::shared_ptr<const BoxGrid> box_;
  std::shared_ptr<const TetMesh> tets_;
  std::shared_ptr<const AnalyticField> analytic_;
  PointVectors values_;
  std::shared_ptr<const FieldGrid> grid_;
  OnceMade prepared_;
  std::vector<std::size_t> blocks_;
  double value_rounding_ = 0.0;
};

/// Makes the field that `choice` describes from the blocks of a data set. One uniform or rectilinear
/// block becomes a box grid; everything else is split into tetrahedra and joined. Cell values are brought
/// to the points by least squares from the cells around each (cell_fit.h), and a note says what that costs.
/// @throws Error (bad input) with `file` where arrays are missing or have the wrong shape.
[[nodiscard]] std::shared_ptr<const VectorField> make_vector_field(const std::vector<DataSet>& blocks,
                                                                   const VectorChoice& choice,
                                                                   const std::string& file, int threads = 0);

/// Makes a field from a formula, whose local units are 2^length_exponent and 2^speed_exponent data units.
[[nodiscard]] std::shared_ptr<const VectorField> make_vector_field(
    std::shared_ptr<const AnalyticField> formula, int length_exponent = 0, int speed_exponent = 0);

}  // namespace palpate
