/// The flow between two steps of time. Data units.
///
///   v(t, x) = sum_j w_j(t) v_j(x)                                                                       (1)
///
/// over the two steps about t, w linear; or over up to four, w those of the cubic through both with the slopes of the
/// parabolas through three neighbours (of two steps alone: linear). On a mesh of tetrahedra whose points move
///
///   x = sum_i b_i sum_j w_j(t) X_ij,    v(t, x) = sum_i b_i sum_j w_j(t) v_ij                             (2)
///
/// with the cell i = 0 ... 3 that has x inside at t: values move with the cells, so that a moving wall carries its
/// own velocity. On an image or a rectilinear grid whose points move along its axes likewise
///
///   v(t, x) = sum_j w_j(t) v_j(x_j),    x_j at step j where x is at t among the cells
///                                       between the lines sum_j w_j(t) c_ij of an axis                    (3)
///
/// On an image whose axes A_j and origin o_j turn, x_j = o_j + A_j n with sum_j w_j(t) (o_j + A_j n) = x: points move
/// straight from step to step there, as in (2).
///
/// Where cells change from step to step, (1) holds at the place itself.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "common/field/grid/tet_mesh.h"
#include "common/field/vector_field.h"

namespace palpate {

class FlowInTime {
 public:
  /// A point this part of a cell beyond its face still counts as in it: a face belongs to both cells.
  static constexpr double kFace = 1e-10;

  struct Step {
    double time = 0.0;
    std::shared_ptr<const VectorField> field;
  };
  enum class Mesh : std::uint8_t {
    kFixed,
    kMoving,  ///< the same cells of points that move; of rectilinear grids, that move along their axes
    kOther    ///< other cells
  };
  /// Where a particle was found, which makes its next place quick to find. Any value is allowed.
  struct Place {
    std::int64_t cell = -1;  ///< as the data count them, where the mesh moves
    std::array<CellHint, 4> hints;
  };

  /// Between steps[first] and the next. @pre two to four steps, times strictly rising, first + 1 < steps.size().
  FlowInTime(std::vector<Step> steps, std::size_t first);

  [[nodiscard]] Mesh mesh() const noexcept { return mesh_; }
  /// About the size of a cell.
  [[nodiscard]] double cell_size() const noexcept { return cell_size_; }

  /// Of all steps: by which part of itself a value may be off, and by how much a point may lie elsewhere (value_rounding.h).
  [[nodiscard]] double value_rounding() const noexcept { return value_rounding_; }
  [[nodiscard]] double point_rounding() const noexcept { return point_rounding_; }

  /// Puts a particle among the cells, wherever it was before. False outside.
  [[nodiscard]] bool find(double t, const Vec3& x, Place& place) const;
  /// @pre t between the two steps. `v` is set where the status is kOk.
  [[nodiscard]] SampleStatus sample(double t, const Vec3& x, Place& place, Vec3& v) const noexcept;
  /// dv_i/dx_j at m[j][i]; zero unless the status is kOk.
  [[nodiscard]] SampleStatus jacobian(double t, const Vec3& x, Place& place, Mat3& m) const noexcept;

 private:
  using Weights = std::array<double, 4>;
  struct Cell {
    CellIndex cell = kNoCell;
    Vec4 b{0.0};
    Mat3 inverse{1.0};  ///< of the edges from vertex 0: its rows are the gradients of b_1, b_2, b_3
  };
  enum class Walk : std::uint8_t { kFound, kWall, kLost };
  /// Where a place lies in boxes that move.
  struct BoxPlace {
    Index3 cell{0};
    Vec3 u{0.0};      ///< in the cell, 0 to 1 along its axes
    Vec3 width{1.0};  ///< of the cell, along the axes, data units
    // Of images that turn, in place of these:
    Vec3 number{0.0};   ///< n
    Mat3 inverse{1.0};  ///< of the axes as they stand
  };

  [[nodiscard]] Weights weights(double t) const noexcept;
  [[nodiscard]] Vec3 position(const Weights& w, std::uint32_t point) const noexcept;
  [[nodiscard]] Vec3 velocity(const Weights& w, std::uint32_t point) const noexcept;
  [[nodiscard]] bool enter(const Weights& w, const Vec3& x, Cell& at) const noexcept;
  [[nodiscard]] Walk walk(const Weights& w, const Vec3& x, Cell& at) const noexcept;
  [[nodiscard]] bool locate(const Weights& w, const Vec3& x, Place& place, Cell& at) const noexcept;
  [[nodiscard]] bool search(const Weights& w, const Vec3& x, Cell& at) const noexcept;
  void compare_meshes();
  [[nodiscard]] double line_at(const Weights& w, int axis, int i) const noexcept;
  /// o_j + A_j n, and A_j.
  [[nodiscard]] Vec3 lattice_point(std::size_t step, const Vec3& number) const noexcept;
  [[nodiscard]] Mat3 lattice_axes(std::size_t step) const noexcept;
  [[nodiscard]] bool locate_in_lattice(const Weights& w, const Vec3& x, BoxPlace& at) const noexcept;
  [[nodiscard]] bool locate_in_boxes(const Weights& w, const Vec3& x, BoxPlace& at) const noexcept;
  [[nodiscard]] Vec3 place_in_step(std::size_t step, const BoxPlace& at) const noexcept;
  /// dx_j/dx of (3).
  [[nodiscard]] Mat3 motion_to_step(std::size_t step, const BoxPlace& at) const noexcept;

  std::vector<Step> steps_;
  std::size_t first_;
  const TetMesh* tets_ = nullptr;  ///< of steps_[first_], where values are taken by (2)
  bool boxes_move_ = false;        ///< of images and rectilinear grids: values are taken by (3)
  bool boxes_turn_ = false;        ///< images whose axes turn
  Mesh mesh_ = Mesh::kFixed;
  std::vector<CellIndex> cell_of_data_;  ///< moving: of tets_, by the number that it has in the data
  double cell_size_ = 1.0, value_rounding_ = 0.0, point_rounding_ = 0.0;
};

}  // namespace palpate
