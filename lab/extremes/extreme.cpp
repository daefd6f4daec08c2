#include "lab/extremes/extreme.h"

#include <algorithm>
#include <array>

#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

struct Seen {
  std::string_view row, guard;
};

constexpr Seen kSeen[] = {
    {"", ""},
#define PALPATE_SEEN(row, guard) {row, guard},
#include "lab/extremes/seen.def"
#undef PALPATE_SEEN
};

}  // namespace

std::string_view name_of(ExtremeKind kind) noexcept {
  constexpr std::array<std::string_view, kExtremeKindCount> kNames{"field", "mesh",   "tensor", "volume",
                                                                   "lens",  "camera", "wall",   "device"};
  return kNames[as_size(static_cast<int>(kind))];
}

std::vector<Extreme> extremes(std::initializer_list<ExtremeKind> kinds) {
  std::vector<Extreme> rows;
  for (const auto add : {add_field_rows, add_mesh_rows, add_stiff_rows, add_wall_mesh_rows, add_tensor_rows,
                         add_picture_rows, add_wall_rows, add_device_rows})
    add(rows);
  if (kinds.size() > 0) {
    std::erase_if(rows,
                  [&](const Extreme& row) { return std::ranges::find(kinds, row.kind) == kinds.end(); });
  }
  std::ranges::stable_sort(rows, {}, &Extreme::kind);
  return rows;
}

std::string guard_of(const Extreme& row) {
  if (row.unguarded) return row.guard;
  const std::string name = std::string(name_of(row.kind)) + ": " + row.name;
  const auto* const seen = std::ranges::find(kSeen, name, &Seen::row);
  return seen == std::end(kSeen) ? std::string() : std::string(seen->guard);
}

StabilityCase measured(const Extreme& row) {
  return make_case(std::string(name_of(row.kind)) + ": " + row.name, row.measure(), row.limit, row.unit,
                   row.builder + "; " + row.claim);
}

std::vector<StabilityCase> run_extremes(std::initializer_list<ExtremeKind> kinds, Progress* progress) {
  const std::vector<Extreme> rows = extremes(kinds);
  if (progress) progress->begin("stiff and extreme cases", rows.size());
  std::vector<StabilityCase> cases;
  for (const Extreme& row : rows) {
    if (progress) progress->check();
    cases.push_back(measured(row));
    if (progress) progress->advance();
  }
  return cases;
}

std::string extremes_page() {
  const std::vector<Extreme> rows = extremes();
  const auto seen = std::ranges::count_if(rows, [](const Extreme& row) { return !guard_of(row).empty(); });
  std::string page =
      "# Stiff and extreme cases\n\n"
      "The catalogue of `lab/extremes`: one table, which the tests run, which `report` measures on each machine (the rows that\n"
      "concern the program), and which this page lists. It is written by `scripts/extremes_page.sh`; a test holds the page to it.\n\n" +
      std::to_string(rows.size()) + " rows. " + std::to_string(seen) +
      " of them were seen to fail with a guard taken out: by `scripts/guards_out.py`, from the guards of\n"
      "`lab/extremes/guards.tsv`, or by the row itself, which a test runs both ways. The guard stands beside the row. Of a row with a dash none was seen yet.\n";
  for (int k = 0; k < kExtremeKindCount; ++k) {
    const auto kind = static_cast<ExtremeKind>(k);
    page += "\n## " + std::string(name_of(kind)) +
            "\n\n| case | made by | measured | at most | fails without |\n|---|---|---|---|---|\n";
    for (const Extreme& row : rows) {
      if (row.kind != kind) continue;
      const std::string guard = guard_of(row);
      page += "| " + row.name + " | " + row.builder + " | " + row.claim + " | " + short_number(row.limit) +
              " " + row.unit + " | " + (guard.empty() ? "-" : guard) + " |\n";
    }
  }
  return page;
}

}  // namespace palpate
