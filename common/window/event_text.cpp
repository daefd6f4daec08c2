#include "common/window/event_text.h"

#include <array>
#include <sstream>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

// By InputKind.
constexpr std::array<std::string_view, 7> kKinds{"move",    "press", "release", "wheel",
                                                 "keydown", "keyup", "text"};

}  // namespace

std::string event_text(const InputEvent& event) {
  const auto kind = as_size(event.kind);
  if (kind >= kKinds.size()) return {};
  std::string text(kKinds[kind]);
  switch (event.kind) {
    case InputKind::kMove:
    case InputKind::kWheel:
      return text + ' ' + exact_number(event.x) + ' ' + exact_number(event.y);
    case InputKind::kPress:
    case InputKind::kRelease:
      return text + ' ' + std::to_string(static_cast<int>(event.button));
    default:
      return text + ' ' + std::to_string(event.key) + ' ' + std::to_string(event.modifiers);
  }
}

std::optional<InputEvent> event_from_text(std::string_view text) {
  std::istringstream words{std::string(text)};
  std::string kind;
  words >> kind;
  InputEvent event;
  std::size_t i = 0;
  while (i < kKinds.size() && kKinds[i] != kind) ++i;
  if (i == kKinds.size()) return std::nullopt;
  event.kind = static_cast<InputKind>(i);
  int button = 0;
  switch (event.kind) {
    case InputKind::kMove:
    case InputKind::kWheel:
      words >> event.x >> event.y;
      break;
    case InputKind::kPress:
    case InputKind::kRelease:
      words >> button;
      if (button < 0 || button > 2) return std::nullopt;
      event.button = static_cast<MouseButton>(button);
      break;
    default:
      words >> event.key >> event.modifiers;
      break;
  }
  return words.fail() ? std::nullopt : std::optional(event);
}

}  // namespace palpate
