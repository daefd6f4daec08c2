#include "common/scene/document/history.h"

#include <utility>

#include "common/base/check.h"

namespace palpate {

void DocumentHistory::push(const Document& document, const std::string& what, bool drag) {
  if (document == now_) return;
  const bool goes_on = drag && !dragged_.empty() && dragged_ == what && !past_.empty();
  if (!goes_on) {
    past_.push_back({std::move(now_), what});
    if (past_.size() > kMostSteps) past_.pop_front();
  }
  now_ = document;
  future_.clear();
  dragged_ = drag ? what : std::string();
}

const Document& DocumentHistory::undo() {
  PALPATE_CHECK(can_undo());
  Step step = std::move(past_.back());
  past_.pop_back();
  future_.push_back({std::exchange(now_, std::move(step.document)), std::move(step.what)});
  dragged_.clear();
  return now_;
}

const Document& DocumentHistory::redo() {
  PALPATE_CHECK(can_redo());
  Step step = std::move(future_.back());
  future_.pop_back();
  past_.push_back({std::exchange(now_, std::move(step.document)), std::move(step.what)});
  dragged_.clear();
  return now_;
}

}  // namespace palpate
