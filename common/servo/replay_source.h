/// Plays a recording back through the same step that made it, and says whether the result is the same.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/servo/hand_step.h"
#include "common/servo/recording.h"

namespace palpate {

/// How a replay compares with its recording so far.
struct ReplayVerdict {
  std::uint64_t steps = 0;    ///< played
  std::uint64_t same = 0;     ///< so many from the start have the recorded proxies and forces, bit for bit
  std::uint64_t differs = 0;  ///< the first difference lies before this step, after `same`; 0: none seen
};

class ReplaySource {
 public:
  /// Makes a chain from the words that describe it in the recording.
  using ChainMaker = std::function<std::unique_ptr<ProxyChain>(const std::string& description)>;

  /// Makes all chains of the recording, so that no step has to wait for one.
  /// @throws whatever `make_chain` throws.
  ReplaySource(Recording recording, const ChainMaker& make_chain);

  [[nodiscard]] const Recording& recording() const noexcept { return recording_; }
  [[nodiscard]] bool done() const noexcept { return next_ == recording_.steps.size(); }
  /// When the next step is due [s] after the first, at the recorded pace. Time that ran backwards counts as
  /// no time, and a pause as kLongestPause at most. @pre !done().
  [[nodiscard]] double due() const noexcept { return due_; }
  /// The next step, with what happened before it. @pre !done(). @rt Safe.
  [[nodiscard]] HandStep step() noexcept;
  [[nodiscard]] const ReplayVerdict& verdict() const noexcept { return verdict_; }

  static constexpr double kLongestPause = 1.0;  ///< [s]

 private:
  void apply_changes_before(std::uint64_t number) noexcept;
  void compare() noexcept;

  Recording recording_;
  std::vector<std::unique_ptr<ProxyChain>> chains_;  ///< before their turn and after it
  HandStepper stepper_;
  StepHash hash_;
  ReplayVerdict verdict_;
  std::size_t next_ = 0;
  std::size_t next_change_ = 0;
  std::size_t next_hash_ = 0;
  double due_ = 0.0;
};

/// One sentence for the user: "identical: 1200 of 1200 steps", "differs between steps 256 and 511", and what
/// the recording itself lacks.
[[nodiscard]] std::string verdict_text(const ReplayVerdict& verdict, const Recording& recording);

}  // namespace palpate
