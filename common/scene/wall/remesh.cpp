#include "common/scene/wall/remesh.h"

#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/scene/wall/mesh_cache.h"

namespace palpate {

WallMeshOptions wall_mesh_options(const Document& options, WallFilling usual) {
  const std::string& mesher = options.input.mesher;
  return {.mesher = mesher.empty() ? usual : wall_filling_from_name(mesher),
          .largest_volume = options.input.largest_volume,
          .threads = options.common.threads};
}

DataSet read_wall(Input& input, const std::vector<std::string>& names, Progress* progress) {
  std::vector<DataSet> blocks = input.read_timed(names, progress);
  if (blocks.size() != 1)
    throw input_error({input.title(), "", "has " + counted(blocks.size(), "block"), "one mesh"});
  return std::move(blocks.front());
}

std::optional<HeartChoice> choice_for_mesh(const Input& input) {
  if (fibre_choices(input.arrays()).empty()) return std::nullopt;
  HeartChoice choice = input.heart_choice();
  choice.constant_cells = false;
  return choice;
}

WallMesh mesh_of(const Input& input, const DataSet& block, const std::optional<HeartChoice>& choice,
                 const WallMeshOptions& options, Progress* progress) {
  const InputOptions& spec = input.spec();
  const bool file = !spec.files.empty();
  return cached_or_made_mesh(block, choice ? &*choice : nullptr, options,
                             file ? spec.files.front() : std::filesystem::path(input.title()),
                             file ? keeping_from_name(spec.cache) : Keeping::kOff, progress);
}

Remesher remesher_of(const Document& options) {
  const WallMeshOptions with = wall_mesh_options(options, WallFilling::kCells);
  if (with.mesher == WallFilling::kCells) return {};
  return [with](Input& input, Progress* progress) {
    const std::optional<HeartChoice> choice = choice_for_mesh(input);
    const DataSet block = read_wall(input, choice ? choice->arrays() : std::vector<std::string>(), progress);
    WallMesh mesh = mesh_of(input, block, choice, with, progress);
    Remeshed made{.mesh = data_set_of(mesh), .point_of_file = std::move(mesh.point_of_file), .notes = {}};
    if (!mesh.kept) {
      made.notes.push_back("filled with " + counted(mesh.tets.size(), "tetrahedron") + " by " +
                           name_of(with.mesher) + " in place of " + counted(block.cell_count(), "cell"));
    }
    for (std::string& note : mesh.notes) made.notes.push_back(std::move(note));
    return made;
  };
}

}  // namespace palpate
