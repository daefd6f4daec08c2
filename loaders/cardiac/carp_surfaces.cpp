#include "loaders/cardiac/carp_surfaces.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/layer/wall_surfaces.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr const char* kTriangles = ".surf";
constexpr const char* kPoints = ".vtx";

/// What a file is by its name, but for that of its mesh; kLeft: it does not say.
BorderRole role_by_name(const std::string& file, const std::string& mesh) {
  std::string name = std::filesystem::path(stem_of(file)).filename().string();
  if (name.starts_with(mesh)) name.erase(0, mesh.size());
  name = lowered(name);
  const auto has = [&name](std::string_view word) { return name.find(word) != std::string::npos; };
  // Two letters stand at an end of a part of the name: "nerve" is no right ventricle, and "baseline" no base.
  const auto has_part = [&name](std::string_view word, bool whole) {
    std::size_t begin = 0;
    while (begin < name.size()) {
      const std::size_t end = std::min(name.find_first_of("._- ", begin), name.size());
      const std::string_view part = std::string_view(name).substr(begin, end - begin);
      if (whole ? part == word : part.starts_with(word) || part.ends_with(word)) return true;
      begin = end + 1;
    }
    return false;
  };
  if (has("epi")) return BorderRole::kOuter;
  if (has_part("base", true)) return BorderRole::kBase;
  if (has("sept")) return has_part("lv", false) ? BorderRole::kInner : BorderRole::kSeptum;
  if (has_part("rv", false)) return BorderRole::kRight;
  return has("endo") || has_part("lv", false) ? BorderRole::kInner : BorderRole::kLeft;
}

/// Marks the points of a file. @return how many rows it has.
std::size_t mark(const std::string& file, std::int64_t first, std::uint8_t tag,
                 std::vector<std::uint8_t>& tags) {
  constexpr std::size_t kLeastBytes = 2;  // "0\n"
  const bool triangles = ending_of(file) == kTriangles;
  const char* const what = triangles ? "triangle" : "point";
  TextLines lines(file, '#');
  const std::size_t count =
      believed_count(lines, triangles ? "the number of triangles" : "the number of points", kLeastBytes);
  const auto last = first + static_cast<std::int64_t>(tags.size()) - 1;
  for (std::size_t row = 0; row < count; ++row) {
    std::string_view word = lines.word();
    // Behind the count of points stands where they are stimulated, "intra" or "extra".
    if (!triangles && row == 0 && (word == "intra" || word == "extra")) word = lines.word();
    if (word.empty()) lines.refuse("ends after " + counted(row, what), std::to_string(count));
    std::size_t corners = 1;
    if (triangles) {
      corners = word == "Tr" ? 3 : word == "Qd" ? 4 : 0;
      if (corners == 0) lines.refuse("begins with \"" + std::string(word.substr(0, 20)) + "\"", "Tr or Qd");
      word = lines.word_here();
    }
    for (std::size_t n = 0; n < corners; ++n) {
      if (n > 0) word = lines.word_here();
      const auto point = parsed<std::int64_t>(word);
      if (!point || *point < first || *point > last)
        lines.refuse("has \"" + std::string(word.substr(0, 20)) + "\"",
                     "a point from " + std::to_string(first) + " to " + std::to_string(last));
      tags[as_size(*point - first)] = tag;
    }
    while (!lines.word_here().empty()) {
    }  // the region of a triangle
  }
  if (!lines.word().empty())
    lines.refuse("goes on after " + counted(count, what), "as many as the first line says");
  return count;
}

}  // namespace

bool is_carp_surface(const std::string& ending) { return ending == kTriangles || ending == kPoints; }

std::vector<std::string> surfaces_beside(const std::string& stem) {
  const std::filesystem::path path(stem);
  const std::filesystem::path folder = path.has_parent_path() ? path.parent_path() : ".";
  const std::string start = path.filename().string();
  std::vector<std::string> found;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed)) {
    const std::string file = (path.has_parent_path() ? entry.path() : entry.path().filename()).string();
    const std::string name = entry.path().filename().string();
    if (!is_carp_surface(ending_of(file)) || !name.starts_with(start) || name.size() == start.size())
      continue;
    const bool apart = std::string_view("._-").find(name[start.size()]) != std::string_view::npos;
    if (apart && role_by_name(name, start) != BorderRole::kLeft) found.push_back(file);
  }
  std::sort(found.begin(), found.end());
  // STEM.epi.vtx or STEM.epi.surf.vtx has the points of STEM.epi.surf.
  const std::vector<std::string> all = found;
  std::erase_if(found, [&all](const std::string& file) {
    return ending_of(file) == kPoints && std::any_of(all.begin(), all.end(), [&](const std::string& other) {
             const std::string own = stem_of(file);
             return ending_of(other) == kTriangles && (stem_of(other) == own || other == own);
           });
  });
  return found;
}

void add_carp_surfaces(const std::vector<std::string>& files, const std::string& stem, std::int64_t first,
                       DataSet& mesh, std::vector<std::string>& notes) {
  /// The later one counts.
  constexpr std::array<BorderRole, 5> kOrder{BorderRole::kBase, BorderRole::kOuter, BorderRole::kSeptum,
                                             BorderRole::kRight, BorderRole::kInner};
  const std::string name = std::filesystem::path(stem).filename().string();
  std::multimap<BorderRole, std::string> of_role;
  for (const std::string& file : files) {
    const BorderRole role = role_by_name(file, name);
    if (role == BorderRole::kLeft) {
      notes.push_back(file +
                      " does not say in its name which surface it is: left out (endo, lvendo, rvendo, "
                      "rvsept, epi, base)");
    } else {
      of_role.emplace(role, file);
    }
  }
  const bool inner = of_role.contains(BorderRole::kInner) || of_role.contains(BorderRole::kRight);
  if (!inner || !of_role.contains(BorderRole::kOuter)) {
    for (const auto& [role, file] : of_role)
      notes.push_back(file +
                      " is left out: surfaces are taken from files where one is an endocardium "
                      "(endo) and one the epicardium (epi)");
    return;
  }
  std::vector<std::uint8_t> tags(mesh.point_count(), 0);
  for (const BorderRole role : kOrder) {
    const auto [begin, end] = of_role.equal_range(role);
    for (auto file = begin; file != end; ++file) {
      const std::size_t rows = mark(file->second, first, static_cast<std::uint8_t>(tag_of(role)), tags);
      const bool one = role == BorderRole::kInner && !of_role.contains(BorderRole::kRight);
      notes.push_back(file->second + " is the " + (one ? "endocardium" : name_of(role)) + ", by its name: " +
                      counted(rows, ending_of(file->second) == kTriangles ? "triangle" : "point"));
    }
  }
  const std::vector<double> values(tags.begin(), tags.end());
  mesh.arrays.push_back(make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(values)));
}

}  // namespace palpate
