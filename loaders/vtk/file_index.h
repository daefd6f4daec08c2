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
/// from the index file's folder. An index of structured pieces, which make one grid, stands for itself. Of a
/// .pvd that a restarted run went on with, the later run counts: where its times begin again.
/// @param notes get the sentences that tell the user. @throws Error (bad input).
[[nodiscard]] std::vector<FileStep> read_index(const std::filesystem::path& file, Format format,
                                               std::vector<std::string>& notes);

/// Leaves out the files that are not there, and the steps that have none left.
/// @param notes get the sentence that tells the user. @throws Error (bad input) where none is left.
void leave_out_missing(std::vector<FileStep>& steps, std::vector<std::string>& notes);

/// What several files given together mean: names that differ in one number only are the steps of a time
/// series, in the order of their numbers, unless the letters before the number say that it counts parts
/// ("block", "part", "piece", "domain", "zone", "proc", "grid"); all others are blocks of one state.
/// @param note gets the sentence that tells the user.
[[nodiscard]] std::vector<FileStep> arrange_files(const std::vector<std::filesystem::path>& files,
                                                  std::string& note);

}  // namespace palpate
