#include "common/scene/flow_series.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <string_view>
#include <tuple>
#include <utility>
#include <variant>

#include "common/base/text.h"
#include "common/field/field_on_grid.h"
#include "common/math/same_time.h"
#include "common/scene/tensor/read_vectors.h"
#include "common/scene/time_steps.h"

namespace palpate {
namespace {

bool same(const DataArray& a, const DataArray& b) {
  return a.type == b.type && a.components == b.components && std::ranges::equal(a.bytes, b.bytes);
}

bool same(const UniformTopology& a, const UniformTopology& b) {
  return a.points == b.points && a.origin == b.origin && a.axes == b.axes;
}
bool same(const RectilinearTopology& a, const RectilinearTopology& b) {
  return a.coordinates == b.coordinates;
}
bool same(const StructuredTopology& a, const StructuredTopology& b) {
  return a.points == b.points && same(a.positions, b.positions);
}
bool same(const UnstructuredTopology& a, const UnstructuredTopology& b) {
  return a.types == b.types && a.offsets == b.offsets && a.connectivity == b.connectivity &&
         same(a.positions, b.positions);
}

/// Whether both have the same cells at the same points, to the last bit, all of them seen or hidden alike.
bool same_cells(const DataSet& a, const DataSet& b) {
  if (a.topology.index() != b.topology.index() || a.visible != b.visible || a.hidden_cells != b.hidden_cells)
    return false;
  return std::visit(
      [&](const auto& topology) {
        return same(topology, std::get<std::decay_t<decltype(topology)>>(b.topology));
      },
      a.topology);
}

/// Which arrays a block has, in words: the grid is that of the blocks which have those of the field.
bool same_arrays(const DataSet& a, const DataSet& b) {
  return std::ranges::equal(a.arrays, b.arrays, [](const DataArray& x, const DataArray& y) {
    return x.name == y.name && x.association == y.association;
  });
}

bool has_points_at_one_place(const TetMesh& mesh) {
  std::vector<Vec3> points(mesh.points().begin(), mesh.points().end());
  const auto before = [](const Vec3& a, const Vec3& b) {
    return std::tie(a.x, a.y, a.z) < std::tie(b.x, b.y, b.z);
  };
  std::ranges::sort(points, before);
  return std::ranges::adjacent_find(points) != points.end();
}

bool has_walls(const TetMesh& mesh) {
  for (std::size_t c = 0; c < mesh.cells().size(); ++c) {
    for (int face = 0; face < 4; ++face) {
      if (mesh.closed(static_cast<CellIndex>(c), face)) return true;
    }
  }
  return false;
}

/// Points that were joined, or not, since their values agree at one step may not at another; and faces through which
/// nothing flows at one step may be no walls.
bool knows_no_values(const FieldGrid& grid) {
  if (grid.box != nullptr) return true;
  return grid.point_of_input.empty() && !has_walls(*grid.tets) && !has_points_at_one_place(*grid.tets);
}

/// What two notes have in common that differ in numbers.
std::string without_numbers(std::string_view note) {
  std::string out;
  for (const char c : note) {
    if (c < '0' || c > '9') out += c;
  }
  return out;
}

}  // namespace

std::vector<std::string> FlowSeries::field_notes(std::span<const std::string> known) const {
  std::vector<std::string> out;
  std::set<std::string> left;
  for (const std::string& note : known) left.insert(without_numbers(note));
  for (const auto& [key, said] : said_) {
    if (left.count(key) > 0) continue;
    out.push_back("at " + counted(said.steps.size(), "step") + ", the first of them at time " +
                  short_number(times_[*said.steps.begin()]) + ": " + said.note);
  }
  return out;
}

FlowSeries::FlowSeries(Input& input, int threads) : input_(input), threads_(threads) {
  const std::vector<double>& times = input.times();
  if (times.empty()) return;
  std::size_t repeated = 0;
  for (const std::size_t step : steps_in_order(times)) {
    if (!std::isfinite(times[step])) continue;
    if (!times_.empty() && same_time(times_.back(), times[step])) {
      steps_.back() = step;
      ++repeated;
      continue;
    }
    steps_.push_back(step);
    times_.push_back(times[step]);
  }
  if (repeated > 0) {
    notes_.push_back(counted(repeated, "step") +
                     " of the file at a time that another has, too: the last of them is taken");
  }
}

std::shared_ptr<const VectorField> FlowSeries::read(std::size_t index, Progress* progress) {
  VectorChoice choice = input_.choice();
  const std::size_t own = input_.time().step;
  input_.set_time_step(steps_[index]);
  std::vector<DataSet> blocks;
  try {
    blocks = read_vectors(input_, choice, progress);
  } catch (...) {
    input_.set_time_step(own);
    throw;
  }
  input_.set_time_step(own);
  const std::string file = input_.title();
  const bool kept = grid_ && std::ranges::equal(blocks, before_, [](const DataSet& a, const DataSet& b) {
                      return same_cells(a, b) && same_arrays(a, b);
                    });
  auto field = kept ? make_vector_field(grid_, blocks, choice, file, threads_)
                    : make_vector_field(blocks, choice, file, threads_);
  for (const std::string& note : field->notes().lines) {
    Said& said = said_.try_emplace(without_numbers(note), Said{.note = note, .steps = {}}).first->second;
    if (said.steps.empty() || index < *said.steps.begin()) said.note = note;
    said.steps.insert(index);
  }
  if (kept) return field;
  grid_.reset();
  before_.clear();
  if (!knows_no_values(*field->grid())) return field;
  grid_ = field->grid();
  before_ = std::move(blocks);
  for (DataSet& block : before_) {
    for (DataArray& array : block.arrays) {
      array.bytes = {};
      array.owner.reset();
      array.sparse.reset();
    }
  }
  return field;
}

}  // namespace palpate
