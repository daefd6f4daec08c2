/// One place in the chain of a cutting-plane widget: whichever of its constraints the state puts there.
#pragma once

#include <memory>
#include <utility>

#include "common/haptics/widget/plane_widget.h"

namespace palpate {

class PlaneWidgetLink final : public Constraint {
 public:
  /// @param place in the chain, from 0 to PlaneWidget::kLinks - 1; all of them stand in it, in order.
  PlaneWidgetLink(std::shared_ptr<PlaneWidget> widget, int place)
      : widget_(std::move(widget)), place_(place) {}

  void apply(const ChainSettings& settings) noexcept override {
    if (place_ == 0) widget_->apply(settings);
  }
  void reset() noexcept override {
    if (place_ == 0) widget_->lose();
  }
  void press(std::uint32_t buttons) noexcept override {
    if (place_ == 0) widget_->press((buttons & 1U) != 0);
  }
  void update(const Vec3& probe, const UpdateBudget& /*budget*/, LinkUpdate& link) noexcept override {
    if (place_ == 0) widget_->update(probe);
    link = widget_->link(place_);
  }

 private:
  std::shared_ptr<PlaneWidget> widget_;
  int place_;
};

}  // namespace palpate
