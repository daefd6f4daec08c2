/// XDMF through libxdmf.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <XdmfAttribute.hpp>
#include <XdmfAttributeCenter.hpp>
#include <XdmfCurvilinearGrid.hpp>
#include <XdmfDomain.hpp>
#include <XdmfGeometry.hpp>
#include <XdmfGeometryType.hpp>
#include <XdmfGridCollection.hpp>
#include <XdmfGridCollectionType.hpp>
#include <XdmfReader.hpp>
#include <XdmfRectilinearGrid.hpp>
#include <XdmfRegularGrid.hpp>
#include <XdmfTime.hpp>
#include <XdmfTopology.hpp>
#include <XdmfTopologyType.hpp>
#include <XdmfUnstructuredGrid.hpp>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/files/memory_text.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/helper/serve.h"
#include "common/load/volume_block.h"
#include "loaders/hdf/hdf5_check.h"
#include "loaders/xdmf/xdmf_items.h"
#include "loaders/xdmf/xdmf_text.h"

namespace palpate {
namespace {

using Grid = shared_ptr<XdmfGrid>;

/// Thrown where only the grid is known: who knows the file says its name.
struct Unusable {
  std::string what;
};

struct Kind {
  const char* name;      ///< of libxdmf
  std::uint8_t vtk = 0;  ///< of VTK's file format
  int number = 0;        ///< in a mixed topology
  std::size_t nodes = 0;
};
constexpr std::array kKinds{Kind{"Triangle", 5, 4, 3},         Kind{"Quadrilateral", 9, 5, 4},
                            Kind{"Tetrahedron", 10, 6, 4},     Kind{"Pyramid", 14, 7, 5},
                            Kind{"Wedge", 13, 8, 6},           Kind{"Hexahedron", 12, 9, 8},
                            Kind{"Tetrahedron_10", 24, 38, 10}};

template <typename T>
std::vector<T> numbers_of(XdmfArray& array) {
  if (!array.isInitialized()) array.read();
  std::vector<T> out(array.getSize());
  if (!out.empty()) array.getValues(0, out.data(), static_cast<unsigned>(out.size()), 1, 1);
  return out;
}

UnstructuredTopology cells_of(XdmfTopology& topology, std::size_t points) {
  UnstructuredTopology mesh;
  mesh.offsets.push_back(0);
  const std::vector<std::int64_t> list = numbers_of<std::int64_t>(topology);
  const std::string name = topology.getType()->getName();
  const bool mixed = name == "Mixed";
  const auto* kind = std::ranges::find_if(kKinds, [&](const Kind& k) { return name == k.name; });
  if (!mixed && kind == kKinds.end()) throw Unusable{"has cells of kind '" + name + "', which are not read"};
  for (std::size_t at = 0; at < list.size();) {
    if (mixed) {
      kind = std::ranges::find_if(kKinds, [&](const Kind& k) { return list[at] == k.number; });
      if (kind == kKinds.end())
        throw Unusable{"has cells of number " + std::to_string(list[at]) +
                       " in its mixed topology, which are not read"};
      ++at;
    }
    if (list.size() - at < kind->nodes) throw Unusable{"has a list of cells that ends within one"};
    for (std::size_t n = 0; n < kind->nodes; ++n) {
      const std::int64_t point = list[at + n];
      if (point < 0 || as_size(point) >= points)
        throw Unusable{"has a cell of point " + std::to_string(point) + " of " + std::to_string(points)};
      mesh.connectivity.push_back(point);
    }
    at += kind->nodes;
    mesh.types.push_back(kind->vtk);
    mesh.offsets.push_back(static_cast<std::int64_t>(mesh.connectivity.size()));
  }
  return mesh;
}

DataArray positions_of(XdmfGeometry& geometry) {
  constexpr std::size_t kAxes = 3;
  if (geometry.getType()->getName() != "XYZ")
    throw Unusable{"has a geometry of type '" + geometry.getType()->getName() + "', which is not read"};
  const std::vector<double> all = numbers_of<double>(geometry);
  if (all.size() % kAxes != 0) throw Unusable{"has coordinates that are no triples"};
  return make_array("positions", Association::kPoint, static_cast<int>(kAxes), std::span<const double>(all));
}

/// From an array in the order z, y, x.
Index3 counts_of(XdmfArray& array) {
  const std::vector<std::int64_t> n = numbers_of<std::int64_t>(array);
  constexpr std::int64_t kMost = 1 << 20;
  if (n.size() != 3 || std::ranges::any_of(n, [](std::int64_t c) { return c < 2 || c > kMost; }))
    throw Unusable{"is no grid of three axes"};
  return {static_cast<int>(n[2]), static_cast<int>(n[1]), static_cast<int>(n[0])};
}

void read_topology(const Grid& grid, DataSet& block) {
  if (const auto mesh = shared_dynamic_cast<XdmfUnstructuredGrid>(grid)) {
    DataArray positions = positions_of(*mesh->getGeometry());
    UnstructuredTopology cells = cells_of(*mesh->getTopology(), positions.tuples);
    cells.positions = std::move(positions);
    block.topology = std::move(cells);
  } else if (const auto image = shared_dynamic_cast<XdmfRegularGrid>(grid)) {
    UniformTopology lattice;
    lattice.points = counts_of(*image->getDimensions());
    const std::vector<double> origin = numbers_of<double>(*image->getOrigin()),
                              step = numbers_of<double>(*image->getBrickSize());
    if (origin.size() != 3 || step.size() != 3) throw Unusable{"has no origin and spacing along three axes"};
    for (int axis = 0; axis < 3; ++axis) {
      lattice.origin[axis] = origin[as_size(2 - axis)];
      lattice.axes[axis][axis] = step[as_size(2 - axis)];
      if (!std::isfinite(lattice.origin[axis]) || !std::isfinite(lattice.axes[axis][axis]) ||
          lattice.axes[axis][axis] == 0.0)
        throw Unusable{"has a spacing of 0, or one that is not finite"};
    }
    block.topology = lattice;
  } else if (const auto lines = shared_dynamic_cast<XdmfRectilinearGrid>(grid)) {
    RectilinearTopology lattice;
    for (unsigned axis = 0; axis < 3; ++axis) {
      const auto coordinates = lines->getCoordinates(axis);
      if (!coordinates) throw Unusable{"is no grid of three axes"};
      auto& x = lattice.coordinates[axis] = numbers_of<double>(*coordinates);
      const bool rises =
          std::ranges::adjacent_find(x, [](double a, double b) { return !(a < b); }) == x.end();
      const bool falls =
          std::ranges::adjacent_find(x, [](double a, double b) { return !(a > b); }) == x.end();
      if (x.size() < 2 || !(rises || falls))
        throw Unusable{"has coordinates that neither rise nor fall all along"};
    }
    block.topology = std::move(lattice);
  } else if (const auto curved = shared_dynamic_cast<XdmfCurvilinearGrid>(grid)) {
    StructuredTopology lattice;
    lattice.points = counts_of(*curved->getDimensions());
    lattice.positions = positions_of(*curved->getGeometry());
    const std::size_t due = as_size(lattice.points.x) * as_size(lattice.points.y) * as_size(lattice.points.z);
    if (lattice.positions.tuples != due)
      throw Unusable{"has " + std::to_string(lattice.positions.tuples) + " points where " +
                     std::to_string(due) + " are due"};
    block.topology = std::move(lattice);
  } else {
    throw Unusable{"is of a kind that is not read"};
  }
}

/// The attributes in `wanted`, or all (null). @param left_out gets those that are not read, with the reason.
void read_attributes(XdmfGrid& grid, const std::set<std::string>* wanted, DataSet& block,
                     std::vector<std::string>& left_out) {
  for (unsigned a = 0; a < grid.getNumberAttributes(); ++a) {
    XdmfAttribute& attribute = *grid.getAttribute(a);
    const std::string name = attribute.getName();
    if (wanted != nullptr && wanted->count(name) == 0) continue;
    const bool nodes = attribute.getCenter() == XdmfAttributeCenter::Node();
    if (!nodes && attribute.getCenter() != XdmfAttributeCenter::Cell()) {
      left_out.push_back("attribute '" + name + "' is of neither nodes nor cells; left out");
      continue;
    }
    const std::size_t tuples = nodes ? block.point_count() : block.cell_count();
    const std::vector<double> values = numbers_of<double>(attribute);
    constexpr std::size_t kMost = 9;
    if (tuples == 0 || values.size() % tuples != 0 || values.size() / tuples < 1 ||
        values.size() / tuples > kMost) {
      throw Unusable{"has " + std::to_string(values.size()) + " numbers of '" + name + "' for " +
                     std::to_string(tuples) + (nodes ? " points" : " cells")};
    }
    block.arrays.push_back(make_array(name, nodes ? Association::kPoint : Association::kCell,
                                      static_cast<int>(values.size() / tuples),
                                      std::span<const double>(values)));
  }
}

bool same_bytes(const DataArray& a, const DataArray& b) { return std::ranges::equal(a.bytes, b.bytes); }

/// Whether both are the same points and cells.
bool same_grid(const DataSet& a, const DataSet& b) {
  if (a.topology.index() != b.topology.index()) return false;
  if (const auto* p = std::get_if<UnstructuredTopology>(&a.topology)) {
    const auto& q = std::get<UnstructuredTopology>(b.topology);
    return p->types == q.types && p->connectivity == q.connectivity && same_bytes(p->positions, q.positions);
  }
  if (const auto* p = std::get_if<UniformTopology>(&a.topology)) {
    const auto& q = std::get<UniformTopology>(b.topology);
    return p->points == q.points && p->origin == q.origin && p->axes == q.axes;
  }
  if (const auto* p = std::get_if<RectilinearTopology>(&a.topology))
    return p->coordinates == std::get<RectilinearTopology>(b.topology).coordinates;
  const auto &p = std::get<StructuredTopology>(a.topology), &q = std::get<StructuredTopology>(b.topology);
  return p.points == q.points && same_bytes(p.positions, q.positions);
}

class XdmfLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second XDMF file", "one file"});
    file_ = request.files.front().string();
    const XdmfText text = look_at_xdmf(MappedFile(file_).text());
    if (!text.problem.empty())
      throw input_error({file_, "", text.problem, "values in the file or beside it"});
    for (const std::string& name : text.hdf5)
      check_hdf5((request.files.front().parent_path() / name).string());
    FileInfo info;
    if (const auto plain = with_plain_items(file_, info.notes)) plain_ = memory_.write(*plain);
    guarded([&] {
      read_document();
      for (const auto& [time, grids] : steps_) {
        if (time) info.times.push_back(*time);
      }
      if (info.times.size() == 1) info.times.clear();
      for (const DataSet& block : blocks_of(steps_.begin()->second, nullptr, &info.notes)) {
        info.blocks.push_back(describe(block));
      }
    });
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    if (!domain_) throw work_error("nothing was opened");
    const std::set<std::string> wanted(names.begin(), names.end());
    std::vector<DataSet> blocks;
    guarded([&] {
      read_document();  // libxdmf holds the numbers of every step that was read
      blocks =
          blocks_of(std::next(steps_.begin(), static_cast<std::ptrdiff_t>(step))->second, &wanted, nullptr);
    });
    return blocks;
  }

