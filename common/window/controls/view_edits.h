/// What the user has edited in the view and may take back: the region of interest, and the grey values of
/// planes. Planes that a hand moves keep a memory of their own (hand_planes.h): the two are taken back in the
/// order in which they came.
#pragma once

#include <optional>
#include <vector>

#include "common/field/value_histogram.h"
#include "common/haptics/constraint/plane_widget_settings.h"
#include "common/math/vec.h"

namespace palpate {

struct EditedView {
  std::optional<Box> region;
  std::optional<ValueWindow> window;
};

class ViewEdits {
 public:
  /// Once a frame. @param planes of the hand. @param resting nothing is being dragged: a drag is one edit.
  void follow(const EditedView& now, const PlanePoses& planes, bool resting);
  /// What the view was before the last edit; nothing where there is none, or the planes were moved since.
  [[nodiscard]] std::optional<EditedView> undo(const PlanePoses& planes);
  /// Of another input: nothing is to be taken back.
  void forget() noexcept;

 private:
  struct Edit {
    EditedView before;
    PlanePoses planes;  ///< when it was done
  };
  std::optional<EditedView> settled_;
  std::vector<Edit> edits_;
};

}  // namespace palpate
