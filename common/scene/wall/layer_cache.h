/// Layers that took time to solve, kept in a file of the user's cache (cached_file.h) so that the next opening
/// need not. They belong to one mesh: its cells, places and tagged surfaces.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/field/layer/wall_layer.h"
#include "common/scene/cached_file.h"

namespace palpate {

class LayerCache final : public CachedLayers {
 public:
  /// @param input the file that is opened. @param threads that compare meshes, as parallel_for().
  LayerCache(const std::filesystem::path& input, Keeping keeping, int threads = 0);

  std::optional<WallLayer> find(const DataSet& mesh) override;
  void keep(const DataSet& mesh, const WallLayer& layer, double seconds) override;

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_.file(); }
  /// What was taken or kept, or why not, for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return file_.notes(); }

 private:
  CachedFile file_;
  int threads_;
};

}  // namespace palpate
