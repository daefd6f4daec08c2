/// The question that is asked once before lines or tracts are forgotten that are in no file: save, discard or
/// cancel.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/compose/window_model.h"
#include "common/window/input_event.h"

namespace palpate {

/// What is done once nothing is lost by it.
struct Leaving {
  enum class Way : std::uint8_t { kQuit, kClose, kOpen };
  Way way = Way::kQuit;
  InputFiles files = {};                ///< that are opened
  std::vector<InputFiles> beside = {};  ///< and then these, one after the other, each beside what is open
};

class UnsavedQuestion {
 public:
  enum class Answer : std::uint8_t { kNone, kSave, kDiscard, kCancel };

  /// Asks with these words. @param leaving what is to be done then.
  void ask(std::string words, Leaving leaving);
  [[nodiscard]] bool asking() const noexcept { return !words_.empty(); }
  /// The question was about this.
  [[nodiscard]] const Leaving& leaving() const noexcept { return leaving_; }

  /// While it is asked, presses, keys and dropped files are not for the picture. @return whether it took it.
  bool handle(const InputEvent& event);
  /// Draws it in the middle of the window. What is answered ends it.
  [[nodiscard]] Answer draw();

 private:
  std::string words_;
  Leaving leaving_;
  Answer key_ = Answer::kNone;  ///< answered by a key
};

}  // namespace palpate
