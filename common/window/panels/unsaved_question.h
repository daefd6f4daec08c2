/// The question that is asked once before lines or tracts are forgotten that are in no file: save, discard or
/// cancel.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "common/compose/window_model.h"
#include "common/window/input_event.h"

namespace palpate {

class UnsavedQuestion {
 public:
  enum class Answer : std::uint8_t { kNone, kSave, kDiscard, kCancel };

  /// Asks with these words. @param opens what is to be opened then; none: the window is to be closed.
  void ask(std::string words, std::optional<InputFiles> opens);
  [[nodiscard]] bool asking() const noexcept { return !words_.empty(); }
  /// The question was about this.
  [[nodiscard]] const std::optional<InputFiles>& opens() const noexcept { return opens_; }

  /// While it is asked, presses, keys and dropped files are not for the picture. @return whether it took it.
  bool handle(const InputEvent& event);
  /// Draws it in the middle of the window. What is answered ends it.
  [[nodiscard]] Answer draw();

 private:
  std::string words_;
  std::optional<InputFiles> opens_;
  Answer key_ = Answer::kNone;  ///< answered by a key
};

}  // namespace palpate
