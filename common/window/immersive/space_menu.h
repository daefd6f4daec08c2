/// A menu in space, worked by what a stylus or the mouse points at: entries, entries with more behind them,
/// sliders and knobs. Pointing alone opens what is behind an entry (Ikits 2006, sec. 3.2: preferred to
/// gestures), the button chooses, and drags sliders and knobs, over detents where they have such.
///
/// Symbols. A place (u, v) on the menu: u to the right, v down, in heights of an entry, from its upper left
/// corner. An entry is a row, a slider one and a half, a knob three; what is behind an entry lies in a column
/// at its right that begins beside it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/hand/technique/scene_pick.h"
#include "common/haptics/widget/dial_chain.h"
#include "common/render/label/label_view.h"

namespace palpate {

/// A number that is set along a way, by a slider or a knob, with detents where it rests.
struct DialRange {
  double lower = 0.0, upper = 1.0;  ///< lower < upper
  double step = 0.0;                ///< between detents, from lower on; 0: there are none

  /// The value that a hand asks for, within the range; on a detent where there are such. The next detent is
  /// gone to when the hand is beyond the middle by a tenth of a step, so that a trembling one does not
  /// flicker.
  [[nodiscard]] double held(double asked, double current) const noexcept {
    const double within = std::clamp(asked, lower, upper);
    if (!(step > 0.0)) return within;
    constexpr double kBeyond = 0.6;  // steps
    if (std::abs(within - current) <= kBeyond * step) return current;
    return std::clamp(lower + step * std::round((within - lower) / step), lower, upper);
  }
  /// From 0 at the lower end to 1 at the upper one.
  [[nodiscard]] double part(double value) const noexcept { return (value - lower) / (upper - lower); }
  [[nodiscard]] double at_part(double part) const noexcept { return lower + part * (upper - lower); }
};

struct SpaceItem {
  enum class Kind : std::uint8_t { kEntry, kSlider, kKnob };

  std::string label;
  int id = 0;  ///< told where it is chosen or set; of sliders and knobs above 0 and its own
  Kind kind = Kind::kEntry;
  DialRange range;                  ///< of a slider or knob; a knob's whole turn is all of it
  double value = 0.0;               ///< at the start
  std::vector<SpaceItem> behind{};  ///< of an entry: what it opens
};

/// What the user did.
struct SpaceEvent {
  enum class Kind : std::uint8_t { kNone, kChosen, kSet };

  Kind kind = Kind::kNone;
  int id = 0;
  double value = 0.0;  ///< that was set
};

class SpaceMenu {
 public:
  static constexpr double kColumn = 7.0;  ///< width of one [entries]

  explicit SpaceMenu(std::vector<SpaceItem> items);

  /// Where it is: its upper left corner, right, up and towards the viewer, height of an entry.
  void put(const Vec3& corner, const Mat3& axes, double entry) noexcept;
  /// What is pointed at, with the button up or down.
  SpaceEvent point(const Ray& ray, bool button);
  /// Nothing is pointed at any more, and nothing held.
  void leave() noexcept;

  /// Whether the ray meets it, or a slider or knob is held: then the hand is the menu's.
  [[nodiscard]] bool meets(const Ray& ray) const;
  [[nodiscard]] bool held() const noexcept { return held_.has_value(); }
  /// The way of the slider or knob that is held, as a hand on the menu would go along it: a knob that was
  /// taken anywhere turns from there, so its detents lie where that hand passes them.
  [[nodiscard]] std::optional<Dial> held_way() const;
  /// Of a slider or knob. @pre there is one with this id.
  [[nodiscard]] double value(int id) const;
  void set(int id, double value);
  /// The label of what is pointed at; empty where nothing is.
  [[nodiscard]] std::string pointed_label() const;
  [[nodiscard]] LabelView drawn() const;

 private:
  using Path = std::vector<std::size_t>;  ///< indices, from the first column on
  struct Placed {
    Path path;
    const SpaceItem* item = nullptr;
    double u = 0.0, v = 0.0, height = 1.0;
  };
  [[nodiscard]] std::vector<Placed> placed() const;
  [[nodiscard]] std::optional<Vec2> met(const Ray& ray) const;
  [[nodiscard]] SpaceItem& item_at(const Path& path);
  [[nodiscard]] const SpaceItem& item_at(const Path& path) const;
  SpaceEvent drag(const Vec2& at);

  std::vector<SpaceItem> items_;
  Vec3 corner_{0.0};
  Mat3 axes_{1.0};
  double entry_ = 1.0;
  Path open_;                    ///< entries whose columns are shown
  std::optional<Path> pointed_;  ///< at
  bool button_ = false;          ///< was down

  /// A slider or knob that is held.
  struct Held {
    Path path;
    Vec2 middle{0.0};    ///< of a knob, or the left end of a slider's way
    double from = 0.0;   ///< value that the hand asks for, not held by detents
    double angle = 0.0;  ///< of the hand about the middle of a knob, the last time [rad]
    double least = 0.0;  ///< and where it would be at the lowest value
  };
  std::optional<Held> held_;
};

}  // namespace palpate
