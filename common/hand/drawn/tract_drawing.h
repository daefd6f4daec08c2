/// Tracts that the hand draws in the window: strokes from the steps of the servo, and their path for the
/// picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/hand/drawn/drawn_tract.h"
#include "common/render/probe_view.h"
#include "common/servo/hand_step.h"

namespace palpate {

class TractDrawing {
 public:
  explicit TractDrawing(const std::shared_ptr<const TensorField>& field);

  /// Draws on where the tensors hold the proxy. @param proxy [data units].  @param force [N].
  void draw(const HandStep& step, const Vec3& proxy, double force, StrokeUse use);
  void let_go() { pen_.let_go(); }
  void clear() { (void)pen_.take(); }

  [[nodiscard]] const std::vector<DrawnTract>& tracts() const noexcept { return pen_.tracts(); }
  /// The stroke has yet to go on from an end: the path does not show it.
  [[nodiscard]] bool joining() const noexcept { return pen_.joining(); }
  /// Whether more of the tracts has changed, since path() was called, than a point at the end of the last.
  [[nodiscard]] bool redrawn() const noexcept { return pen_.edits() != shown_edits_; }
  /// The path along the tracts as they are, for steps to be added to.
  [[nodiscard]] std::shared_ptr<ProbePath> path();

  /// Notes how far the tract is drawn; cut_to_note() takes out what the same stroke has added since.
  void note();
  void forget_note() noexcept { noted_.reset(); }
  void cut_to_note();

  /// Gives the tracts to `kept`; false where there are none.
  bool keep(DrawnLines& kept);
  /// TractPen::drawn() and put().
  [[nodiscard]] const std::shared_ptr<const std::vector<DrawnTract>>& drawn() const noexcept {
    return pen_.drawn();
  }
  void put(std::shared_ptr<const std::vector<DrawnTract>> drawn) { pen_.put(std::move(drawn)); }

 private:
  struct Note {
    std::uint64_t edits = 0;
    std::size_t points = 0;
  };

  double spacing_;  ///< of points [data units]
  TractPen pen_;
  std::uint64_t shown_edits_ = 0;
  std::optional<Note> noted_;
};

}  // namespace palpate
