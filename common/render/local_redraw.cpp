#include "common/render/local_redraw.h"

#include <algorithm>

namespace palpate {

bool LocalRedraw::drawn(double milliseconds, bool kept) noexcept {
  if (kept) {
    full_ = first_ = milliseconds;
    since_ = slow_ = 0;
    return false;
  }
  ++since_;
  if (since_ <= kFirst) {
    first_ = since_ == 1 ? milliseconds : std::min(first_, milliseconds);
    if (since_ == kFirst && first_ >= full_) on_ = false;
    return false;
  }
  slow_ = milliseconds > 0.5 * (first_ + full_) ? slow_ + 1 : 0;
  return slow_ == kPatience;
}

}  // namespace palpate
