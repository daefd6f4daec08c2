#include "common/window/input_event.h"

#include <algorithm>

#include "common/window/keys.h"

namespace palpate {
namespace {

bool is_button(const InputEvent& event) {
  return event.kind == InputKind::kPress || event.kind == InputKind::kRelease;
}

bool is_key(const InputEvent& event) {
  return event.kind == InputKind::kKeyDown || event.kind == InputKind::kKeyUp;
}

/// Whether a frame that has taken those of `taken` would not show that `next` came after them.
bool hides(std::span<const InputEvent> taken, const InputEvent& next) {
  if (next.kind == InputKind::kMove || is_button(next)) return std::ranges::any_of(taken, is_button);
  return is_key(next) && std::ranges::any_of(taken, [&](const InputEvent& before) {
           return is_key(before) && before.key == next.key && before.kind != next.kind;
         });
}

}  // namespace

std::size_t events_of_frame(std::span<const InputEvent> events) {
  const bool force_off = std::ranges::any_of(
      events, [](const InputEvent& event) { return command_of(event) == Command::kForceOff; });
  if (force_off) return events.size();
  std::size_t count = 0;
  while (count < events.size() && !hides(events.first(count), events[count])) ++count;
  return count;
}

}  // namespace palpate
