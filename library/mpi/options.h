/// The command line of palpate-mpi: `trace`, with the words that all programs have for it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/trace/trace.h"

namespace palpate::mpi {

struct Options {
  std::vector<std::filesystem::path> files;
  std::string solution, field, time, seeds, direction = "forward", cell_values = "recovered";
  std::filesystem::path out, work;
  std::uint64_t seed = 1;
  TraceOptions trace;
  int blocks = 0;  ///< 0: four a rank
  std::int64_t pieces = 1 << 20;
  double keep_seconds = 60.0;
  bool force = false, json = false, quiet = false;
};

struct ParsedOptions {
  Options options;
  std::string text;  ///< to be printed, and that is all; empty: work
};

/// @throws Error (usage).
[[nodiscard]] ParsedOptions parse_options(int argc, char** argv);

}  // namespace palpate::mpi
