/// A picture of what a window shows, in a size and on a background of one's own: asked for in the file dialog, drawn
/// off-screen while the window goes on.
#pragma once

#include <filesystem>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
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

  /// Draws `view` so into `file`, in the background. @pre !running()
  void start(SceneView view, const std::filesystem::path& file, const std::vector<PngText>& texts);
  [[nodiscard]] bool running() const noexcept { return thread_.joinable(); }
  struct Outcome {
    std::string words;  ///< what was written, or why not
    bool done = false;
  };
  /// What it came to, once.
  [[nodiscard]] std::optional<Outcome> take();

 private:
  PictureChoice choice_;
  int seen_width_ = 0, seen_height_ = 0;
  bool own_size_ = false;
  std::mutex mutex_;
  std::optional<Outcome> outcome_;  // under the mutex
  std::jthread thread_;             // last: it uses the above
};

}  // namespace palpate