 private:
  template <class Body>
  void guarded(const Body& body) const {
    try {
      body();
    } catch (const Unusable& unusable) {
      throw input_error({file_, "", unusable.what, "", ""});
    } catch (const Error&) {
      throw;
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      throw input_error({file_, "", "libxdmf: " + printable(std::string(error.what()).substr(0, 200)), "",
                         "the file may be damaged"});
    }
  }

  void read_document() {
    steps_.clear();
    reader_ = XdmfReader::New();
    domain_ = shared_dynamic_cast<XdmfDomain>(
        reader_->read(plain_.empty() ? std::filesystem::absolute(file_).string() : plain_));
    if (!domain_) throw Unusable{"has no domain"};
    collect(*domain_, std::nullopt);
    if (steps_.size() > 1) steps_.erase(std::nullopt);  // the mesh by itself, beside its times
    if (steps_.empty()) throw Unusable{"has no grid"};
  }

  void add(const Grid& grid, std::optional<double> time) {
    if (!grid) return;
    if (!time && grid->getTime()) time = grid->getTime()->getValue();
    if (time && !std::isfinite(*time)) throw Unusable{"has a time that is no number"};
    steps_[time].push_back(grid);
  }

  /// Adds the grids of a domain or a collection. @param time that they have; nothing: their own.
  template <class Group>
  void collect(Group& group, std::optional<double> time) {
    for (unsigned g = 0; g < group.getNumberUnstructuredGrids(); ++g) add(group.getUnstructuredGrid(g), time);
    for (unsigned g = 0; g < group.getNumberRegularGrids(); ++g) add(group.getRegularGrid(g), time);
    for (unsigned g = 0; g < group.getNumberRectilinearGrids(); ++g) add(group.getRectilinearGrid(g), time);
    for (unsigned g = 0; g < group.getNumberCurvilinearGrids(); ++g) add(group.getCurvilinearGrid(g), time);
    for (unsigned g = 0; g < group.getNumberGridCollections(); ++g) {
      const auto collection = group.getGridCollection(g);
      std::optional<double> own = time;
      if (!own && collection->getType() != XdmfGridCollectionType::Temporal() && collection->getTime())
        own = collection->getTime()->getValue();
      collect(*collection, own);
    }
  }

