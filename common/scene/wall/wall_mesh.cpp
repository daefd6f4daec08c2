#include "common/scene/wall/wall_mesh.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/field_grid.h"
#include "common/field/grid/cell_split.h"
#include "common/field/grid/tet_shape.h"
#include "common/field/heart/heart.h"
#include "common/field/layer/wall_layer.h"
#include "common/math/symmetric3.h"
#include "common/scene/remesher.h"
#include "common/scene/wall/mesh_client.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr std::uint8_t kVtkTetrahedron = 10, kVtkQuadraticTetrahedron = 24;
constexpr std::uint32_t kUnused = ~0U;

double six_volumes(const std::vector<Vec3>& points, const TetMesh::Tet& tet) {
  return TetShape(points.data(), tet).volume6;
}

/// How many there were. @throws Error (bad input) where nothing is left.
std::size_t leave_flat_ones_out(const std::vector<Vec3>& points, std::vector<TetMesh::Tet>& tets,
                                const std::string& file) {
  const std::size_t all = tets.size();
  std::erase_if(tets, [&](const TetMesh::Tet& tet) { return TetShape(points.data(), tet).flat(); });
  if (tets.empty())
    throw input_error({file, "", "has no tetrahedron with a volume", "tetrahedra that fill the wall"});
  return all - tets.size();
}

/// Leaves points without a cell out; for each that is left, which one it was.
std::vector<std::uint32_t> compact(std::vector<Vec3>& points, std::vector<TetMesh::Tet>& tets) {
  std::vector<std::uint32_t> number(points.size(), kUnused), was;
  for (const TetMesh::Tet& tet : tets)
    for (const std::uint32_t p : tet) number[p] = 0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (number[p] == kUnused) continue;
    number[p] = static_cast<std::uint32_t>(was.size());
    points[was.size()] = points[p];
    was.push_back(static_cast<std::uint32_t>(p));
  }
  points.resize(was.size());
  for (TetMesh::Tet& tet : tets)
    for (std::uint32_t& p : tet) p = number[p];
  return was;
}

/// For each point that is left, which one of the file it is.
std::vector<std::uint32_t> points_of_file(const SplitMesh& split, const std::vector<std::uint32_t>& was) {
  std::vector<std::uint32_t> input_of(split.points.size(), kUnused);
  for (std::size_t p = 0; p < split.point_of_input.size(); ++p) {
    const std::uint32_t q = split.point_of_input[p];
    if (q < input_of.size() && input_of[q] == kUnused) input_of[q] = static_cast<std::uint32_t>(p);
  }
  std::vector<std::uint32_t> from;
  from.reserve(was.size());
  for (const std::uint32_t q : was) from.push_back(input_of[q]);
  return from;
}

/// Directions and, where the heart has one, depth at the points that have none yet.
void sample_heart(const Heart& heart, const DataSet& block, const HeartChoice& choice, WallMesh& mesh) {
  const bool new_points = mesh.point_of_file.empty();
  const auto missing = [&](const std::string& name) {
    return new_points || block.find(name, Association::kPoint) == nullptr;
  };
  const auto add_directions = [&](const std::string& name, const TensorField& field) {
    if (!missing(name)) return;
    MeshColumn column{.name = name, .components = 3};
    CellHint hint;
    for (const Vec3& x : mesh.points) {
      const TensorSample sample = field.sample(x, hint);
      const Vec3 along =
          sample.status == SampleStatus::kOk ? symmetric_eigen(sample.value).vectors[0] : Vec3{kNaN};
      column.values.insert(column.values.end(), {along.x, along.y, along.z});
    }
    mesh.columns.push_back(std::move(column));
  };
  add_directions(choice.fibre.array, *heart.fibres);
  if (heart.sheets) add_directions(choice.sheet.array, *heart.sheets);
  if (!heart.layer || !missing(kLayerArray)) return;
  MeshColumn depth{.name = kLayerArray};
  CellHint hint;
  for (const Vec3& x : mesh.points) {
    const ScalarSample sample = heart.layer->sample(x, hint);
    depth.values.push_back(sample.status == SampleStatus::kOk ? sample.value : kNaN);
  }
  mesh.columns.push_back(std::move(depth));
}

}  // namespace

std::string name_of(WallFilling mesher) {
  switch (mesher) {
    case WallFilling::kCells:
      return "cells";
    case WallFilling::kTetgen:
      return "tetgen";
    case WallFilling::kDelaunay:
      break;
  }
  return "delaunay";
}

WallFilling wall_filling_from_name(const std::string& name) {
  for (const auto mesher : {WallFilling::kCells, WallFilling::kDelaunay, WallFilling::kTetgen})
    if (name_of(mesher) == name) return mesher;
  throw usage_error("--mesher " + name + ": cells, delaunay or tetgen is expected");
}

bool has_cell_directions(const HeartChoice& choice) noexcept {
  return choice.fibre.association == Association::kCell || choice.sheet.association == Association::kCell;
}

