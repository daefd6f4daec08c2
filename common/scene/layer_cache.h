/// Layers that took time to solve, kept in a file beside the session so that the next opening need not.
///
/// The file belongs to one mesh: it holds the SHA-256 of cells, places and tagged surfaces, and of the
/// version of the solver, so that another --refine, a file that has changed or a newer program finds nothing
/// in it and writes it anew. The checksum of all before it stands at its end: what is damaged or cut off
/// counts as nothing, too.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/field/layer/wall_layer.h"

namespace palpate {

/// auto: layers that took more than half a second to solve; always: all; off: none is looked for or kept.
enum class LayerCaching : std::uint8_t { kAuto, kAlways, kOff };

/// "auto", "always", "off". @throws Error (usage) for another word.
[[nodiscard]] LayerCaching layer_caching_from_name(const std::string& name);

class LayerCache final : public KeptLayers {
 public:
  /// @param input the file that is opened: "heart.pts" keeps its layers in "heart.palpate.layers" beside it.
  /// @param threads that compare meshes, as parallel_for().
  LayerCache(const std::filesystem::path& input, LayerCaching caching, int threads = 0);

  std::optional<WallLayer> find(const DataSet& mesh) override;
  /// Where the folder cannot be written, nothing is kept and notes() says so.
  void keep(const DataSet& mesh, const WallLayer& layer, double seconds) override;

  [[nodiscard]] const std::filesystem::path& file() const noexcept { return file_; }
  /// What was taken or kept, or why not, for the user.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  std::filesystem::path file_;
  LayerCaching caching_;
  int threads_;
  std::vector<std::string> notes_;
};

}  // namespace palpate
