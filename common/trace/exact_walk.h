/// Follows a line through a tetrahedral mesh, one exact piece at a time. No allocation on the fast path.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/field/vector_field.h"
#include "common/trace/affine_modes.h"
#include "common/trace/error_transport.h"
#include "common/trace/exact_cell.h"
#include "common/trace/line_walk.h"

namespace palpate {

/// Points and vectors of a mesh packed for the walk, frame L: 48 bytes a point.
class ExactMesh {
 public:
  /// @pre field.tet_mesh() is not null and outlives this.
  ExactMesh(const VectorField& field, int threads);

  [[nodiscard]] const TetMesh& mesh() const noexcept { return *mesh_; }
  [[nodiscard]] const PackedVertex* vertices() const noexcept { return vertices_.data(); }

 private:
  const TetMesh* mesh_;
  std::vector<PackedVertex> vertices_;
};

class ExactWalk final : public LineWalk {
 public:
  /// @param rest_distance how near a fixed point counts as having reached it, frame L.
  ExactWalk(const ExactMesh& mesh, double rest_distance, TraceDirection direction);

  [[nodiscard]] bool start(const Vec3& seed) override;
  [[nodiscard]] std::optional<End> advance() override;
  [[nodiscard]] LinePoint at(double theta) const override;
  /// Pieces that took the robust path, for reports.
  [[nodiscard]] std::int64_t robust_pieces() const noexcept { return robust_pieces_; }

 private:
  static constexpr int kMaxPiecesInCell = 64;  ///< after that the robust path takes the cell
  static constexpr int kMaxHalvings = 12;
  static constexpr int kMaxStandingSteps =
      256;  ///< crossings without progress: more than cells meet at a point

  enum class Outcome { kPiece, kCross, kRobust, kStandstill };

  void load_cell();
  [[nodiscard]] const TetMesh::Neighbors& neighbors(CellIndex cell) const {
    return mesh_->mesh().neighbors()[static_cast<std::size_t>(cell)];
  }
  [[nodiscard]] Outcome fast_piece();
  [[nodiscard]] std::optional<End> robust_piece();
  [[nodiscard]] std::optional<End> cross(int face);
  [[nodiscard]] std::optional<End> cross_standing(int face);
  void settle(CellIndex cell, const Vec3& x);
  void close_piece(const Pack4& b, const Pack4& w, double time, double arc, double local_error);
  void enter_robust();

  const ExactMesh* mesh_;
  double rest_distance_;
  double sign_;

  AffineCell cell_;
  CellIndex cell_index_ = kNoCell;
  bool loaded_ = false, finite_ = true;
  Pack4 b_, w_;
  int entry_ = -1;
  int exit_face_ = -1;  ///< face by which the last piece left, not yet crossed
  int pieces_in_cell_ = 0;
  int standing_ = 0;
  int ignored_face_ = -1;

  std::optional<AffineModes> modes_;
  AffineModes::Real mode_time_ = 0.0L, mode_step_ = 0.0L;

  // For at(): the start of the piece.
  Pack4 piece_b_, piece_w_;
  double piece_time_ = 0.0;
  AffineModes::Real piece_mode_start_ = 0.0L;
  bool piece_robust_ = false;

  ErrorTransport error_;
  std::int64_t robust_pieces_ = 0;
};

}  // namespace palpate
