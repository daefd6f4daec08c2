#include "common/window/files/folder_list.h"

#include <algorithm>
#include <cstdlib>
#include <string_view>

#include "common/base/text.h"
#include "common/load/format.h"
#include "common/scene/session_of.h"

namespace palpate {
namespace {

/// Whether what `row` may hold is something that a program of `kind` shows.
bool holds_for(const FormatRow& row, FieldKind kind) {
  const auto holds = [&](std::string_view what) { return row.holds.find(what) != std::string_view::npos; };
  switch (kind) {
    case FieldKind::kVector:
      return holds("vectors");
    case FieldKind::kScalar:
      return holds("scalars");
    case FieldKind::kTensor:
      return holds("tensors") || holds("tracts");
    case FieldKind::kFibre:
      return holds("hearts");
    case FieldKind::kNone:
      break;
  }
  return true;
}

}  // namespace

FolderList list_folder(const std::filesystem::path& folder, const FileFilter& shows, bool hidden) {
  FolderList list;
  std::error_code error;
  std::filesystem::directory_iterator each(folder, error);
  if (error) {
    list.error = folder.string() + ": " + error.message();
    return list;
  }
  for (; each != std::filesystem::directory_iterator(); each.increment(error)) {
    if (error) break;
    std::error_code unknown;  // a link that leads nowhere is neither
    FolderEntry entry{.name = each->path().filename().string(), .folder = each->is_directory(unknown)};
    if (!hidden && entry.name.starts_with('.')) continue;
    entry.offered = shows(each->path(), entry.folder);
    if (entry.folder || (entry.offered && each->is_regular_file(unknown)))
      list.entries.push_back(std::move(entry));
  }
  std::ranges::sort(list.entries, [](const FolderEntry& a, const FolderEntry& b) {
    if (a.folder != b.folder) return a.folder;
    const std::string left = lowered(a.name), right = lowered(b.name);
    return left != right ? left < right : a.name < b.name;
  });
  return list;
}

bool can_open(const std::filesystem::path& path, bool folder, FieldKind kind) {
  const auto opens = [&](const FormatRow& row) {
    if (!holds_for(row, kind)) return false;
    if (folder) return row.recognise_folder != nullptr && row.recognise_folder(path);
    const std::string ending = lowered(path.extension().string());
    if (row.gzip && ending == ".gz") return names_ending(row, lowered(path.stem().extension().string()));
    return names_ending(row, ending);
  };
  const bool session = !folder && path.filename().string().ends_with(kSessionEnding);
  return session || std::ranges::any_of(format_rows(), opens);
}

bool matches(const std::string& name, const std::string& typed) {
  const std::string all = lowered(name), part = lowered(typed);
  for (std::size_t at = all.find(part); at != std::string::npos; at = all.find(part, at + 1)) {
    if (at == 0 || std::isalnum(static_cast<unsigned char>(all[at - 1])) == 0) return true;
  }
  return false;
}

std::filesystem::path documents_folder() {
  const char* const home = std::getenv("HOME");  // NOLINT(concurrency-mt-unsafe): read only
  std::error_code unknown;
  if (home == nullptr || !std::filesystem::is_directory(home, unknown))
    return std::filesystem::current_path(unknown);
  const std::filesystem::path documents = std::filesystem::path(home) / "Documents";
  return std::filesystem::is_directory(documents, unknown) ? documents : std::filesystem::path(home);
}

}  // namespace palpate
