/// A cutting-plane widget in a chain, without a device or a safety stage.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "common/haptics/proxy_chain.h"
#include "common/haptics/widget/plane_widget.h"

namespace palpate::test {

/// A widget about the origin with its plane across z, in metres, and a hand that goes to places.
class Bench {
 public:
  explicit Bench(double detent = 0.0, const Mat3& data_axes = Mat3{1.0})
      : Bench(with_detent(detent), data_axes) {}
  /// @param scale metres per data unit.
  explicit Bench(const ChainSettings& settings, const Mat3& data_axes = Mat3{1.0}, double scale = 1.0)
      : settings_(settings) {
    std::vector<std::unique_ptr<Constraint>> links;
    widget_ = std::make_shared<PlaneWidget>(scale, data_axes, PlanePose{}, news_);
    for (int place = 0; place < PlaneWidget::kLinks; ++place)
      links.push_back(std::make_unique<PlaneWidgetLink>(widget_, place));
    chain_ = std::make_unique<ProxyChain>(std::move(links), settings_);
  }

  /// One step of the chain at `x`.
  ChainStep at(const Vec3& x, bool down = false) {
    chain_->press(down ? 1U : 0U);
    return chain_->step(x);
  }
  /// A straight way there in steps of at most a tenth of a millimetre.
  ChainStep lead(const Vec3& to, bool down) {
    const int steps = 1 + static_cast<int>(glm::distance(to, hand_) / 1e-4);
    ChainStep step;
    for (int i = 1; i <= steps; ++i) step = at(glm::mix(hand_, to, static_cast<double>(i) / steps), down);
    hand_ = to;
    return step;
  }
  void put(const Vec3& x) { hand_ = x; }

  ProxyChain& chain() { return *chain_; }
  PlaneWidget& widget() { return *widget_; }
  ChainSettings& settings() { return settings_; }
  WidgetNews news() {
    (void)news_->read(last_news_);
    return last_news_;
  }

 private:
  [[nodiscard]] static ChainSettings with_detent(double detent) {
    ChainSettings settings;
    settings.plane_widget.detent = detent;
    return settings;
  }

  ChainSettings settings_;
  std::shared_ptr<WidgetNewsBuffer> news_ = std::make_shared<WidgetNewsBuffer>();
  std::shared_ptr<PlaneWidget> widget_;
  std::unique_ptr<ProxyChain> chain_;
  Vec3 hand_{0.2};
  WidgetNews last_news_;
};

}  // namespace palpate::test
