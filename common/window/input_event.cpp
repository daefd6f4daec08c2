#include "common/window/input_event.h"

#include <algorithm>
#include <array>

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
  if ((is_key(next) || next.kind == InputKind::kText) && std::ranges::any_of(taken, is_button)) return true;
  return is_key(next) && std::ranges::any_of(taken, [&](const InputEvent& before) {
           return is_key(before) && before.key == next.key && before.kind != next.kind;
         });
}

}  // namespace

int modifiers_after(const InputEvent& event) noexcept {
  struct Pair {
    int left, right;  // GLFW's numbers
    int bit;
  };
  constexpr std::array<Pair, 3> kKeys{
      {{340, 344, kModifierShift}, {341, 345, kModifierControl}, {342, 346, kModifierAlt}}};
  for (const Pair& pair : kKeys) {
    if (event.key != pair.left && event.key != pair.right) continue;
    return event.kind == InputKind::kKeyDown ? event.modifiers | pair.bit : event.modifiers & ~pair.bit;
  }
  return event.modifiers;
}

std::size_t events_of_frame(std::span<const InputEvent> events) {
  const bool force_off = std::ranges::any_of(
      events, [](const InputEvent& event) { return command_of(event) == Command::kForceOff; });
  if (force_off) return events.size();
  std::size_t count = 0;
  while (count < events.size() && !hides(events.first(count), events[count])) ++count;
  return count;
}

bool wants_answer(std::span<const InputEvent> events) {
  return std::ranges::any_of(events, [](const InputEvent& event) { return event.kind != InputKind::kMove; });
}

}  // namespace palpate
