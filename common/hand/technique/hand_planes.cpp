#include "common/hand/technique/hand_planes.h"

#include <utility>

namespace palpate {

void HandPlanes::follow(std::shared_ptr<WidgetNewsBuffer> told) {
  told_ = std::move(told);
  news_.reset();
}

void HandPlanes::read(int edit) {
  WidgetNews news;
  if (!told_ || !told_->read(news) || news.edit != edit) return;
  const auto moves = [](const WidgetNews& each) {
    return each.state == WidgetState::kTranslate || each.state == WidgetState::kRotate;
  };
  if (news_ && moves(news) && !moves(*news_)) remember();
  news_ = news;
}

void HandPlanes::remember() {
  if (news_) before_.push_back(news_->poses);
}

std::optional<PlanePoses> HandPlanes::undo() {
  if (!told_ || before_.empty()) return std::nullopt;
  const PlanePoses poses = before_.back();
  before_.pop_back();
  return poses;
}

}  // namespace palpate
