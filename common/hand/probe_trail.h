/// What the hand leaves behind: its path, the line that it follows with the forces felt along it, the tracts
/// that it draws, and the lines that were kept.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/hand/drawn/drawn_lines.h"
#include "common/hand/drawn/followed_curve.h"
#include "common/hand/drawn/tract_drawing.h"
#include "common/hand/haptic_data.h"
#include "common/hand/probe_readout.h"
#include "common/hand/touch_choice.h"
#include "common/render/probe_view.h"

namespace palpate {

/// What a hand has made, cheap to copy: lines that are kept, and tracts that are drawn and not kept yet. Both
/// are the same where they are the same objects.
struct HandMade {
  std::shared_ptr<const DrawnLines::Entries> kept;
  std::shared_ptr<const std::vector<DrawnTract>> drawn;  ///< null where there are no tensors

  bool operator==(const HandMade&) const = default;
};

class ProbeTrail {
 public:
  /// `data` outlives it.
  explicit ProbeTrail(const HapticData& data) : data_(data) {}

  /// Goes on with the field that has just been opened. What was made stays: lines of another time step lie in
  /// the same space.
  void open_data();
  /// From now on the line that this chain follows is drawn.
  void follow(const HapticChain& made);

  /// Takes a step of the servo. @param on_dial the hand holds a slider or knob: that is neither path nor
  /// tract.
  void take(const HandStep& step, bool on_dial, StrokeUse stroke);
  /// Once a frame, after its steps: the followed line grows, and what is at the probe is sampled.
  void update(bool show_balls, const LineStyle& style);
  /// @param force_cap [N]
  void describe(const TouchChoice& choice, double force_cap, bool on_dial, ProbeView& view) const;
  [[nodiscard]] const ProbeReadout& readout() const noexcept { return readout_; }
  [[nodiscard]] ProbeReadout& readout() noexcept { return readout_; }
  /// Whether the followed line grew in the last update().
  [[nodiscard]] bool growing() const noexcept { return growing_; }

  enum class Keeping : std::uint8_t { kKept, kAlready, kNothing };
  /// Keeps the line that is followed, or was last, with the forces felt along it; of tensors, the tracts that
  /// were drawn.
  Keeping keep_line();
  /// Keeps instead the one that note_line() has noted, if the hand has not been let go since.
  Keeping keep_noted_line();
  /// Keeps a line of the scene that was picked; nothing is known of forces along it.
  Keeping keep_picked(const Line& line) { return keep(line, forces_along(line, {})); }
  /// Notes the line that is followed now, or how far the tract is drawn, while the hand rests: on its way to
  /// a panel it may slip to others.
  void note_line();
  /// The hand takes the probe elsewhere.
  void forget_note();
  [[nodiscard]] const DrawnLines& drawn_lines() const noexcept { return drawn_lines_; }
  /// Takes out the line at `index`. @pre index < drawn_lines().entries().size().
  void remove_kept(std::size_t index) { drawn_lines_.remove(index); }
  /// What was made up to now, without a stroke that is being drawn.
  [[nodiscard]] HandMade made() const;
  /// Goes back to that, or on to it; a stroke that is being drawn ends.
  void put(const HandMade& made);
  /// Another input is open: forgets what was made, and the numbers of lines.
  void forget();
  void clear_path();
  /// Tracts that are drawn and not kept yet; none where there are no tensors.
  [[nodiscard]] std::span<const DrawnTract> drawn() const noexcept {
    return drawing_ ? std::span<const DrawnTract>(drawing_->tracts()) : std::span<const DrawnTract>();
  }

 private:
  struct NotedLine {
    Line line;
    std::vector<double> forces;
  };
  Keeping keep(const Line& line, std::vector<double> forces);
  /// The streamline that is followed, or the way of the hand on a wall since it last took hold there; none of fewer
  /// than two points.
  [[nodiscard]] std::optional<NotedLine> followed() const;
  void read_step(const HandStep& step);
  void draw_path(const HandStep& step, bool on_line, StrokeUse stroke);

  const HapticData& data_;
  std::optional<FollowedCurve> curve_;
  bool follows_surface_ = false;
  std::shared_ptr<ProbePath> path_;
  std::vector<HapticForce> haptic_forces_;  ///< since the line was caught
  bool other_line_ = false;                 ///< it was let go, or another one caught, since then
  bool held_before_ = false;                ///< something has held this hand since it took the probe
  bool growing_ = false;
  std::optional<NotedLine> noted_;
  std::optional<TractDrawing> drawing_;  ///< where there are tensors
  DrawnLines drawn_lines_;
  ProbeReadout readout_;
  ReadoutHints hints_;
};

}  // namespace palpate
