#include "loaders/vtk/ensight/ensight_rows.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <initializer_list>
#include <map>
#include <utility>

#include "common/base/text.h"

namespace palpate {
namespace {

std::vector<std::string> quoted_words(std::string_view line) {
  std::vector<std::string> found;
  for (std::size_t at = 0;;) {
    at = line.find_first_not_of(" \t\r", at);
    if (at == std::string_view::npos) return found;
    const bool quoted = line[at] == '"';
    if (quoted) ++at;
    const std::size_t end = std::min(line.find_first_of(quoted ? "\"" : " \t\r", at), line.size());
    found.emplace_back(line.substr(at, end - at));
    at = std::min(end + (quoted ? 1 : 0), line.size());
  }
}

bool is_one_of(const std::string& kind, std::initializer_list<std::string_view> known) {
  return std::ranges::find(known, std::string_view(kind)) != known.end();
}

/// Whether a row that names no values is one that is read.
bool is_used(const EnsightRow& row) {
  if (row.section == "FORMAT") return row.kind == "type";
  if (row.section == "GEOMETRY") return row.kind == "model";
  if (row.section == "TIME") {
    return is_one_of(row.kind, {"time set", "number of steps", "filename start number", "filename increment",
                                "filename numbers", "time values"});
  }
  return row.section == "FILE" && is_one_of(row.kind, {"file set", "filename index", "number of steps"});
}

bool is_number(const std::string& word) {
  return !word.empty() && std::ranges::all_of(word, [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "'a', 'b' and 3 more"
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  std::string out;
  for (std::size_t i = 0; i < std::min(kMost, names.size()); ++i)
    out += (i > 0 ? ", '" : "'") + printable(names[i].substr(0, 40)) + "'";
  if (names.size() > kMost) out += " and " + std::to_string(names.size() - kMost) + " more";
  return out;
}

/// Why rows of a kind are not read, or what follows of it.
std::string reason(const EnsightRow& row) {
  if (row.section == "GEOMETRY" && row.kind == "rigid_body")
    return ": parts stay where the geometry has them";
  if (row.section == "GEOMETRY" && row.kind == "match")
    return ": parts are joined where their points coincide";
  if (row.section == "GEOMETRY" && row.kind == "measured") return ": particles are no cells";
  if (row.section == "TIME") return ": write the numbers into the case";
  if (row.section == "BLOCK_CONTINUATION") return ": parts that go on in other files end at their first one";
  return {};
}

}  // namespace

bool EnsightRow::is_variable() const {
  return section == "VARIABLE" &&
         is_one_of(kind,
                   {"scalar per node", "vector per node", "tensor symm per node", "tensor asym per node",
                    "tensor per node", "scalar per element", "vector per element", "tensor symm per element",
                    "tensor asym per element", "tensor per element"});
}

std::size_t EnsightRow::sets(std::size_t behind) const {
  std::size_t count = 0;
  while (count < 2 && count + behind < words.size() && is_number(words[count])) ++count;
  return count;
}

std::vector<EnsightRow> ensight_rows(std::string_view text) {
  std::vector<EnsightRow> rows;
  std::string section;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string_view line = text.substr(at, end - at);
    at = end + 1;
    while (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    EnsightRow row{.line = line};
    const std::string_view content = trimmed(line);
    const std::size_t colon = line.find(':');
    if (content.starts_with('#') || content.empty()) {
      // nothing
    } else if (colon == std::string_view::npos) {
      const std::vector<std::string_view> parts = words(line);
      if (parts.size() == 1 && std::isupper(static_cast<unsigned char>(line.front())) != 0)
        section = parts.front();
    } else {
      for (const std::string_view word : words(line.substr(0, colon)))
        row.kind += (row.kind.empty() ? "" : " ") + lowered(word);
      row.words = quoted_words(line.substr(colon + 1));
    }
    row.section = section;
    rows.push_back(std::move(row));
  }
  return rows;
}

std::vector<std::string> ensight_unused(std::string_view case_text, const std::set<std::string>& offered) {
  // In the order of the case.
  std::vector<std::pair<std::string, std::string>> kinds;
  std::map<std::string, std::vector<std::string>> names;
  const auto add = [&](const std::string& what, const std::string& why, const std::string& name) {
    if (!names.contains(what)) kinds.emplace_back(what, why);
    names[what].push_back(name);
  };
  constexpr std::array<std::string_view, 5> kSections{"FORMAT", "GEOMETRY", "VARIABLE", "TIME", "FILE"};
  for (const EnsightRow& row : ensight_rows(case_text)) {
    if (row.kind.empty()) continue;
    const bool known = std::ranges::find(kSections, std::string_view(row.section)) != kSections.end();
    if (!known) {
      add("section " + printable(row.section.substr(0, 40)), reason(row), row.kind);
    } else if (row.section == "VARIABLE") {
      const std::size_t at = row.sets(2);
      const std::string name = at < row.words.size() ? row.words[at] : std::string();
      if (row.is_variable() && offered.contains(name)) continue;
      add("variables '" + printable(row.kind.substr(0, 60)) + "'", {}, name);
    } else if (!is_used(row)) {
      add("'" + printable(row.kind.substr(0, 60)) + "' of section " + row.section, reason(row),
          row.words.empty() ? std::string() : row.words.front());
    }
  }
  std::vector<std::string> out;
  for (const auto& [what, why] : kinds) {
    const std::vector<std::string>& of_kind = names[what];
    out.push_back("not read: " + what + (of_kind.front().empty() ? "" : " (" + listed(of_kind) + ")") + why);
  }
  return out;
}

}  // namespace palpate
