#include "common/scene/wall/mesh_cache.h"

#include <algorithm>
#include <cstring>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/helper/message_json.h"
#include "common/load/helper/protocol.h"
#include "common/scene/wall/mesh_digest.h"

namespace palpate {
namespace {

using namespace message;

/// Goes up with every change of how cells are sampled, split, meshed and kept.
constexpr CachedFile::Kind kMesh{.what = "mesh", .version = "palpate mesh 1"};

std::string key_of(const DataSet& block, const HeartChoice* choice, const WallMeshOptions& options,
                   int threads) {
  std::string words = name_of(options.mesher) + " " + exact_number(options.largest_volume);
  std::vector<const DataArray*> with;
  if (choice != nullptr && (options.mesher == WallFilling::kTetgen || has_cell_directions(*choice))) {
    for (const std::string& name : choice->arrays()) {
      words += "\n" + name;
      for (const Association on : {Association::kPoint, Association::kCell})
        with.push_back(block.find(name, on));
    }
  }
  return mesh_digest(block, with, words, threads);
}

template <typename Row>
std::vector<Row> take_rows(std::string_view& rest, std::uint64_t count) {
  if (count > rest.size() / sizeof(Row)) malformed("fewer rows than it says");
  std::vector<Row> rows(count);
  if (count > 0) std::memcpy(rows.data(), rest.data(), count * sizeof(Row));
  rest.remove_prefix(count * sizeof(Row));
  return rows;
}

std::string encode(const WallMesh& mesh) {
  const FinishedMesh& counts = mesh.counts;
  Json columns = Json::array(), notes = Json::array();
  for (const MeshColumn& column : mesh.columns)
    columns.push_back({{"name", text_from_bytes(column.name)}, {"components", column.components}});
  for (const std::string& note : mesh.notes) notes.push_back(text_from_bytes(note));
  std::string text = Json{{"points", mesh.points.size()},
                          {"tets", mesh.tets.size()},
                          {"point_of_file", mesh.point_of_file.size()},
                          {"columns", std::move(columns)},
                          {"cells_volume", mesh.cells_volume},
                          {"outside", counts.outside},
                          {"flat", counts.flat},
                          {"shared", counts.shared},
                          {"seconds_triangulate", counts.seconds_triangulate},
                          {"seconds_choose", counts.seconds_choose},
                          {"notes", std::move(notes)}}
                         .dump() +
                     "\n";
  text += bytes_of(std::span<const Vec3>(mesh.points));
  text += bytes_of(std::span<const TetMesh::Tet>(mesh.tets));
  text += bytes_of(std::span<const std::uint32_t>(mesh.point_of_file));
  for (const MeshColumn& column : mesh.columns) text += bytes_of(std::span<const double>(column.values));
  return text;
}

/// @param points of the file. @throws ProtocolError.
WallMesh decode(std::string_view rest, std::size_t points) {
  const auto line = take_line(rest);
  if (!line) malformed("no description");
  const Json object = parse(*line);
  WallMesh mesh;
  mesh.points = take_rows<Vec3>(rest, count_at(object, "points"));
  mesh.tets = take_rows<TetMesh::Tet>(rest, count_at(object, "tets"));
  mesh.point_of_file = take_rows<std::uint32_t>(rest, count_at(object, "point_of_file"));
  for (const Json& of : array_at(object, "columns")) {
    MeshColumn column{
        .name = string_at(of, "name"), .values = {}, .components = as_size(count_at(of, "components"))};
    column.values = take_rows<double>(rest, column.components * mesh.points.size());
    mesh.columns.push_back(std::move(column));
  }
  if (!rest.empty()) malformed("more rows than it says");
  const auto in = [](std::size_t size) { return [size](std::uint32_t p) { return p < size; }; };
  for (const TetMesh::Tet& tet : mesh.tets)
    if (!std::ranges::all_of(tet, in(mesh.points.size()))) malformed("a corner that is no point");
  if (!std::ranges::all_of(mesh.point_of_file, in(points))) malformed("a point that the file has not");
  if (!mesh.point_of_file.empty() && mesh.point_of_file.size() != mesh.points.size())
    malformed("not one point of the file each");
  mesh.cells_volume = number_of(member(object, "cells_volume"), "cells_volume");
  mesh.counts.outside = count_at(object, "outside");
  mesh.counts.flat = count_at(object, "flat");
  mesh.counts.shared = count_at(object, "shared");
  mesh.counts.seconds_triangulate = number_of(member(object, "seconds_triangulate"), "seconds_triangulate");
  mesh.counts.seconds_choose = number_of(member(object, "seconds_choose"), "seconds_choose");
  mesh.notes = strings_at(object, "notes");
  return mesh;
}

}  // namespace

MeshCache::MeshCache(const std::filesystem::path& input, Keeping keeping, int threads)
    : file_(input, kMesh, keeping, threads), threads_(threads) {}

std::optional<WallMesh> MeshCache::find(const DataSet& block, const HeartChoice* choice,
                                        const WallMeshOptions& options) {
  if (!file_.there()) return std::nullopt;
  return file_.find(key_of(block, choice, options, threads_),
                    [&](std::string_view body) -> std::optional<WallMesh> {
                      try {
                        return decode(body, block.point_count());
                      } catch (const ProtocolError&) {
                        return std::nullopt;
                      }
                    });
}

void MeshCache::keep(const DataSet& block, const HeartChoice* choice, const WallMeshOptions& options,
                     const WallMesh& mesh, double seconds) {
  if (file_.wants(seconds)) file_.keep(key_of(block, choice, options, threads_), encode(mesh));
}

WallMesh cached_or_made_mesh(const DataSet& block, const HeartChoice* choice, const WallMeshOptions& options,
                             const std::filesystem::path& input, Keeping keeping, Progress* progress) {
  if (tetrahedra_alone(block)) keeping = Keeping::kOff;
  MeshCache cache(input, keeping, options.threads);
  std::optional<WallMesh> mesh = cache.find(block, choice, options);
  if (!mesh) {
    const Stopwatch watch;
    mesh = make_wall_mesh(block, choice, options, input.string(), progress);
    cache.keep(block, choice, options, *mesh, watch.seconds());
  }
  mesh->notes.insert(mesh->notes.end(), cache.notes().begin(), cache.notes().end());
  return std::move(*mesh);
}

}  // namespace palpate
