/// Traces in rounds. At the beginning of each the lines that are left are dealt out: in the order of the blocks they are in,
/// each rank the same number, so that its lines lie in as few blocks as may be, and a crowded block goes to several
/// ranks. A rank follows its lines through the blocks that they began the round in; a line that leaves those is
/// held with its full state for the next round. So lines do not depend on the ranks, in any bit, and what is
/// held after a round is all that a restart needs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/trace/line_tracer.h"
#include "library/mpi/blocks.h"
#include "library/mpi/line_parts.h"
#include "library/mpi/ranks.h"

namespace palpate::mpi {

struct RoundFigures {
  std::int64_t pieces = 0;      ///< of this rank
  std::int64_t moved = 0;       ///< lines that it sent to others
  double seconds_traced = 0.0;  ///< of processor time
};

class RoundTrace {
 public:
  /// @pre all outlive this. @throws Error (usage) as trace_lines().
  RoundTrace(const VectorField& field, const Blocks& blocks, const TraceOptions& options, Ranks& ranks);

  [[nodiscard]] Integrator integrator() const noexcept { return tracing_.integrator(); }
  /// The lines of a seed.
  [[nodiscard]] std::span<const TraceDirection> ways() const noexcept { return ways_; }

  /// Begins the lines of this rank's share of all seeds.
  void begin(std::span<const Vec3> seeds);
  /// Goes on with lines that another run has held, whose blocks may be others.
  void resume(std::vector<HeldLine> held);
  /// Deals out what all ranks hold. @return how many lines that are, on all ranks.
  [[nodiscard]] std::int64_t deal();
  /// Follows this rank's lines, by `pieces` in all at most.
  void follow(std::int64_t pieces);

  [[nodiscard]] const std::vector<HeldLine>& held() const noexcept { return held_; }
  /// The parts traced since the last call, packed.
  [[nodiscard]] std::vector<std::byte> take_parts() noexcept { return std::exchange(parts_, {}); }
  [[nodiscard]] std::size_t part_bytes() const noexcept { return parts_.size(); }
  [[nodiscard]] const RoundFigures& figures() const noexcept { return figures_; }

 private:
  [[nodiscard]] LineTracer& tracer_of(std::uint64_t line);
  [[nodiscard]] bool goes_on(HeldLine& held, std::int64_t& pieces, const std::vector<bool>& mine);
  void keep_part(const HeldLine& held, const Line& line, bool last);

  const VectorField& field_;
  const Blocks& blocks_;
  Ranks& ranks_;
  LineTracing tracing_;
  std::vector<TraceDirection> ways_;
  std::array<std::optional<LineTracer>, 2> tracers_;
  std::vector<HeldLine> held_;
  std::vector<std::byte> parts_;
  RoundFigures figures_;
};

/// Puts the parts of all lines together: as trace_lines() gives them. @throws Error (work failed) where one is missing.
[[nodiscard]] TraceResult join_parts(std::vector<LinePart> parts, std::size_t seeds,
                                     std::span<const TraceDirection> ways);

}  // namespace palpate::mpi
