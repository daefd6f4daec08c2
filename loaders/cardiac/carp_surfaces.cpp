#include "loaders/cardiac/carp_surfaces.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <span>
#include <string_view>
#include <system_error>
#include <utility>

#include "common/base/text.h"
#include "common/field/layer/numbered_faces.h"
#include "common/field/layer/wall_surfaces.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr const char* kTriangles = ".surf";
constexpr const char* kPoints = ".vtx";
/// Triangles that carry loads, as meshtool writes them beside .surf: three points, the element's region, its fourth point,
/// the element.
constexpr const char* kLoaded = ".neubc";
constexpr std::size_t kLoadedRow = 6;

/// What a file is by its name, but for that of its mesh; kLeft: it does not say.
BorderRole role_by_name(const std::string& file, const std::string& mesh) {
  std::string name = std::filesystem::path(stem_of(file)).filename().string();
  if (name.starts_with(mesh)) name.erase(0, mesh.size());
  return role_of_name(name);
}

/// Marks the points of a file. @return how many rows it has.
std::size_t mark(const std::string& file, std::int64_t first, BorderRole role, PointTags& tags) {
  constexpr std::size_t kLeastBytes = 2;  // "0\n"
  const bool loaded = ending_of(file) == kLoaded, triangles = loaded || ending_of(file) == kTriangles;
  const char* const what = triangles ? "triangle" : "point";
  TextLines lines(file, '#');
  const std::size_t count =
      believed_count(lines, triangles ? "the number of triangles" : "the number of points", kLeastBytes);
  const auto last = first + static_cast<std::int64_t>(tags.values().size()) - 1;
  for (std::size_t row = 0; row < count; ++row) {
    std::string_view word = lines.word();
    // Behind the count of points stands where they are stimulated, "intra" or "extra".
    if (!triangles && row == 0 && (word == "intra" || word == "extra")) word = lines.word();
    if (word.empty()) lines.refuse("ends after " + counted(row, what), std::to_string(count));
    std::size_t corners = loaded ? 3 : 1;
    if (triangles && !loaded) {
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
      tags.mark(*point - first, role);
    }
    std::size_t more = 0;
    while (!lines.word_here().empty()) ++more;  // the region of a triangle
    if (loaded && corners + more != kLoadedRow)
      lines.refuse("has a row of " + counted(corners + more, "number"), std::to_string(kLoadedRow));
  }
  if (!lines.word().empty())
    lines.refuse("goes on after " + counted(count, what), "as many as the first line says");
  return count;
}

}  // namespace

bool is_carp_surface(const std::string& ending) {
  return ending == kTriangles || ending == kPoints || ending == kLoaded;
}

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
  // STEM.epi.vtx or STEM.epi.surf.vtx has the points of STEM.epi.surf, STEM.epi.neubc its triangles.
  const std::vector<std::string> all = found;
  std::erase_if(found, [&all](const std::string& file) {
    return ending_of(file) != kTriangles &&
           std::any_of(all.begin(), all.end(), [&](const std::string& other) {
             const std::string own = stem_of(file);
             return ending_of(other) == kTriangles && (stem_of(other) == own || other == own);
           });
  });
  return found;
}

void add_carp_surfaces(const std::vector<std::string>& files, const std::string& stem, std::int64_t first,
                       DataSet& mesh, std::vector<std::string>& notes) {
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
  PointTags tags(mesh.point_count());
  for (const auto& [role, file] : of_role) {
    const std::size_t rows = mark(file, first, role, tags);
    const bool one = role == BorderRole::kInner && !of_role.contains(BorderRole::kRight);
    notes.push_back(file + " is the " + (one ? "endocardium" : name_of(role)) +
                    ", by its name: " + counted(rows, ending_of(file) == kPoints ? "point" : "triangle"));
  }
  mesh.arrays.push_back(
      make_array(kSurfaceArray, Association::kPoint, 1, std::span<const double>(tags.values())));
}

}  // namespace palpate
