/// Search over the settings of a program: by name, label and help, from the document's table.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/scene/document/document.h"
#include "common/scene/document/setting.h"
#include "common/window/input_event.h"

namespace palpate {

/// Settings of programs of `kind` that sessions keep and that have each word of `typed` in their label, their name or
/// their help, whatever the case of letters: those whose label begins so first, then those with it in label or name.
[[nodiscard]] std::vector<const Setting*> find_settings(std::string_view typed, FieldKind kind);

class SettingSearch {
 public:
  void open();
  [[nodiscard]] bool asking() const noexcept { return asking_; }
  /// While it asks, keys and the wheel are for it. @return whether it took the event.
  bool handle(const InputEvent& event);
  /// Draws it over the picture: what is typed, the settings that match, their values in `document`. A chosen one that
  /// panels show is gone to (go_to_setting()). @return what to tell the user of one that has no control now.
  [[nodiscard]] std::optional<std::string> draw(const Document& document, FieldKind kind);

 private:
  [[nodiscard]] bool draw_rows(const Document& document, const std::vector<const Setting*>& found);

  bool asking_ = false, takes_focus_ = false, chosen_ = false, scrolls_ = false;
  std::string typed_, typed_before_;
  std::size_t current_ = 0, count_ = 0;
};

}  // namespace palpate
