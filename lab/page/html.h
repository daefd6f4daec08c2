/// Bits of HTML that the sections of the page share.
#pragma once

#include <string>

#include "common/base/figures.h"
#include "lab/page/plot.h"

namespace palpate {

/// A table's cell; numbers stand at the right, text at the left.
[[nodiscard]] inline std::string cell(const std::string& text, bool is_text = false) {
  return std::string(is_text ? "<td class=\"text\">" : "<td>") + escaped(text) + "</td>";
}

[[nodiscard]] inline std::string paragraph(const std::string& text, const char* css = nullptr) {
  return std::string("<p") + (css ? " class=\"" + std::string(css) + "\"" : "") + ">" + escaped(text) +
         "</p>\n";
}

}  // namespace palpate
