#include "common/hand/technique/hand_planes.h"

#include <utility>

namespace palpate {

void HandPlanes::follow(std::shared_ptr<WidgetNewsBuffer> told) {
  reported_ = std::move(told);
  news_.reset();
}

void HandPlanes::read(int edit) {
  WidgetNews news;
  if (!reported_ || !reported_->read(news) || news.edit != edit) return;
  news_ = news;
}

}  // namespace palpate
