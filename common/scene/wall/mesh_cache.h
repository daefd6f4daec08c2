/// Tetrahedra that the mesher made, kept in a file of the user's cache (cached_file.h), so that
/// neither the next opening nor the next `mesh` runs it again.
///
/// They belong to the cells and places that were meshed, to the directions that came along, and to the
/// options of the mesher.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/scene/cached_file.h"
#include "common/scene/wall/wall_mesh.h"

namespace palpate {

class MeshCache {
 public:
  /// @param input the file that is opened.
  MeshCache(const std::filesystem::path& input, Keeping keeping, int threads = 0);

  /// What make_wall_mesh() made of the very same earlier; nothing where it is not kept.
  [[nodiscard]] std::optional<WallMesh> find(const DataSet& block, const HeartChoice* choice,
                                             const WallMeshOptions& options);
  /// @param seconds that making it took.
  void keep(const DataSet& block, const HeartChoice* choice, const WallMeshOptions& options,
            const WallMesh& mesh, double seconds);

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_.file(); }
  /// What was taken or kept, or why not, for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return file_.notes(); }

 private:
  CachedFile file_;
  int threads_;
};

/// make_wall_mesh(), or what was kept of it for `input`; its notes say which. Tetrahedra of the file are
/// not kept a second time.
/// @throws as make_wall_mesh().
[[nodiscard]] WallMesh cached_or_made_mesh(const DataSet& block, const HeartChoice* choice,
                                           const WallMeshOptions& options, const std::filesystem::path& input,
                                           Keeping keeping, Progress* progress);

}  // namespace palpate
