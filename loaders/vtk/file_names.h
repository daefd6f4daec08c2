/// What several files given together mean: by the times that they state, or else by the numbers in their names.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "loaders/vtk/file_index.h"

namespace palpate {

/// A name without its last number, which `digits` holds.
struct NumberedName {
  std::string before;
  std::string digits;
  std::string after;
};
[[nodiscard]] NumberedName split_name(const std::filesystem::path& file);

/// The steps that several files make, in the order of their times. Files that all state a time are the steps
/// of these times, those of one time its blocks. Otherwise names that differ in one number only are the steps
/// of a time series, unless the letters before the number say that it counts parts ("block", "part", "piece",
/// "domain", "zone", "proc", "grid"); all others are blocks of one state.
///
/// The number is a decimal one ("0.15", "0p15", "1e-05", "-2"), except where a counter stands behind the point:
/// "run2.0010", or "1.9" beside "1.10".
/// @param stated times that the files state, as many as files.
/// @param notes  get the sentences that tell the user, what was taken for times included.
[[nodiscard]] std::vector<FileStep> arrange_files(const std::vector<std::filesystem::path>& files,
                                                  const std::vector<std::optional<double>>& stated,
                                                  std::vector<std::string>& notes);

}  // namespace palpate
