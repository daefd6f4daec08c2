/// Picking in space by a tracked stylus or a device in the hand: what it points at is named in the picture,
/// and its button takes hold of it from afar (Ikits 2006, sec. 3.2: what lies behind the screen cannot be
/// touched).
///
///   cutting plane, lens    goes with the hand, a plane turned as the stylus is; the place that was picked
///                          stays where it was in the hand
///   line                   is kept, and a stylus goes on from there
///
/// The other hand carries the lens that was picked last, in modes without cutting planes of their own.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "common/hand/probe_session.h"
#include "common/hand/technique/scene_pick.h"

namespace palpate {

/// A hand that points, this frame. Data coordinates.
struct PickingHand {
  Rigid pose;     ///< of the stylus at its tip; of a device without turn
  PickBeam beam;  ///< it points along
  bool presses = false;
  bool can_move = false;         ///< the probe can be put elsewhere, where it goes on
  std::optional<Rigid> carried;  ///< HandsIntent::carried
};

/// The hand of the session as the eye of a camera sees it: nothing where a mouse leads it, or none is there.
/// @pre the session has data.
[[nodiscard]] std::optional<PickingHand> picking_hand(ProbeSession& touch, const Camera& seeing);

class PickControl {
 public:
  /// Once a frame, before the session's update. Changes the lenses and cuts of `view`, and the planes and
  /// kept lines of `touch`.
  /// @param hand none: nothing is pointed at, and what was held is let go.
  /// @return what to say to the user; nothing where nothing happened.
  std::optional<std::string> follow(const std::optional<PickingHand>& hand, SceneView& view,
                                    ProbeSession& touch);
  /// What is pointed at, or held.
  [[nodiscard]] const std::optional<Picked>& picked() const noexcept { return picked_; }
  /// Whether something is held, or moved since the last call.
  [[nodiscard]] bool holding() const noexcept { return held_.has_value(); }

 private:
  /// What the hand has hold of, as it was then.
  struct Held {
    Picked picked;
    Rigid grip;
    ConvexShape shape;                ///< of a lens
    ConvexShape::HalfSpace kept;      ///< of a cut
    std::optional<PlanePoses> poses;  ///< of planes that the hand moves
  };
  std::string take_hold(const PickingHand& hand, const SceneView& view, ProbeSession& touch);
  void move_held(const PickingHand& hand, SceneView& view, ProbeSession& touch) const;
  void carry_lens(const PickingHand& hand, SceneView& view, const ProbeSession& touch);

  std::optional<Picked> picked_;
  std::optional<Held> held_;
  std::optional<std::size_t> lens_;     ///< that was picked last
  std::optional<ConvexShape> carried_;  ///< when the other hand took hold of it
  bool pressed_ = false;
};

}  // namespace palpate
