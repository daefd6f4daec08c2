#include "loaders/cfd/cfd_check.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/base/text.h"
#include "loaders/cfd/fluent_faces.h"

namespace palpate {
namespace {

/// Calls `visit(line)`, without the end of the line, until it returns false.
template <class Visit>
void each_line(std::string_view text, const Visit& visit) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    if (!visit(text.substr(0, end))) return;
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

std::optional<std::uint64_t> hexadecimal(std::string_view word) {
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value, 16);
  if (error != std::errc() || end != word.data() + word.size()) return std::nullopt;
  return value;
}

/// What is wrong with the sections of a Fluent file one after the other, or empty. VTK's reader goes on without end for
/// what has none.
std::string sections_problem(std::string_view text) {
  std::string problem;
  std::size_t at = 0;
  while (next_fluent_section(text, at, problem)) {
  }
  return problem;
}

}  // namespace

std::string fluent_problem(std::string_view text) {
  struct Section {
    std::string_view number;
    const char* what;
  };
  static constexpr std::array kSections{Section{"10", "nodes"}, Section{"12", "cells"},
                                        Section{"13", "faces"}};
  std::string problem;
  each_line(text, [&](std::string_view line) {
    line = trimmed(line.substr(0, 128));
    if (!line.starts_with('(')) return true;
    const std::size_t inner = line.find('(', 1);
    if (inner == std::string_view::npos) return true;
    const std::string_view number = trimmed(line.substr(1, inner - 1));
    const auto* const section = std::ranges::find_if(kSections, [&](const Section& s) {
      return number == s.number || (number.size() == 4 && number.ends_with(s.number) &&
                                    (number.starts_with("20") || number.starts_with("30")));
    });
    if (section == kSections.end()) return true;
    const auto of_section = words(line.substr(inner + 1, line.find(')', inner) - inner - 1));
    const auto last = of_section.size() > 2 ? hexadecimal(of_section[2]) : std::nullopt;
    if (last && *last <= text.size()) return true;
    problem = last ? "claims " + std::to_string(*last) + " " + section->what + " in " +
                         std::to_string(text.size()) + " bytes"
                   : std::string("has a section of ") + section->what + " without counts";
    return false;
  });
  return problem.empty() ? sections_problem(text) : problem;
}

std::string gambit_problem(std::string_view text) {
  std::vector<std::uint64_t> counts;
  bool titles = false;
  std::size_t sections = 0, ends = 0;
  std::optional<std::uint64_t> nodes;  ///< that were listed, while they are
  std::string problem;
  each_line(text, [&](std::string_view line) {
    const auto of_line = words(line.substr(0, 256));
    if (of_line.empty()) return true;
    if (nodes && of_line[0] == "ENDOFSECTION") nodes.reset();
    if (nodes && parsed<std::uint64_t>(of_line[0]) != ++*nodes) {
      problem = "numbers a node '" + printable(of_line[0].substr(0, 40)) + "', not " +
                std::to_string(*nodes) + ": VTK's reader takes nodes as 1, 2, 3 and so on, in this order";
      return false;
    }
    if (titles && counts.empty()) {
      for (const std::string_view word : of_line) {
        const auto count = parsed<std::uint64_t>(word);
        // A line a node, an element, a group or a set at least.
        if (!count || *count > text.size() / 2) {
          problem = "claims '" + printable(word.substr(0, 40)) + "' of what it has " +
                    std::to_string(text.size()) + " bytes for";
          return false;
        }
        counts.push_back(*count);
      }
      if (counts.size() < 6)
        problem = "has " + std::to_string(counts.size()) + " counts in its head, expected 6";
      return problem.empty();
    }
    if (of_line[0] == "NUMNP") titles = true;
    ends += of_line[0] == "ENDOFSECTION" ? 1 : 0;
    const bool begins =
        line.find("2.") != std::string_view::npos || line.find("1.") != std::string_view::npos;
    const bool named = of_line.size() > 2 || of_line.size() == 2;
    if (begins && named &&
        (line.find("CONTROL INFO") != std::string_view::npos ||
         line.find("NODAL COORDINATES") != std::string_view::npos ||
         line.find("ELEMENTS/CELLS") != std::string_view::npos))
      ++sections;
    if (line.find("NODAL COORDINATES") != std::string_view::npos) nodes = 0;
    return true;
  });
  if (!problem.empty()) return problem;
  if (counts.empty()) return "has no counts in its head";
  if (sections < 3 || ends < sections) return "ends before its nodes and elements do";
  return {};
}

}  // namespace palpate
