/// A streamline that grows both ways from its seed, a few pieces at a time, into storage that is there
/// from the start: what the hand follows and what is drawn are these nodes.
///
/// Between two nodes the curve *is* the cubic of their positions and tangents (geometry/hermite.h). Nodes are
/// put so close that it leaves the dense output of the tracer by no more than `max_gap`, and the distance
/// that was measured is kept with each node. One thread grows the line; others may read the nodes that are
/// there, which are never changed until start().
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "common/base/index.h"
#include "common/field/vector_field.h"
#include "common/geometry/hermite.h"
#include "common/geometry/line.h"
#include "common/trace/loop_detector.h"
#include "common/trace/walk/line_walk.h"
#include "common/trace/walk/walk_factory.h"

namespace palpate {

/// A point of the line. Frame L; arc and time are signed, 0 at the seed unless start() said otherwise.
struct LineNode {
  Vec3 position{0.0};
  Vec3 tangent{0.0};  ///< unit, along the flow
  double arc = 0.0;
  double time = 0.0;
  double speed = 0.0;
  double error = 0.0;  ///< estimated distance from the true curve of the interpolant
  double gap =
      0.0;  ///< measured distance of the cubic that ends here (away from the seed) from the tracer's curve
};

struct GrowthLimits {
  double max_length = 0.0;  ///< on either side, frame L
  double max_gap = 0.0;     ///< frame L
  int capacity = 1 << 14;   ///< nodes on either side
};

class GrowingLine {
 public:
  enum class Side : std::uint8_t { kDownstream = 0, kUpstream = 1 };

  /// Allocates everything. @pre `field` and what `factory` prepared outlive this.
  GrowingLine(const VectorField& field, const WalkFactory& factory, const GrowthLimits& limits);

  /// @name By the thread that grows it; no allocation, no lock
  /// @{

  /// Begins anew at `seed` (frame L), whose arc and time are counted from `arc` and `time`. False where the
  /// seed lies in no cell or the data there is bad; the line is then empty.
  [[nodiscard]] bool start(const Vec3& seed, double arc = 0.0, double time = 0.0) noexcept;
  /// Grows one side by a piece. Returns the work done in units of an ordinary piece; 0 where it has ended.
  int grow(Side side) noexcept;
  /// @}

  /// Why a side has ended; absent while it can still grow.
  [[nodiscard]] std::optional<End> end(Side side) const noexcept {
    const std::int8_t code = side_of(side).end.load(std::memory_order_acquire);
    return code < 0 ? std::nullopt : std::optional(static_cast<End>(code));
  }
  /// Nodes are numbered from first() <= 0, the farthest upstream, through 0, the seed, to last().
  [[nodiscard]] int first() const noexcept {
    return -side_of(Side::kUpstream).count.load(std::memory_order_acquire);
  }
  [[nodiscard]] int last() const noexcept {
    return side_of(Side::kDownstream).count.load(std::memory_order_acquire);
  }
  /// @pre first() <= i <= last().
  [[nodiscard]] const LineNode& node(int i) const noexcept {
    return i >= 0 ? sides_[0].nodes[as_size(i)] : sides_[1].nodes[as_size(-i)];
  }
  /// The cubic between nodes i and i + 1.
  [[nodiscard]] HermitePiece piece(int i) const noexcept {
    const LineNode &a = node(i), &b = node(i + 1);
    return {a.position, a.tangent, b.position, b.tangent, b.arc - a.arc};
  }
  /// Measured distance of piece i from the tracer's curve.
  [[nodiscard]] double gap(int i) const noexcept { return node(i >= 0 ? i + 1 : i).gap; }

 private:
  static constexpr int kMaxParts = 16;  ///< nodes that one piece of the tracer is divided into at most

  struct OneSide {
    std::unique_ptr<LineWalk> walk;
    std::unique_ptr<LineNode[]> nodes;  ///< the seed first
    std::atomic<int> count{0};          ///< nodes beyond the seed
    std::atomic<std::int8_t> end{-1};
    LoopDetector loop;
    CellHint hint;
  };
  [[nodiscard]] const OneSide& side_of(Side side) const noexcept { return sides_[as_size(side)]; }
  [[nodiscard]] LineNode node_of(const LinePoint& point, const Vec3& tangent, Side side) const noexcept;
  [[nodiscard]] Vec3 tangent_at(const LinePoint& point, const Vec3& otherwise, CellHint& hint) const noexcept;
  void add_piece(OneSide& to, Side side, double cut) noexcept;

  const VectorField& field_;
  GrowthLimits limits_;
  std::array<OneSide, 2> sides_;
  double arc_ = 0.0, time_ = 0.0;  ///< of the seed
};

}  // namespace palpate