bool tetrahedra_alone(const DataSet& block) {
  const auto* cells = std::get_if<UnstructuredTopology>(&block.topology);
  return cells != nullptr && std::all_of(cells->types.begin(), cells->types.end(), [](std::uint8_t type) {
           return type == kVtkTetrahedron || type == kVtkQuadraticTetrahedron;
         });
}

WallMesh make_wall_mesh(const DataSet& given, const HeartChoice* choice, const WallMeshOptions& options,
                        const std::string& file, Progress* progress) {
  DataSet block = given;
  const std::size_t joined = join_same_points(block);
  if (progress != nullptr) progress->begin("splitting cells", 0);
  SplitMesh split = split_into_tetrahedra(std::span(&block, 1), file);
  WallMesh mesh;
  mesh.kept = tetrahedra_alone(block);
  for (const TetMesh::Tet& tet : split.tets)
    mesh.cells_volume += std::abs(six_volumes(split.points, tet)) / 6.0;
  if (split.merged_points + joined > 0)
    mesh.notes.push_back(counted(split.merged_points + joined, "point") +
                         " at the place of another one: joined");
  if (split.inverted_cells > 0)
    mesh.notes.push_back(counted(split.inverted_cells, "inverted cell") + " turned");
  if (split.folded_cells > 0)
    mesh.notes.push_back(counted(split.folded_cells, "cell") + " folded over themselves");

  const bool new_points = !mesh.kept && options.mesher == WallFilling::kTetgen;
  if (mesh.kept || options.mesher == WallFilling::kCells) {
    mesh.points = split.points;
    mesh.tets = std::move(split.tets);
    if (const std::size_t flat = leave_flat_ones_out(mesh.points, mesh.tets, file); flat > 0)
      mesh.notes.push_back(std::to_string(flat) + " tetrahedra without a volume left out");
  } else {
    MeshJob job{.mesher = new_points ? Mesher::kTetgen : Mesher::kDelaunay,
                .largest_volume = options.largest_volume};
    constexpr double kCoarser = 2.0;
    if (new_points && job.largest_volume == 0.0)
      job.largest_volume = kCoarser * mesh.cells_volume / static_cast<double>(split.tets.size());
    job.wall = {split.points, std::move(split.tets), std::move(split.source_cell)};
    mesh.counts = run_mesher(job, file, progress);
    mesh.tets = std::exchange(mesh.counts.tets, {});
    mesh.points = mesh.counts.points.empty() ? split.points : std::exchange(mesh.counts.points, {});
    if (!mesh.counts.note.empty()) mesh.notes.push_back(mesh.counts.note);
  }
  const std::size_t all = mesh.points.size();
  const std::vector<std::uint32_t> was = compact(mesh.points, mesh.tets);
  if (was.size() < all) mesh.notes.push_back(counted(all - was.size(), "point") + " without a cell left out");
  for (TetMesh::Tet& tet : mesh.tets)
    if (six_volumes(mesh.points, tet) < 0.0) std::swap(tet[2], tet[3]);

  if (!new_points) mesh.point_of_file = points_of_file(split, was);
  if (choice != nullptr && (new_points || has_cell_directions(*choice))) {
    if (progress != nullptr) progress->begin("fibres and layers of the cells", 0);
    const Heart heart = make_heart(block, *choice, file, options.threads, LayersNeeded::kIfPossible);
    sample_heart(heart, block, *choice, mesh);
    if (new_points)
      mesh.notes.emplace_back(
          "fibres, sheets and depth are those of where points lie; other arrays left out");
  }
  return mesh;
}

void carry_arrays(const DataSet& block, WallMesh& mesh) {
  if (mesh.point_of_file.empty()) return;
  for (const DataArray& array : carried_arrays(block, mesh.point_of_file)) {
    MeshColumn column{.name = array.name, .components = as_size(array.components)};
    column.values.reserve(column.components * array.tuples);
    for (std::size_t p = 0; p < array.tuples; ++p)
      for (int c = 0; c < array.components; ++c) column.values.push_back(array.at(p, c));
    mesh.columns.push_back(std::move(column));
  }
}

DataSet data_set_of(const WallMesh& mesh) {
  std::vector<double> numbers;
  numbers.reserve(3 * mesh.points.size());
  for (const Vec3& x : mesh.points) numbers.insert(numbers.end(), {x.x, x.y, x.z});
  UnstructuredTopology topology;
  topology.positions = make_array("points", Association::kPoint, 3, std::span<const double>(numbers));
  topology.types.assign(mesh.tets.size(), kVtkTetrahedron);
  topology.offsets.reserve(mesh.tets.size() + 1);
  topology.connectivity.reserve(4 * mesh.tets.size());
  topology.offsets.push_back(0);
  for (const TetMesh::Tet& tet : mesh.tets) {
    topology.connectivity.insert(topology.connectivity.end(), tet.begin(), tet.end());
    topology.offsets.push_back(static_cast<std::int64_t>(topology.connectivity.size()));
  }
  DataSet data;
  data.topology = std::move(topology);
  for (const MeshColumn& column : mesh.columns)
    data.arrays.push_back(make_array(column.name, Association::kPoint, static_cast<int>(column.components),
                                     std::span<const double>(column.values)));
  return data;
}

}  // namespace palpate
