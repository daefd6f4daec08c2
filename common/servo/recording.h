/// Recordings of a run: the file of `--record` and `--replay`.
///
/// Plain text, an event a line, appended to while the run goes on; every number reads back to the same bits.
///
///   palpate-recording 1
///   program flow
///   version 0.1.0
///   build GCC 12.2.0, Release
///   input BYTES SHA256|- FILE
///   set KEY VALUE                             anything the program wants to know again
///   limits CAP SLEW GATE STALE RAMP …         DeviceLimits, in the order of limits_fields()
///   begin
///   chain STEP DESCRIPTION                    before the step: another chain, in words of the program
///   settings STEP NAME=VALUE …                before the step: ChainSettings (haptics/settings_text.h)
///   switch STEP NAME                          before the step: HandSwitch
///   s STEP TIME SAMPLE_TIME X Y Z BUTTONS [HX HY HZ]  a step with a sample, and where the hand was if not there
///   n STEP TIME                               a step without a hand
///   fault STEP NAME                           a ForceCut that is a fault began at that step
///   overrun STEP SKIPPED LATE USED            the tick of that step overran (Overrun)
///   event STEP FRAME TEXT                     input of the window, seen when that step was next
///   hash STEPS HASH                           of proxies and forces of the first STEPS steps (StepHash)
///   lost COUNT                                the disk could not keep up: so many entries so far are missing
///   end STEPS
///
/// What comes before a step stands before its line; `event` and `overrun` lines may stand anywhere. Steps
/// rise. A file without `end` was cut off, and is good up to there.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include "common/haptics/chain_settings.h"
#include "common/servo/hand_step.h"

namespace palpate {

/// Steps between two `hash` lines.
inline constexpr std::uint64_t kHashBlock = 256;

/// An input file as it was when the run was recorded.
struct RecordedFile {
  std::string file;
  std::uint64_t bytes = 0;
  std::string sha256;  ///< 64 hexadecimal digits; empty where nobody has read the whole file

  bool operator==(const RecordedFile&) const = default;
};

/// What stands above `begin`. Line ends in texts become spaces; keys hold no space.
struct RecordingHeader {
  std::string program;  ///< the name that starts it
  std::string version;  ///< of the program
  std::string build;    ///< bits are the same on one build and processor type only
  std::vector<RecordedFile> inputs;
  std::vector<std::pair<std::string, std::string>> values;
  DeviceLimits limits;
};

struct RecordedStep {
  std::uint64_t number = 0;
  HandInput input;
};

/// A chain was put in place: Recording::chains[chain] says which.
struct ChainChange {
  std::uint32_t chain = 0;
};
using Change = std::variant<HandSwitch, ChainSettings, ChainChange>;
/// What happened before the step of that number.
struct RecordedChange {
  std::uint64_t step = 0;
  Change change;
};

/// Input of the window, in its own words.
struct RecordedEvent {
  std::uint64_t step = 0;  ///< the next one of the servo when it happened
  std::uint64_t frame = 0;
  std::string text;
};

/// A tick that ended after deadlines of later ones had passed.
struct Overrun {
  std::uint64_t step = 0;
  std::uint64_t skipped = 0;  ///< deadlines that had passed
  std::int64_t late = 0;      ///< [ns] after its deadline it had woken
  std::int64_t used = 0;      ///< [ns] of processor time

  bool operator==(const Overrun&) const = default;
};

struct RecordedFault {
  std::uint64_t step = 0;  ///< at which it began
  ForceCut cut = ForceCut::kNone;

  bool operator==(const RecordedFault&) const = default;
};

struct HashMark {
  std::uint64_t steps = 0;  ///< how many it covers
  std::uint64_t hash = 0;
};

struct Recording {
  RecordingHeader header;
  std::vector<std::string> chains;  ///< descriptions; one for each ChainChange, in order
  std::vector<RecordedStep> steps;  ///< numbers rise
  std::vector<RecordedChange> changes;
  std::vector<RecordedEvent> events;  ///< by step
  std::vector<HashMark> hashes;
  std::vector<RecordedFault> faults;
  std::vector<Overrun> overruns;
  std::uint64_t lost = 0;  ///< entries that were not written: the run cannot be repeated exactly
  bool ended = false;      ///< false for a file that was cut off
};

/// Reads a recording, in memory in proportion to the file.
/// @throws Error (bad input) naming the file, the line and what was expected. A last line without its end is
/// left out instead: the program that wrote it was killed.
[[nodiscard]] Recording read_recording(const std::string& file);

/// A running hash of proxies and forces, in the order of the steps: equal bits give equal hashes.
class StepHash {
 public:
  /// Not the number or the time of the step.
  void add(const HandStep& step) noexcept;
  [[nodiscard]] std::uint64_t value() const noexcept { return value_; }
  [[nodiscard]] std::uint64_t steps() const noexcept { return steps_; }

 private:
  void add(const Vec3& x) noexcept;
  void add(std::uint64_t word) noexcept;

  std::uint64_t value_ = 0x9E3779B97F4A7C15;  // any start but zero
  std::uint64_t steps_ = 0;
};

[[nodiscard]] std::string_view name_of(HandSwitch change) noexcept;  ///< "force_off"

/// The fields of DeviceLimits in the order of the file: reader and writer share them.
template <typename Limits>
auto limits_fields(Limits& l) noexcept {
  return std::tuple{&l.force_cap,       &l.slew_cap,      &l.velocity_gate,  &l.stale_after,
                    &l.start_ramp,      &l.fade_time,     &l.continuous_cap, &l.heating_time,
                    &l.reach_lower.x,   &l.reach_lower.y, &l.reach_lower.z,  &l.reach_upper.x,
                    &l.reach_upper.y,   &l.reach_upper.z, &l.edge_margin,    &l.edge_stiffness,
                    &l.enabling_button, &l.latch_faults};
}

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
