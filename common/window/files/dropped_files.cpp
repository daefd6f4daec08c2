#include "common/window/files/dropped_files.h"

#include <cstddef>
#include <span>
#include <string>

#include "common/base/error.h"
#include "common/load/find_format.h"
#include "common/load/plot3d_layout.h"

namespace palpate {
namespace {

bool is_solution(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return false;
  try {
    const HeadOfFile read = read_head(file, kSniffBytes, kPlot3dTailBytes);
    const std::string ending = file.extension().string();
    const Sniffed sniffed = sniff(
        {std::as_bytes(std::span(read.bytes)), std::as_bytes(std::span(read.tail)), read.file_size, ending});
    return !sniffed.format && sniffed.found == "a PLOT3D solution";
  } catch (const Error&) {
    return false;  // the model says what is wrong with it
  }
}

}  // namespace

InputFiles sort_dropped(const std::vector<std::filesystem::path>& files, const InputFiles* open) {
  InputFiles sorted;
  for (const auto& file : files) {
    if (!sorted.solution && is_solution(file)) {
      sorted.solution = file;
    } else {
      sorted.files.push_back(file);
    }
  }
  if (sorted.solution && sorted.files.empty() && open != nullptr) sorted.files = open->files;
  // Alone with nothing to go with, it is told by the model what it lacks.
  if (sorted.files.empty()) return {files, {}};
  return sorted;
}

}  // namespace palpate
