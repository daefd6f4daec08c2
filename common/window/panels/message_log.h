/// All that a window has said since it was opened, to be read again and copied.
#pragma once

#include <string>
#include <vector>

namespace palpate {

class MessageLog {
 public:
  struct Message {
    std::string time;  ///< "14:03:22", of the clock on the wall
    std::string words;
    bool error = false;
  };

  /// What is said twice in a row is kept once.
  void add(const std::string& words, bool error);
  [[nodiscard]] const std::vector<Message>& messages() const noexcept { return messages_; }
  /// A line each, the oldest first.
  [[nodiscard]] std::string text() const;

  bool shown = false;
  /// Draws it where it is shown, in the middle of the window.
  void draw();

 private:
  std::vector<Message> messages_;
};

}  // namespace palpate
