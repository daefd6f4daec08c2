#include "loaders/vtk/ensight/ensight_times.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/step_times.h"

namespace palpate {
namespace {

/// The time set of a line of VARIABLE: the first of the numbers before the name and the file.
std::optional<int> set_of(const std::vector<std::string_view>& parts) {
  if (parts.size() < 3) return std::nullopt;
  return parsed<int>(parts[0]);
}

struct Line {
  std::string_view text;
  std::string key;  ///< before a colon, in small letters
  std::string_view behind;
};

std::vector<Line> lines_of(std::string_view text) {
  std::vector<Line> lines;
  for (const std::string_view line : split(text, '\n')) {
    const std::size_t colon = line.find(':');
    Line one{line, "", ""};
    if (colon != std::string_view::npos) {
      for (const std::string_view word : words(line.substr(0, colon)))
        one.key += (one.key.empty() ? "" : " ") + lowered(word);
      one.behind = line.substr(colon + 1);
    }
    lines.push_back(std::move(one));
  }
  return lines;
}

}  // namespace

EnsightTimes ensight_times(std::string_view case_text) {
  const std::vector<Line> lines = lines_of(case_text);
  struct Place {
    std::size_t first = 0, end = 0;  ///< lines
    int set = 0;
  };
  EnsightTimes times;
  std::vector<Place> places;
  int set = 0;
  std::size_t steps = 0;
  for (std::size_t l = 0; l < lines.size(); ++l) {
    const std::vector<std::string_view> behind = words(lines[l].behind);
    if (lines[l].key == "time set" && !behind.empty()) set = parsed<int>(behind[0]).value_or(0);
    if (lines[l].key == "number of steps" && !behind.empty())
      steps = parsed<std::size_t>(behind[0]).value_or(0);
    if (lines[l].key != "time values") continue;
    Place place{l, l + 1, set};
    std::vector<double>& values = times.sets[set];
    std::vector<std::string_view> found = behind;
    while (true) {
      for (const std::string_view word : found) {
        const auto value = number(word);
        if (!value || !std::isfinite(*value)) return {};
        values.push_back(*value);
      }
      if (values.size() >= steps || place.end >= lines.size() || !lines[place.end].key.empty()) break;
      found = words(lines[place.end++].text);
    }
    if (values.size() != steps || steps == 0) return {};
    places.push_back(place);
  }
  for (const auto& [number, values] : times.sets)
    times.all.insert(times.all.end(), values.begin(), values.end());
  const std::vector<double> joined = joined_times(times.all);
  std::size_t next = 0;
  for (auto& [number, values] : times.sets) {
    for (double& value : values) value = joined[next++];
  }
  times.all = joined;
  std::sort(times.all.begin(), times.all.end());
  times.all.erase(std::unique(times.all.begin(), times.all.end()), times.all.end());
  for (std::size_t l = 0, p = 0; l < lines.size();) {
    if (p == places.size() || l != places[p].first) {
      times.text.append(lines[l].text).append(l + 1 < lines.size() ? "\n" : "");
      ++l;
      continue;
    }
    // Several a line, as EnSight writes them.
    constexpr std::size_t kOnLine = 8;
    times.text += "time values:";
    std::size_t written = 0;
    for (const double value : times.sets[places[p].set]) {
      if (written > 0 && written % kOnLine == 0) times.text += "\n";
      const auto at = std::lower_bound(times.all.begin(), times.all.end(), value);
      times.text += " " + std::to_string(at - times.all.begin());
      ++written;
    }
    times.text += "\n";
    l = places[p++].end;
  }
  return times;
}

std::vector<std::size_t> ensight_steps_of(std::string_view case_text, const EnsightTimes& times,
                                          const std::string& variable) {
  for (const Line& line : lines_of(case_text)) {
    if (line.key.find(" per ") == std::string::npos) continue;
    const std::vector<std::string_view> parts = words(line.behind);
    const auto set = set_of(parts);
    if (!set || parts[parts.size() - 2] != variable) continue;
    const auto own = times.sets.find(*set);
    // One state alone stands for all times.
    if (own == times.sets.end() || own->second.size() < 2) return {};
    std::vector<std::size_t> steps;
    for (const double time : own->second) {
      const auto at = std::lower_bound(times.all.begin(), times.all.end(), time);
      steps.push_back(as_size(at - times.all.begin()));
    }
    std::sort(steps.begin(), steps.end());
    return steps.size() == times.all.size() ? std::vector<std::size_t>{} : steps;
  }
  return {};
}

}  // namespace palpate
