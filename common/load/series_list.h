/// The series of a folder of images, as a line lists those that can be chosen: its writer, and its reader for windows.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace palpate {

struct ListedSeries {
  std::string title;
  std::size_t files = 0;
};
/// "1 (T1, 40 files), 2 (CT head, 96 files)".
[[nodiscard]] std::string series_list(std::span<const ListedSeries> series);
/// "folder: holds 2 series: …; choose one by --series NUMBER".
[[nodiscard]] std::string series_question(const std::string& folder, std::span<const ListedSeries> series);

/// "T1, 40 files" of each series that such a line asks to choose from, in the order of their numbers, from 1 on; empty for
/// any other line.
[[nodiscard]] std::vector<std::string> asked_series(const std::string& line);

}  // namespace palpate
