/// Follows a line through a tetrahedral mesh, one exact piece at a time. No allocation on the fast path.
#pragma once

#include <array>
#include <limits>
#include <optional>

#include "common/base/index.h"
#include "common/field/grid/tet_mesh.h"
#include "common/trace/exact/affine_modes.h"
#include "common/trace/exact/exact_kernel.h"
#include "common/trace/exact/exact_mesh.h"
#include "common/trace/walk/error_ellipse.h"
#include "common/trace/walk/line_walk.h"

namespace palpate {

class ExactWalk final : public LineWalk {
 public:
  /// @param rest_distance how near a fixed point counts as having reached it, frame L.
  /// @param kernel outlives this.
  ExactWalk(const ExactMesh& mesh, double rest_distance, TraceDirection direction,
            const ExactKernel& kernel = exact_kernel());

  [[nodiscard]] bool start(const Vec3& seed) override;
  [[nodiscard]] std::optional<End> advance() override;
  [[nodiscard]] LinePoint at(double theta) const override;
  [[nodiscard]] std::int64_t cell() const override { return cell_index_; }
  /// Modes stay where they were made; a line that has left their cell needs them no more.
  [[nodiscard]] bool movable() const override { return !modes_ || exit_face_ >= 0; }
  void save(StateWriter& out) const override;
  void restore(StateReader& in) override;
  /// Pieces that took the robust path, and cells that took it with twice the digits. Tests see by these which path
  /// a line took: both give the same line.
  [[nodiscard]] std::int64_t robust_pieces() const noexcept { return robust_pieces_; }
  [[nodiscard]] std::int64_t long_cells() const noexcept { return long_cells_; }

 private:
  static constexpr double kUlp = std::numeric_limits<double>::epsilon();
  /// Rounding of one cell's gather, series and hand-over, in units of 2^-52 of the cell's size. On the way to a point are some
  /// 23 roundings of half a unit at most: gradients 9, rates 4, C b 4, the series 6. As independent ones they come to 1.4 units
  /// (Higham and Mary 2019); with 4 units 3 of 10^6 points were off by more. Cells add up as if all had one sign.
  static constexpr double kRoundingPerCell = 8.0;
  static constexpr int kMaxPiecesInCell = 64;  ///< after that the robust path takes the cell
  /// A line that slows to this part of its rate at the entry of a cell may be coming to rest there: the
  /// robust path is to judge it before rounding drowns the rate.
  static constexpr double kSlowed = 1.0 / 64;
  static constexpr int kMaxStandingSteps =
      256;  ///< crossings without progress: more than cells meet at a point
  static constexpr double kProgress =
      1e-10;  ///< of the cell: what is less, by however many pieces, leads nowhere
  static constexpr int kMaxCrossings =
      256;  ///< without progress; from then on they are those of a line that stands
  static constexpr int kMaxWork = 4096;  ///< of one advance() that finds no piece: the next goes on

  struct RobustFlow {
    Pack4 b, w;
    std::array<Pack4, 4> velocity;  ///< at the inner nodes of the rule for the arc length, and at the end
    Pack4 speed;                    ///< there
  };

  template <class Self, class Archive>
  static void each_member(Self& self, Archive& archive) {
    each_common_member(self, archive);
    archive(self.cell_index_, self.loaded_, self.b_, self.w_, self.entry_, self.exit_face_,
            self.pieces_in_cell_, self.rate_at_entry_, self.standing_, self.crossings_, self.moved_,
            self.seams_standing_, self.robust_piece_, self.error_, self.robust_pieces_, self.long_cells_);
  }

  void enter_cell();
  [[nodiscard]] const TetMesh::Neighbors& neighbors(CellIndex cell) const {
    return mesh_->mesh().neighbors()[as_size(cell)];
  }
  [[nodiscard]] PieceOutcome fast_piece();
  [[nodiscard]] std::optional<End> robust_piece();
  /// From `start` to `stop` = start + h, times of the modes.
  [[nodiscard]] RobustFlow robust_flow(double start, double h, double stop) const;
  void move_onto_face(RobustFlow& flow, int face, double stop) const;
  [[nodiscard]] std::optional<End> cross(int face);
  [[nodiscard]] std::optional<End> cross_standing(int face);
  void settle(CellIndex cell, const Vec3& x);
  void close_piece(const Pack4& b, const Pack4& w, double time, double arc, double local_error);
  void enter_robust();

  const ExactMesh* mesh_;
  const ExactKernel& kernel_;
  double rest_distance_;
  double sign_;

  AffineCell cell_;
  CellIndex cell_index_ = kNoCell;
  bool loaded_ = false, finite_ = true;
  Pack4 b_, w_;
  int entry_ = -1;
  int exit_face_ = -1;  ///< face by which the last piece left, not yet crossed
  int pieces_in_cell_ = 0;
  double rate_at_entry_ = 0.0;
  int standing_ = 0;
  int crossings_ = 0;       ///< of faces, since the line made progress
  double moved_ = 0.0;      ///< its arc since then
  int seams_standing_ = 0;  ///< of the crossings without a move, those of seams

  std::optional<AffineModes> modes_;  ///< of the cell, where the robust path took it
  double modes_time_ = 0.0;           ///< since the modes began
  double piece_start_ = 0.0;          ///< the last piece's beginning
  double longest_ = 0.0;              ///< how long a piece is tried
  bool robust_piece_ = false;         ///< the last piece is one of the modes

  ExactPiece piece_;  ///< the last one; of a robust one only the time

  ErrorEllipse error_;
  std::int64_t robust_pieces_ = 0, long_cells_ = 0;
};

}  // namespace palpate
