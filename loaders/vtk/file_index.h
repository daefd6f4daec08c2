/// Which files make which blocks at which time: read from an index file (.vtm, .pvtu, .pvd, .vtu.series), or
/// worked out from the names of several files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/load/format.h"

namespace palpate {

struct FilePiece {
  std::filesystem::path file;
  std::string name;  ///< of the block; may be empty
};

struct FileStep {
  double time = 0.0;
  std::vector<FilePiece> pieces;
};

/// The steps that an index file lists, with indices of blocks inside it opened in turn; relative names start
/// from the index file's folder. An index of structured pieces, which make one grid, stands for itself.
/// @throws Error (bad input).
[[nodiscard]] std::vector<FileStep> read_index(const std::filesystem::path& file, Format format);

/// What several files given together mean: names that differ in one number only are the steps of a time
/// series, in the order of their numbers, unless the letters before the number say that it counts parts
/// ("block", "part", "piece", "domain", "zone", "proc", "grid"); all others are blocks of one state.
/// @param note gets the sentence that tells the user.
[[nodiscard]] std::vector<FileStep> arrange_files(const std::vector<std::filesystem::path>& files,
                                                  std::string& note);

}  // namespace palpate
