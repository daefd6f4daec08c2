/// Undo and redo of anything that can be copied and compared, as snapshots of it.
#pragma once

#include <cstddef>
#include <deque>
#include <utility>

#include "common/base/check.h"

namespace palpate {

/// @tparam State copied once a step; states that are equal are no step from each other.
template <typename State>
class History {
 public:
  static constexpr std::size_t kMostSteps = 200;

  explicit History(State now) : now_(std::move(now)) {}

  /// An edit has led to `state`, and what was undone is forgotten; no edit where that is equal to now().
  void push(State state) {
    if (state == now_) {
      now_ = std::move(state);
      return;
    }
    past_.push_back(std::exchange(now_, std::move(state)));
    if (past_.size() > kMostSteps) past_.pop_front();
    future_.clear();
  }
  /// It is `state` without an edit: a default is known now.
  void settle(State state) { now_ = std::move(state); }
  /// The last edit has come to nothing, and it is `state` again.
  void fail(State state) {
    settle(std::move(state));
    if (can_undo() && past_.back() == now_) past_.pop_back();
  }

  [[nodiscard]] bool can_undo() const noexcept { return !past_.empty(); }
  [[nodiscard]] bool can_redo() const noexcept { return !future_.empty(); }
  /// Both return the state as it is then. @pre can_undo(), can_redo().
  const State& undo() { return step(past_, future_); }
  const State& redo() { return step(future_, past_); }
  [[nodiscard]] const State& now() const noexcept { return now_; }

 private:
  const State& step(std::deque<State>& from, std::deque<State>& to) {
    PALPATE_CHECK(!from.empty());
    to.push_back(std::exchange(now_, std::move(from.back())));
    from.pop_back();
    return now_;
  }

  State now_;
  std::deque<State> past_, future_;  ///< the nearest last
};

}  // namespace palpate