  std::vector<DataSet> blocks_of(const std::vector<Grid>& grids, const std::set<std::string>* wanted,
                                 std::vector<std::string>* notes) const {
    std::vector<DataSet> blocks;
    for (const Grid& grid : grids) {
      DataSet block;
      block.name = grids.size() > 1 ? grid->getName() : "";
      std::vector<std::string> left_out;
      read_topology(grid, block);
      read_attributes(*grid, wanted, block, left_out);
      if (notes != nullptr) notes->insert(notes->end(), left_out.begin(), left_out.end());
      const auto same =
          std::ranges::find_if(blocks, [&](const DataSet& other) { return same_grid(other, block); });
      if (same == blocks.end()) {
        blocks.push_back(std::move(block));
        continue;
      }
      for (DataArray& array : block.arrays) {
        if (same->find(array.name, array.association) == nullptr) same->arrays.push_back(std::move(array));
      }
    }
    if (blocks.size() == 1) blocks.front().name.clear();
    return blocks;
  }

  static BlockInfo describe(const DataSet& block) {
    if (std::holds_alternative<UnstructuredTopology>(block.topology)) return describe_mesh(block);
    BlockInfo about;
    about.name = block.name;
    about.point_count = block.point_count();
    about.cell_count = block.cell_count();
    for (const DataArray& array : block.arrays)
      about.arrays.push_back({array.name, array.association, array.components, array.type, array.tuples});
    if (const auto* image = std::get_if<UniformTopology>(&block.topology)) {
      about.grid = "uniform";
      about.points = image->points;
      about.bounds = sample_bounds(*image);
    } else if (const auto* lines = std::get_if<RectilinearTopology>(&block.topology)) {
      const auto& x = lines->coordinates;
      about.grid = "rectilinear";
      for (int axis = 0; axis < 3; ++axis) about.points[axis] = static_cast<int>(x[as_size(axis)].size());
      about.bounds.include({x[0].front(), x[1].front(), x[2].front()});
      about.bounds.include({x[0].back(), x[1].back(), x[2].back()});
    } else {
      const auto& curved = std::get<StructuredTopology>(block.topology);
      about.grid = "curvilinear";
      about.points = curved.points;
      for (std::size_t p = 0; p < curved.positions.tuples; ++p)
        about.bounds.include(
            {curved.positions.at(p, 0), curved.positions.at(p, 1), curved.positions.at(p, 2)});
    }
    return about;
  }

  std::string file_;
  MemoryText memory_;
  std::string plain_;  ///< name of a text that stands for that of the file; empty: none does
  shared_ptr<XdmfReader> reader_;
  shared_ptr<XdmfDomain> domain_;
  std::map<std::optional<double>, std::vector<Grid>> steps_;  ///< by their times, rising
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_xdmf_loader() { return std::make_unique<XdmfLoader>(); }

}  // namespace palpate
