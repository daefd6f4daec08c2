/// Names of files that differ in a number, as headers of multi-file images give them: "slice%03d.raw" and its
/// first and last number.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

struct NumberedFiles {
  std::vector<std::string> names;
  std::string problem;  ///< what is wrong, or empty
};

/// @param format with one %d, which may have a width of up to three digits, a zero before it; nothing of it
/// gets to printf. @param first,last,step whole numbers; from first by step as far as last is not passed.
/// @param most names.
[[nodiscard]] NumberedFiles numbered_files(std::string_view format, std::string_view first,
                                           std::string_view last, std::string_view step, std::size_t most);

}  // namespace palpate
