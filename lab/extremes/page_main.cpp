// The page of the catalogue: extremes_page > docs/extremes.md (scripts/extremes_page.sh).
// extremes_page --measure [KIND...]: the name of each row of these kinds (all), what was measured and whether it holds, separated by tabs.

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <span>
#include <string_view>

#include "common/base/error.h"
#include "lab/extremes/extreme.h"

int main(int count, char** arguments) {
  using namespace palpate;
  if (count < 2) {
    std::fputs(extremes_page().c_str(), stdout);
    return 0;
  }
  if (std::string_view(arguments[1]) != "--measure") {
    std::fputs("usage: extremes_page [--measure [KIND...]]\n", stderr);
    return 2;
  }
  const std::span kinds(arguments + 2, static_cast<std::size_t>(count - 2));
  const auto is_asked = [&](const Extreme& row) {
    return kinds.empty() ||
           std::ranges::any_of(kinds, [&](const char* kind) { return name_of(row.kind) == kind; });
  };
  bool all = true;
  for (const Extreme& row : extremes()) {
    if (!is_asked(row)) continue;
    StabilityCase found;
    try {
      found = measured(row);
    } catch (const Error& error) {
      std::fprintf(stderr, "%s: %s\n", row.name.c_str(), error.what());
      found.row.name = std::string(name_of(row.kind)) + ": " + row.name;
    }
    all = all && found.row.holds;
    std::printf("%s\t%.3g\t%.3g\t%s\n", found.row.name.c_str(), found.row.measured, row.limit,
                found.row.holds ? "holds" : "fails");
    std::fflush(stdout);
  }
  return all ? 0 : 1;
}
