/// What a folder holds, as a file dialog lists it.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "common/scene/document/field_kind.h"

namespace palpate {

/// Which files and folders are offered. Folders that are not offered are there to go into.
using FileFilter = std::function<bool(const std::filesystem::path& path, bool folder)>;

struct FolderEntry {
  std::string name;
  bool folder = false;
  bool offered = false;  ///< of a folder: it is data as a whole, as an OpenFOAM case is

  bool operator==(const FolderEntry&) const = default;
};

struct FolderList {
  std::vector<FolderEntry> entries;  ///< folders first, each in the order of the alphabet
  std::string error;                 ///< why it cannot be read; empty: it can
};

/// Folders, and those files that `shows` offers. Hidden ones (".name") only where asked for.
[[nodiscard]] FolderList list_folder(const std::filesystem::path& folder, const FileFilter& shows,
                                     bool hidden);

/// Whether a program of `kind` may open this, by its name alone: a folder on a server is not to be read for it.
/// Sessions can be opened, and a folder as a whole where it is of one of the formats.
[[nodiscard]] bool can_open(const std::filesystem::path& path, bool folder, FieldKind kind);

/// Whether `name`, or a part of it, begins with `typed`, whatever the case of letters.
[[nodiscard]] bool matches(const std::string& name, const std::string& typed);

/// The folder of the user's documents: ~/Documents where there is one, else HOME, else the current one.
[[nodiscard]] std::filesystem::path documents_folder();

}  // namespace palpate
