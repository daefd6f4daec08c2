/// Sessions: a scene as a small text file that diffs well (TOML).
///
/// The keys of [scene] are names of settings, and their values have the grammar of the command line
/// (document/setting.h); those at their defaults are left out. Inputs carry their size and SHA-256 checksum,
/// and a changed one is named when the session is opened.
///
///   format = 1                  # a newer one is read as far as it is known, and the rest is named
///   program = "NAME"            # that opens it
///   [[input]]
///   file = "carotid.vtk"        # relative to the session file
///   bytes = 2681486
///   sha256 = "3f5d…"
///   [lines]                     # drawn by hand; where there are any
///   file = "carotid.palpate.lines.csv"
///   bytes = 24310
///   sha256 = "a1b0…"
///   [scene]
///   field = "vectors"
///   seeds = "grid:8,8,8"
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/progress.h"

namespace palpate {

/// An input file of a session.
struct SessionInput {
  std::filesystem::path file;  ///< as opened from here; absolute or relative to the current folder
  std::uint64_t bytes = 0;
  std::string sha256;     ///< 64 hexadecimal digits
  bool solution = false;  ///< a PLOT3D solution that goes with the other file
};

struct Session {
  std::string program;                                       ///< the name that starts it
  std::vector<SessionInput> inputs;                          ///< none for a built-in example
  std::optional<SessionInput> lines;                         ///< TouchOptions::drawn_lines
  std::vector<std::pair<std::string, std::string>> options;  ///< name of a setting, its value as text
  bool newer = false;  ///< its format is newer than the one that this program writes
};

/// Size and checksum of `file`. Of a folder (a DICOM series) the sum of its files' sizes, and the checksum of
/// what `sha256sum *` prints in it; the folders in it do not count.
/// @throws Error (bad input) where it cannot be read; Cancelled.
[[nodiscard]] SessionInput describe_input(const std::filesystem::path& file, bool solution,
                                          const Progress* progress = nullptr);

/// Writes under a temporary name and renames. Files below the session's folder are stored relative to it.
/// @throws Error (work failed).
void save_session(const std::filesystem::path& path, const Session& session);

/// @throws Error (bad input) naming file, line and what was expected.
[[nodiscard]] Session load_session(const std::filesystem::path& path);

/// A sentence on a file that is missing or no longer what the session was saved with; empty of any other.
[[nodiscard]] std::string change_of(const SessionInput& input, const Progress* progress = nullptr);
/// The same for each input that is missing or no longer the file that the session was saved with.
[[nodiscard]] std::vector<std::string> changed_inputs(const Session& session,
                                                      const Progress* progress = nullptr);

}  // namespace palpate
