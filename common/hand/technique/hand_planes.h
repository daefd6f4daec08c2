/// Cutting planes that the hand moves, as the window knows them: what the servo tells of them.
#pragma once

#include <memory>
#include <optional>

#include "common/haptics/widget/plane_widget.h"

namespace palpate {

class HandPlanes {
 public:
  /// From now on those of the chain that is felt; null: it has none.
  void follow(std::shared_ptr<WidgetNewsBuffer> told);
  /// Takes what the servo has told since. What is told of an edit before `edit` says nothing.
  void read(int edit);

  /// Whether the chain has planes, told of or not.
  [[nodiscard]] bool there() const noexcept { return reported_ != nullptr; }
  /// What the servo told last; none in other modes, and before it tells.
  [[nodiscard]] const std::optional<WidgetNews>& news() const noexcept { return news_; }

 private:
  std::shared_ptr<WidgetNewsBuffer> reported_;
  std::optional<WidgetNews> news_;
};

}  // namespace palpate
