/// The streamline that is being followed, shared by the thread that grows it and one that draws it.
///
/// Three lines take turns: the current one, one that the reader may still be looking at, and one to begin the
/// next in. Nobody waits and nothing is copied.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>

#include "common/base/index.h"
#include "common/trace/growing_line.h"

namespace palpate {

class LiveLine {
 public:
  /// What hands follow is traced to this. Ten times tighter than what is promised of the proxy, so that a
  /// line may be followed over several diagonals.
  static constexpr double kFollowTolerance = 1e-7;

  /// Prepares the walks and all storage. @param tolerance of the tracing, relative to the diagonal.
  LiveLine(std::shared_ptr<const VectorField> field, double tolerance, int threads);

  [[nodiscard]] const VectorField& field() const noexcept { return *field_; }
  [[nodiscard]] const GrowthLimits& limits() const noexcept { return limits_; }

  /// @name By the thread that follows
  /// @{

  /// The line that is followed, or null.
  [[nodiscard]] GrowingLine* current() noexcept {
    const int now = current_.load(std::memory_order_relaxed);
    return now < 0 ? nullptr : lines_[as_size(now)].get();
  }
  [[nodiscard]] const GrowingLine* current() const noexcept {
    const int now = current_.load(std::memory_order_relaxed);
    return now < 0 ? nullptr : lines_[as_size(now)].get();
  }
  /// Begins a line in place of the current one. False, and nothing changes, where none begins at `seed`.
  [[nodiscard]] bool start(const Vec3& seed, double arc = 0.0, double time = 0.0) noexcept;
  /// Follows no line.
  void drop() noexcept;
  /// @}

  /// By one other thread: calls `look(const GrowingLine*, number)`, with null where no line is followed. Each
  /// start() gives another number > 0. The nodes stay as they are until it returns; more may come meanwhile.
  template <class Look>
  void read(const Look& look) const {
    for (;;) {
      const int seen = current_.load();
      held_.store(seen);
      if (current_.load() != seen) continue;  // it went on before the hold could be seen
      if (seen < 0) {
        look(static_cast<const GrowingLine*>(nullptr), std::uint64_t{0});
      } else {
        const auto slot = as_size(seen);
        look(static_cast<const GrowingLine*>(lines_[slot].get()), numbers_[slot]);
      }
      held_.store(-1);
      return;
    }
  }

 private:
  static constexpr int kLines = 3;

  std::shared_ptr<const VectorField> field_;
  GrowthLimits limits_;
  std::unique_ptr<const WalkFactory> factory_;
  std::array<std::unique_ptr<GrowingLine>, kLines> lines_;
  std::atomic<int> current_{-1};
  mutable std::atomic<int> held_{-1};            ///< what the reader looks at
  std::array<std::uint64_t, kLines> numbers_{};  ///< of each line; written before it becomes current
  std::uint64_t started_ = 0;
};

}  // namespace palpate
