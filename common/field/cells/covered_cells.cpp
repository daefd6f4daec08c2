#include "common/field/cells/covered_cells.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "common/base/index.h"
#include "common/field/grid/overlaps.h"

namespace palpate {
namespace {

/// The block of each cell of the mesh.
std::vector<std::uint32_t> blocks_of(const TetMesh& mesh, const SplitMesh& split,
                                     std::span<const DataSet> blocks) {
  std::vector<std::size_t> end_cell;
  for (const DataSet& block : blocks)
    end_cell.push_back((end_cell.empty() ? 0 : end_cell.back()) + block.cell_count());
  std::vector<std::uint32_t> out(mesh.cells().size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    const std::size_t source = split.source_cell[mesh.cell_order()[c]];
    out[c] = static_cast<std::uint32_t>(std::ranges::upper_bound(end_cell, source) - end_cell.begin());
  }
  return out;
}

/// The value at barycentric coordinates of a cell of a mesh that `split` belongs to.
class CellValue {
 public:
  CellValue(const SplitMesh& split, std::size_t points, const ValueBeside& value)
      : value_(value), input_of_(points, 0) {
    for (std::size_t i = split.point_of_input.size(); i-- > 0;) {
      if (split.point_of_input[i] != kNoPoint)
        input_of_[split.point_of_input[i]] = static_cast<std::uint32_t>(i);
    }
  }
  [[nodiscard]] Vec3 at(const TetMesh::Tet& tet, std::uint32_t source, const Vec4& b) const {
    Vec3 sum{0.0};
    for (int i = 0; i < 4; ++i) sum += b[i] * value_(source, input_of_[tet[as_size(i)]]);
    return sum;
  }

 private:
  const ValueBeside& value_;
  std::vector<std::uint32_t> input_of_;  ///< for each point the first of the data's
};

}  // namespace

CoveredCells::CoveredCells(std::shared_ptr<TetMesh>& mesh, SplitMesh& split, std::span<const DataSet> blocks,
                           const ValueBeside& value, int threads)
    : one_block_(blocks.size() == 1) {
  const Overlaps found =
      find_overlaps(*mesh, one_block_ ? connected_parts(*mesh) : blocks_of(*mesh, split, blocks), threads);
  parts_ = found.parts;
  if (parts_ == 0) return;
  covered_ = as_size(std::ranges::count(found.covered, std::uint8_t{1}));
  contested_ = as_size(std::ranges::count(found.contested, std::uint8_t{1}));

  const std::shared_ptr<TetMesh> before = mesh;
  std::vector<std::uint32_t> kept;         // cells of the mesh
  std::vector<std::uint32_t> source_cell;  // of these
  std::vector<TetMesh::Tet> tets;
  for (std::size_t c = 0; c < before->cells().size(); ++c) {
    if (found.covered[c] != 0) continue;
    kept.push_back(static_cast<std::uint32_t>(c));
    tets.push_back(before->cells()[c]);
    source_cell.push_back(split.source_cell[before->cell_order()[c]]);
  }
  mesh = std::make_shared<TetMesh>(std::vector<Vec3>(before->points().begin(), before->points().end()), tets,
                                   threads);
  std::vector<std::uint32_t> rank(kept.size());
  std::vector<std::uint8_t> contested(kept.size());
  for (std::size_t c = 0; c < kept.size(); ++c) {
    rank[c] = found.rank[kept[mesh->cell_order()[c]]];
    contested[c] = found.contested[kept[mesh->cell_order()[c]]];
  }
  mesh->rank_cells(std::move(rank), std::move(contested));

  if (value) {
    const CellValue values(split, before->points().size(), value);
    for (std::size_t c = 0; c < found.covered.size(); ++c) {
      TetPoint there;
      if (found.covered[c] == 0 || before->zero_volume(static_cast<CellIndex>(c))) continue;
      const Vec4 middle(0.25);
      if (!mesh->locate(before->position(static_cast<CellIndex>(c), middle), kNoCell, there)) continue;
      const Vec3 lost = values.at(before->cells()[c], split.source_cell[before->cell_order()[c]], middle);
      const Vec3 counts = values.at(mesh->cells()[as_size(there.cell)],
                                    source_cell[mesh->cell_order()[as_size(there.cell)]], there.b);
      if (!is_finite(lost) || !is_finite(counts)) continue;
      compared_ = true;
      widest_ = std::max(widest_, glm::distance(lost, counts));
      largest_ = std::max(largest_, glm::length(counts));
    }
  }
  split.tets = std::move(tets);
  split.source_cell = std::move(source_cell);
}

void CoveredCells::note(FieldNotes& notes) const {
  if (parts_ == 0) return;
  const std::string one = one_block_ ? "part" : "block";
  std::string line = std::to_string(parts_) + " " + one + "s overlap: where they do, the " + one +
                     " whose cells are smallest in the mean counts (of equal ones the first); " +
                     std::to_string(covered_) + (covered_ == 1 ? " tetrahedron" : " tetrahedra") +
                     " of others wholly in it left out";
  if (compared_) {
    std::array<char, 96> text{};
    const double part = largest_ > 0.0 ? 100.0 * widest_ / largest_ : 0.0;
    std::snprintf(text.data(), text.size(),
                  ", whose values differ by up to %.3g (%.3g %% of the largest there)", widest_, part);
    line += text.data();
  }
  notes.lines.push_back(
      line + "; in the " + std::to_string(contested_) +
      " at its border a seed takes the values that count, a line stays with its cell until that ends, "
      "and the step between the values counts into its error");
}

}  // namespace palpate
