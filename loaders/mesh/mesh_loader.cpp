#include "loaders/mesh/mesh_loader.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/load/volume_block.h"
#include "loaders/mesh/mesh_file.h"

namespace palpate {
namespace {

std::vector<ArrayInfo> arrays_of(const DataSet& block) {
  std::vector<ArrayInfo> out;
  for (const DataArray& array : block.arrays)
    out.push_back({array.name, array.association, array.components, array.type, array.tuples, 0});
  return out;
}

BlockInfo describe_structured(const DataSet& block) {
  const auto& grid = std::get<StructuredTopology>(block.topology);
  BlockInfo out;
  out.name = block.name;
  out.grid = "curvilinear";
  out.points = grid.points;
  out.point_count = block.point_count();
  out.cell_count = block.cell_count();
  for (std::size_t p = 0; p < grid.positions.tuples; ++p)
    out.bounds.include({grid.positions.at(p, 0), grid.positions.at(p, 1), grid.positions.at(p, 2)});
  if (std::min({grid.points.x, grid.points.y, grid.points.z}) < 2) out.not_volume = kOnlyFlatCells;
  return out;
}

BlockInfo describe(const DataSet& block) {
  BlockInfo out = std::holds_alternative<StructuredTopology>(block.topology) ? describe_structured(block)
                                                                             : describe_mesh(block);
  out.name = block.name;
  out.arrays = arrays_of(block);
  return out;
}

class MeshLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    const std::string file = request.files.front().string();
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "",
                         "is a second " + std::string(row_of(format).name) + " file", "one file"});
    if (!request.surface_markers.empty() && format != Format::kGmsh)
      throw usage_error("--surface-markers " + request.surface_markers + ": " +
                        std::string(row_of(format).name) + " files number no faces that are read");
    const MappedFile mapped(file);
    switch (format) {
      case Format::kGmsh:
        mesh_ = read_gmsh(mapped.text(), file,
                          request.wall ? std::optional(request.surface_markers) : std::nullopt);
        break;
      case Format::kSu2:
        mesh_ = read_su2(mapped.text(), file);
        break;
      case Format::kTecplot:
        mesh_ = read_tecplot(mapped.text(), file);
        break;
      default:
        mesh_ = read_ucd(mapped.text(), file);
        break;
    }
    FileInfo info;
    info.times = mesh_.times.size() > 1 ? mesh_.times : std::vector<double>{};
    info.notes = mesh_.notes;
    std::vector<BlockInfo> flat;
    for (const DataSet& block : mesh_.steps.back()) {
      BlockInfo about = describe(block);
      (about.not_volume.empty() ? info.blocks : flat).push_back(std::move(about));
    }
    if (info.blocks.empty()) {
      info.blocks = std::move(flat);
    } else {
      for (const BlockInfo& block : flat)
        info.notes.push_back("block '" + block.name + "' left out: " + block.not_volume);
      for (std::vector<DataSet>& blocks : mesh_.steps)
        std::erase_if(blocks, [](const DataSet& block) { return !describe(block).not_volume.empty(); });
    }
    for (BlockInfo& block : info.blocks) block.faces = block.faces || mesh_.faces;
    if (info.blocks.empty()) throw input_error({file, "", "holds no cells", "a mesh", ""});
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    std::vector<DataSet> out;
    for (const DataSet& block : mesh_.steps[std::min(step, mesh_.steps.size() - 1)]) {
      DataSet copy = block;
      std::erase_if(copy.arrays, [&](const DataArray& array) {
        return std::find(names.begin(), names.end(), array.name) == names.end();
      });
      out.push_back(std::move(copy));
    }
    return out;
  }

 private:
  MeshFile mesh_;
};

}  // namespace

void CellList::add(std::uint8_t type, const std::int64_t* points, std::size_t count) {
  types_.push_back(type);
  connectivity_.insert(connectivity_.end(), points, points + count);
  offsets_.push_back(static_cast<std::int64_t>(connectivity_.size()));
}

void CellList::take(UnstructuredTopology& mesh) {
  mesh.types = std::move(types_);
  mesh.offsets = std::move(offsets_);
  mesh.connectivity = std::move(connectivity_);
}

DataArray mesh_array(const std::string& name, Association association, int components,
                     const std::vector<double>& values) {
  return make_array(name, association, components, std::span<const double>(values));
}

std::unique_ptr<Loader> make_mesh_loader() { return std::make_unique<MeshLoader>(); }

}  // namespace palpate
