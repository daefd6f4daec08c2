/// The path that `probe` takes and the log that it writes, as tests want them.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "common/device/probe_path.h"
#include "common/math/vec.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {

/// The table of `--path`, every number to its last bit.
inline std::string path_table(const std::vector<PathRow>& rows) {
  std::string text = "t,x,y,z\n";
  char line[128];
  for (const PathRow& row : rows) {
    const int length = std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g,%.17g\n", row.time, row.position.x,
                                     row.position.y, row.position.z);
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

struct LogRow {
  double time = 0.0;
  Vec3 probe{0.0};
  Vec3 proxy{0.0};
  Vec3 force{0.0};
  std::string state;
  double residual = 0.0;
  double microseconds = 0.0;
};

struct ProbeLogText {
  std::string header;
  std::vector<LogRow> rows;
  std::vector<std::string> lines;  ///< the rows as they are written, the column `us` left out
};

/// The log that lies at `file`; rows that cannot be read make the test fail by their NaNs.
inline ProbeLogText read_probe_log(const std::filesystem::path& file) {
  constexpr std::size_t kState = 10, kMicroseconds = 12;
  ProbeLogText log;
  std::istringstream text(read_file(file));
  std::getline(text, log.header);
  for (std::string line; std::getline(text, line);) {
    std::vector<double> numbers;
    std::string state, kept;
    std::istringstream cells(line);
    std::size_t column = 0;
    for (std::string cell; std::getline(cells, cell, ','); ++column) {
      double value = std::numeric_limits<double>::quiet_NaN();
      (void)std::from_chars(cell.data(), cell.data() + cell.size(), value);
      numbers.push_back(value);
      if (column == kState) state = cell;
      if (column != kMicroseconds) kept += cell + ",";
    }
    numbers.resize(std::max<std::size_t>(numbers.size(), kMicroseconds + 1),
                   std::numeric_limits<double>::quiet_NaN());
    log.rows.push_back({numbers[0],
                        {numbers[1], numbers[2], numbers[3]},
                        {numbers[4], numbers[5], numbers[6]},
                        {numbers[7], numbers[8], numbers[9]},
                        state,
                        numbers[11],
                        numbers[12]});
    log.lines.push_back(kept);
  }
  return log;
}

/// Rows whose proxy is held, and the lines that may hold it: a line is caught at a release, and in the
/// first row that is held again.
struct Held {
  std::vector<Vec3> seeds;
  struct Row {
    std::size_t number = 0;
    std::array<std::size_t, 2> seeds{};  ///< where nothing was caught at the release, the second one holds
  };
  std::vector<Row> rows;
};

inline Held held_rows(const ProbeLogText& log) {
  Held held;
  std::array<std::size_t, 2> now{};
  std::string before = "outside";
  for (std::size_t n = 0; n < log.rows.size(); ++n) {
    const LogRow& row = log.rows[n];
    if (row.state == "fault") continue;
    const bool holds = row.state == "held" || row.state == "fell_back";
    if (row.state == "released" || (holds && before != "held")) {
      held.seeds.push_back(row.probe);
      now = {before == "released" && holds ? now[1] : held.seeds.size() - 1, held.seeds.size() - 1};
    }
    before = holds ? "held" : row.state;
    // The proxy is the probe where nothing holds it, and where a line was caught this very moment.
    if (!holds) continue;
    if (row.proxy == row.probe) {
      if (row.state == "fell_back") before = "free";
      continue;
    }
    held.rows.push_back({n, now});
  }
  return held;
}

}  // namespace palpate::test
