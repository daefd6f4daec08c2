/// Small pictures of inputs for the start page, kept in the user's cache folder: of data, the last picture that was
/// seen of them; of built-in examples, one that is drawn once, in the background.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <mutex>
#include <set>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "common/compose/window_model.h"
#include "common/hand/window_request.h"
#include "common/render/scene_view.h"
#include "common/window/panels/start_page.h"

namespace palpate {

/// The middle of `image` in that size, without transparency; empty where there is none.
[[nodiscard]] Image small_picture(const Image& image, int width, int height);

/// Needs the window's OpenGL context from its construction to its end.
class Thumbnails {
 public:
  /// @param folder where they are kept; empty: nowhere, and there are none.
  /// @param program whose pictures they are. @param draw may be empty.
  Thumbnails(std::filesystem::path folder, std::string program, DrawExample draw);
  ~Thumbnails();
  Thumbnails(const Thumbnails&) = delete;
  Thumbnails& operator=(const Thumbnails&) = delete;

  /// That of `input`; where there is none, why.
  [[nodiscard]] SmallPicture of(const InputFiles& input);
  /// Keeps the middle of `picture` as that of `input`. A folder that cannot be written is no error: they are a help.
  void keep(const InputFiles& input, const Image& picture);
  /// Begins to draw those of these examples that there are none of; once.
  /// @param drawn called on another thread after each.
  void draw_missing(const std::vector<InputFiles>& examples, std::function<void()> drawn);

 private:
  /// Where that of `input` is kept: data that have changed since have none.
  [[nodiscard]] std::filesystem::path file_of(const InputFiles& input) const;
  [[nodiscard]] unsigned texture_of(const std::filesystem::path& file);
  void remove_oldest() const;

  std::filesystem::path folder_;
  std::string program_;
  DrawExample draw_;
  std::map<std::filesystem::path, unsigned> textures_;
  std::mutex mutex_;
  std::set<std::string> failed_;  // examples; under the mutex
  bool drawing_ = false;
  std::jthread thread_;  // last: it uses the above
};

}  // namespace palpate
