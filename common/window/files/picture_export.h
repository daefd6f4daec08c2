/// A picture of what a window shows, in a size and on a background of one's own: asked for in the file dialog, drawn
/// off-screen on the window's thread, which stands meanwhile. Text is laid out by Dear ImGui, which has one context
/// for all threads, so that no other thread can draw.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/render/png.h"
#include "common/render/scene_view.h"

namespace palpate {

/// What the user chooses.
struct PictureChoice {
  static constexpr int kSmallest = 16, kLargest = 8192;  ///< [pixels]

  int width = 0, height = 0;
  bool transparent = false;
  std::optional<Rgb> background;  ///< none: as it is seen

  bool operator==(const PictureChoice&) const = default;
};

class PictureExport {
 public:
  /// Begins with the size of the picture that is seen, where the user has not chosen another one.
  void begin(int width, int height);
  [[nodiscard]] const PictureChoice& choice() const noexcept { return choice_; }
  /// Controls in two rows, for the file dialog.
  void draw_choice();

  /// Has take() draw `view` so into `file`.
  void ask(SceneView view, const std::filesystem::path& file, std::vector<PngText> texts);
  struct Outcome {
    std::string words;  ///< what was written, or why not
    bool done = false;
  };
  /// Once a frame: draws what was asked for, in the frame after the one in which it was, so that this could say so.
  /// Leaves no OpenGL context current then. @return what it came to.
  [[nodiscard]] std::optional<Outcome> take();

 private:
  PictureChoice choice_;
  int seen_width_ = 0, seen_height_ = 0;
  bool own_size_ = false;
  struct Asked {
    SceneView view;
    std::filesystem::path file;
    std::vector<PngText> texts;
    bool said = false;  // a frame has passed
  };
  std::optional<Asked> asked_;
};

}  // namespace palpate
