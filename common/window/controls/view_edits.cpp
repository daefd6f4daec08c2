#include "common/window/controls/view_edits.h"

namespace palpate {
namespace {

bool same_edits(const EditedView& a, const EditedView& b) {
  if (a.region.has_value() != b.region.has_value() || a.window != b.window) return false;
  return !a.region || (a.region->lower == b.region->lower && a.region->upper == b.region->upper);
}

}  // namespace

void ViewEdits::follow(const EditedView& now, const PlanePoses& planes, bool resting) {
  if (!resting) return;
  if (settled_ && !same_edits(*settled_, now)) edits_.push_back({*settled_, planes});
  settled_ = now;
}

std::optional<EditedView> ViewEdits::undo(const PlanePoses& planes) {
  if (edits_.empty() || !(edits_.back().planes == planes)) return std::nullopt;
  settled_ = edits_.back().before;
  edits_.pop_back();
  return settled_;
}

void ViewEdits::forget() noexcept {
  settled_.reset();
  edits_.clear();
}

}  // namespace palpate
