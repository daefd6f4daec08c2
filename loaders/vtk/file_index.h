/// Which files make which blocks at which time, as an index file says (.vtm, .vthb, .pvtu, .pvd, .vtu.series).
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/load/format.h"

namespace palpate {

struct FilePiece {
  std::filesystem::path file;
  std::string name;  ///< of the block; may be empty
  int level = -1;    ///< of refinement, 0 the coarsest; -1: none is stated
};

struct FileStep {
  double time = 0.0;
  std::vector<FilePiece> pieces;
};

/// Whether two files have the same grid and arrays, so that one can stand for the other; false where one cannot
/// be read.
using SameGrid = std::function<bool(const std::filesystem::path&, const std::filesystem::path&)>;

/// The steps that an index file lists, with indices of blocks inside it opened in turn; relative names start
/// from the index file's folder. An index of structured pieces, which make one grid, stands for itself. Of a
/// collection that a restarted run went on with, the later run counts: where its times begin again, also under
/// other file names; and of two files of one part and time the later one. Times that are equal up to rounding
/// are one.
/// @param notes get the sentences that tell the user. @throws Error (bad input).
[[nodiscard]] std::vector<FileStep> read_index(const std::filesystem::path& file, Format format,
                                               std::vector<std::string>& notes, const SameGrid& same_grid);

/// Leaves out the files that are not there, and the steps that have none left.
/// @param notes get the sentence that tells the user. @throws Error (bad input) where none is left.
void leave_out_missing(std::vector<FileStep>& steps, std::vector<std::string>& notes);

}  // namespace palpate
