/// Which series of a folder is opened, where it holds several.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/compose/window_model.h"

namespace palpate {

class SeriesChoice {
 public:
  /// Asks for one of the series of `folder`. @param series "T1, 40 files" of each, by their numbers from 1 on.
  void ask(InputFiles folder, std::vector<std::string> series);
  [[nodiscard]] bool asking() const noexcept { return !series_.empty(); }
  /// A list over the window until one is clicked, or none is wanted. @return the folder with the series chosen.
  [[nodiscard]] std::optional<InputFiles> draw();

 private:
  InputFiles folder_;
  std::vector<std::string> series_;  // empty: nothing is asked
};

}  // namespace palpate
