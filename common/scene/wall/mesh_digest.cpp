#include "common/scene/wall/mesh_digest.h"

#include <variant>
#include <vector>

#include "common/scene/cached_file.h"
#include "common/scene/sha256.h"

namespace palpate {

std::string mesh_digest(const DataSet& mesh, std::span<const DataArray* const> with, std::string_view words,
                        int threads) {
  std::vector<std::string_view> runs;
  std::string kinds(words);
  const auto add = [&](std::string_view bytes) { runs.push_back(bytes); };
  const auto add_array = [&](const DataArray& array) {
    kinds += std::string(" ") + name_of(array.type);
    add(bytes_of(array.bytes));
  };
  if (const auto* cells = std::get_if<UnstructuredTopology>(&mesh.topology)) {
    add_array(cells->positions);
    add(bytes_of(std::span(cells->types)));
    add(bytes_of(std::span(cells->offsets)));
    add(bytes_of(std::span(cells->connectivity)));
  } else if (const auto* points = std::get_if<StructuredTopology>(&mesh.topology)) {
    add_array(points->positions);
    for (int axis = 0; axis < 3; ++axis) kinds += " " + std::to_string(points->points[axis]);
  } else {
    return {};
  }
  add(bytes_of(std::span(mesh.visible)));
  add(bytes_of(std::span(mesh.hidden_cells)));
  for (const DataArray* array : with)
    if (array != nullptr) add_array(*array);
  return sha256_in_pieces(runs, kinds, threads);
}

}  // namespace palpate
