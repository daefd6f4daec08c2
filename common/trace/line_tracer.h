/// One line from its seed to its end, piece by piece; between two pieces it may go on in another process.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/trace/line_builder.h"
#include "common/trace/loop_detector.h"
#include "common/trace/trace.h"
#include "common/trace/walk/line_walk.h"
#include "common/trace/walk/walk_factory.h"

namespace palpate {

class LineTracer {
 public:
  LineTracer(std::unique_ptr<LineWalk> walk, LineBuilder builder)
      : walk_(std::move(walk)), builder_(std::move(builder)) {}

  /// Begins at a seed, frame L. False where that lies in no cell.
  [[nodiscard]] bool start(const Vec3& seed) {
    if (!is_finite(seed) || !walk_->start(seed)) return false;
    loop_.start(walk_->end(), walk_->direction());
    builder_.start(walk_->end());
    return true;
  }

  /// Follows the line by a piece. True where it has ended: line() is whole.
  [[nodiscard]] bool advance() {
    const std::optional<End> ended = walk_->advance();
    if (walk_->has_piece()) {
      const auto closing =
          ended ? std::nullopt : loop_.closes(*walk_, walk_->begin(), walk_->end(), walk_->direction());
      if (closing) {
        builder_.add_last(*walk_, walk_->end(), walk_->turn_cosine(), closing->theta, closing->why);
        return true;
      }
      if (builder_.add(*walk_, walk_->end(), walk_->turn_cosine())) return true;
    }
    if (ended) builder_.finish(*ended);
    return ended.has_value();
  }

  /// The line, or the part of it since restore(): its first point is then the last one before.
  [[nodiscard]] Line line() const { return builder_.take(); }
  [[nodiscard]] std::int64_t steps() const noexcept { return builder_.steps(); }
  [[nodiscard]] std::int64_t stiff_steps() const noexcept { return walk_->stiff_steps(); }

  /// @name As LineWalk has it
  /// @{
  [[nodiscard]] std::int64_t cell() const { return walk_->cell(); }
  [[nodiscard]] bool movable() const { return walk_->movable(); }
  void save(StateWriter& out) const {
    walk_->save(out);
    builder_.save(out);
    out(loop_);
  }
  void restore(StateReader& in) {
    walk_->restore(in);
    builder_.restore(in);
    in(loop_);
  }
  /// @}

 private:
  std::unique_ptr<LineWalk> walk_;
  LineBuilder builder_;
  LoopDetector loop_;
};

/// What all lines of a trace share.
class LineTracing {
 public:
  /// @pre both outlive this. @throws Error (usage) as trace_lines().
  LineTracing(const VectorField& field, const TraceOptions& options);

  [[nodiscard]] Integrator integrator() const noexcept { return integrator_; }
  /// A tracer for one thread, for any number of lines.
  [[nodiscard]] LineTracer tracer(TraceDirection direction) const {
    return {factory_->make(direction), LineBuilder(field_.frame(), limits_, direction)};
  }

 private:
  const VectorField& field_;
  Integrator integrator_;
  LineLimits limits_;
  std::optional<WalkFactory> factory_;
};

}  // namespace palpate
