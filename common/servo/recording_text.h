/// The lines of a recording (recording.h), as text. Recorder and FaultRecorder write with it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "common/servo/recording.h"

namespace palpate {

/// `text` as one line whatever is in it, and short enough to be read again.
[[nodiscard]] std::string one_line(std::string_view text);

class RecordingText {
 public:
  /// @param compared whether sums of what was felt are written, for a replay to be compared with.
  explicit RecordingText(bool compared = true) : compared_(compared) {}

  /// Up to `begin`. @pre keys without spaces.
  void header(const RecordingHeader& header);
  void chain(std::uint64_t step, std::string_view description);
  void settings(std::uint64_t step, const ChainSettings& settings);
  void change(std::uint64_t step, HandSwitch change);
  /// The step, and that a fault began or all of a block was felt where that is so.
  void step(const HandInput& input, const HandStep& step);
  void overrun(const Overrun& overrun);
  void event(std::uint64_t step, std::uint64_t frame, std::string_view text);
  void lost(std::uint64_t count);
  void end();

  /// What was added since the last clear().
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  void clear() noexcept { text_.clear(); }

 private:
  void hash();

  bool compared_;
  std::string text_;
  StepHash hash_;
  ForceCut cut_ = ForceCut::kNone;  ///< of the last step
};

}  // namespace palpate
