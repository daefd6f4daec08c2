/// What the window shows while nothing is open: what was open lately, the built-in examples, and how to open more.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/compose/window_model.h"
#include "common/scene/document/field_kind.h"
#include "common/window/input_event.h"

namespace palpate {

/// A small picture of an input.
struct SmallPicture {
  unsigned texture = 0;           ///< OpenGL's name; 0: there is none (yet)
  std::string_view instead = {};  ///< what is said then
};
using PictureOf = std::function<SmallPicture(const InputFiles&)>;

/// "carotid.vtk", or the names of all its files.
[[nodiscard]] std::string name_of(const InputFiles& input);

class StartPage {
 public:
  /// Width over height of the pictures.
  static constexpr int kPictureWidth = 288, kPictureHeight = 192;

  /// @param kind of the fields that the program shows, whose examples are offered.
  StartPage(std::string program, FieldKind kind);

  /// What the user asked for in this frame.
  struct Actions {
    bool ask_to_open = false;
    std::optional<InputFiles> open;
  };
  /// Arrows choose a card, Enter opens it. @return whether the event was for the page.
  bool handle(const InputEvent& event);
  /// Draws it over the whole window. @param recent newest first. @param beside something is open that Esc leads
  /// back to. @param message the last line that was said.
  [[nodiscard]] Actions draw(const std::vector<InputFiles>& recent, const PictureOf& picture, bool beside,
                             const std::string& message);

  [[nodiscard]] const std::vector<InputFiles>& examples() const noexcept { return examples_; }

 private:
  struct Card {
    InputFiles input;
    std::string name, what;
  };
  void draw_cards(const std::vector<Card>& cards, std::size_t first, const PictureOf& picture,
                  Actions& actions);
  [[nodiscard]] bool draw_card(const Card& card, std::size_t place, float width, const SmallPicture& picture);

  std::string program_;
  std::vector<InputFiles> examples_;
  std::vector<std::string> summaries_;  // of the examples
  std::size_t current_ = 0, count_ = 0, columns_ = 1;
  bool chosen_ = false;   // by Enter
  bool by_keys_ = false;  // the current card is shown
  bool scrolls_ = false;  // to it
};

}  // namespace palpate
