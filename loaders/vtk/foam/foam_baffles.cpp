#include "loaders/vtk/foam/foam_baffles.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "common/base/disjoint_sets.h"
#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::uint8_t kPolyhedron = 42;  // of VTK's file format

std::span<const std::int64_t> points_of(const FoamFaces& faces, std::size_t face) {
  return std::span(faces.points).subspan(faces.begin[face], faces.begin[face + 1] - faces.begin[face]);
}

/// Faces of patches that let nothing through, by their points in order, which occur twice. @param first number of the
/// first of `faces` in the mesh.
std::vector<std::vector<std::int64_t>> doubled(const FoamFaces& faces, std::size_t first,
                                               std::span<const FoamPatch> patches) {
  std::vector<std::vector<std::int64_t>> sorted;
  for (const FoamPatch& patch : patches) {
    if (patch.type.substr(0, 6) == "cyclic" || patch.type.substr(0, 9) == "processor") continue;
    for (std::size_t i = 0; i < patch.faces && patch.first_face >= first; ++i) {
      const std::size_t face = patch.first_face - first + i;
      if (face + 1 >= faces.begin.size()) break;
      const auto points = points_of(faces, face);
      sorted.emplace_back(points.begin(), points.end());
      std::ranges::sort(sorted.back());
    }
  }
  std::ranges::sort(sorted);
  std::vector<std::vector<std::int64_t>> out;
  for (std::size_t i = 0; i + 1 < sorted.size(); ++i) {
    if (sorted[i].size() >= 3 && sorted[i] == sorted[i + 1]) out.push_back(sorted[i]);
  }
  return out;
}

/// The same numbers, and those of the copies behind them.
DataArray with_copies(const DataArray& array, std::span<const std::int64_t> copies) {
  const std::size_t size = as_size(array.components) * byte_size(array.type);
  auto bytes = std::make_shared<std::vector<std::byte>>(array.bytes.begin(), array.bytes.end());
  for (const std::int64_t copy : copies) {
    const auto of = array.bytes.subspan(as_size(copy) * size, size);
    bytes->insert(bytes->end(), of.begin(), of.end());
  }
  DataArray out = array;
  out.tuples += copies.size();
  out.bytes = *bytes;
  out.owner = std::move(bytes);
  return out;
}

}  // namespace

bool FoamBaffles::any(const FoamFaces& border, std::size_t first, std::span<const FoamPatch> patches) {
  return !doubled(border, first, patches).empty();
}

FoamBaffles::FoamBaffles(const FoamFaces& faces, std::span<const FoamPatch> patches,
                         std::span<const std::int64_t> owner, std::span<const std::int64_t> neighbour,
                         std::size_t points)
    : first_copy_(points) {
  const std::size_t count = std::min(faces.begin.size() - 1, owner.size());
  std::vector<std::uint8_t> on_baffle(points, 0);
  for (const auto& face : doubled(faces, 0, patches)) {
    for (const std::int64_t p : face) {
      if (p >= 0 && as_size(p) < points) on_baffle[as_size(p)] = 1;
    }
  }
  // Corners of cells at these points, united over the faces between cells.
  std::map<std::pair<std::int64_t, std::int64_t>, std::uint32_t> corners;  // by point and cell
  const auto each = [&](const auto& body) {
    for (std::size_t face = 0; face < count; ++face) {
      for (const std::int64_t p : points_of(faces, face)) {
        if (p >= 0 && as_size(p) < points && on_baffle[as_size(p)] != 0)
          body(p, owner[face], face < neighbour.size() ? neighbour[face] : -1);
      }
    }
  };
  each([&](std::int64_t p, std::int64_t own, std::int64_t other) {
    corners.try_emplace({p, own}, static_cast<std::uint32_t>(corners.size()));
    if (other >= 0) corners.try_emplace({p, other}, static_cast<std::uint32_t>(corners.size()));
  });
  DisjointSets groups(corners.size());
  each([&](std::int64_t p, std::int64_t own, std::int64_t other) {
    if (other >= 0) groups.unite(corners.at({p, own}), corners.at({p, other}));
  });
  // The last cell may own no face.
  for (const auto& of_faces : {owner, neighbour}) {
    for (const std::int64_t cell : of_faces) cells_ = std::max(cells_, as_size(cell + 1));
  }
  std::int64_t point = -1;
  std::map<std::uint32_t, std::int64_t> of_group;
  for (const auto& [corner, number] : corners) {
    if (corner.first != point) of_group.clear();
    point = corner.first;
    const std::uint32_t group = groups.find(number);
    const bool first = of_group.empty();
    const auto [found, fresh] = of_group.try_emplace(group, point);
    if (fresh && !first) {
      found->second = static_cast<std::int64_t>(first_copy_ + copies_.size());
      copies_.push_back(point);
    }
    if (found->second != point) point_of_[{corner.second, point}] = found->second;
  }
}

std::int64_t FoamBaffles::point_of(std::int64_t cell, std::int64_t point) const {
  const auto found = point_of_.find({cell, point});
  return found == point_of_.end() ? point : found->second;
}

bool FoamBaffles::split(DataSet& block) const {
  auto& mesh = std::get<UnstructuredTopology>(block.topology);
  if (mesh.positions.tuples != first_copy_ || mesh.types.size() != cells_) return false;
  mesh.positions = with_copies(mesh.positions, copies_);
  for (DataArray& array : block.arrays) {
    if (array.association == Association::kPoint) array = with_copies(array, copies_);
  }
  if (!block.visible.empty()) {
    for (const std::int64_t copy : copies_) block.visible.push_back(block.visible[as_size(copy)]);
  }
  std::int64_t before = -1;
  for (const auto& entry : point_of_) {
    const std::int64_t cell = entry.first.first;
    if (cell == before) continue;
    before = cell;
    auto at = as_size(mesh.offsets[as_size(cell)]);
    const auto end = as_size(mesh.offsets[as_size(cell) + 1]);
    const bool polyhedron = mesh.types[as_size(cell)] == kPolyhedron;
    if (polyhedron) ++at;  // the number of faces
    while (at < end) {
      std::size_t count = end - at;
      if (polyhedron) count = as_size(mesh.connectivity[at++]);
      for (std::size_t i = 0; i < count && at < end; ++i, ++at)
        mesh.connectivity[at] = point_of(cell, mesh.connectivity[at]);
    }
  }
  return true;
}

}  // namespace palpate
