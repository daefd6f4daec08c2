#include "loaders/cardiac/cardiac_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/base/error.h"
#include "common/base/memory.h"
#include "common/base/text.h"
#include "common/load/volume_block.h"
#include "loaders/cardiac/carp_reader.h"
#include "loaders/cardiac/carp_results.h"
#include "loaders/cardiac/ex_mesh.h"
#include "loaders/cardiac/ex_reader.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/tetgen_reader.h"

namespace palpate {
namespace {

/// Hexahedra along each axis of a curved element.
constexpr int kRefine = 4;
/// Of the quadrature: nine points are exact to rounding on elements that hardly bend within themselves.
constexpr int kQuadrature = 9;

/// "beside" files of an EX model: nodes and elements come as a pair.
std::vector<std::string> ex_files(const std::vector<std::string>& named) {
  std::vector<std::string> files = named;
  const auto has = [&files](const char* ending) {
    return std::any_of(files.begin(), files.end(),
                       [ending](const std::string& file) { return ending_of(file) == ending; });
  };
  for (const auto& [one, other] : {std::pair{".exnode", ".exelem"}, std::pair{".exelem", ".exnode"}}) {
    if (!has(one) || has(other)) continue;
    const std::string found = sibling(named.front(), other);
    if (found.empty())
      throw input_error({named.front(), "", std::string("has no ") + other + " file beside it",
                         stem_of(named.front()) + other, "name it too"});
    files.push_back(found);
  }
  // Nodes first: elements name them.
  std::stable_partition(files.begin(), files.end(),
                        [](const std::string& file) { return ending_of(file) != ".exelem"; });
  return files;
}

class CardiacLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    std::vector<std::string> named;
    for (const auto& file : request.files) named.push_back(file.string());
    FileInfo info;
    if (!request.surface_markers.empty() && (format == Format::kEx || format == Format::kCarp))
      throw usage_error("--surface-markers " + request.surface_markers + ": " +
                        std::string(row_of(format).name) +
                        " has no .face file; markers are those of TetGen's");
    switch (format) {
      case Format::kEx:
        open_ex(named, request.refine > 0 ? request.refine : kRefine, info);
        break;
      case Format::kCarp:
        open_carp(find_carp_files(named), info);
        info.units = "coordinates in mm";
        break;
      default:
        mesh_ = read_tetgen(find_tetgen_files(named), request.surface_markers, info.notes);
        break;
    }
    if (mesh_.cell_count() == 0) throw input_error({named.front(), "", "holds no element"});
    info.blocks.push_back(describe_mesh(mesh_));
    for (const IgbFile& series : series_) info.blocks.back().arrays.push_back(series.info());
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    DataSet chosen;
    chosen.topology = mesh_.topology;
    for (const DataArray& array : mesh_.arrays)
      if (std::find(names.begin(), names.end(), array.name) != names.end()) chosen.arrays.push_back(array);
    for (const IgbFile& series : series_)
      if (std::find(names.begin(), names.end(), series.info().name) != names.end())
        chosen.arrays.push_back(series.read(step));
    std::vector<DataSet> blocks;
    blocks.push_back(std::move(chosen));
    return blocks;
  }

 private:
  void open_carp(const CarpFiles& files, FileInfo& info) {
    mesh_ = read_carp(files, info.notes);
    for (const std::string& file : files.results) {
      if (ending_of(file) == ".dat") {
        mesh_.arrays.push_back(read_dat(file, mesh_.point_count(), mesh_.cell_count()));
        continue;
      }
      series_.emplace_back(file, mesh_.point_count());
      const IgbFile& series = series_.back();
      if (series_.size() > 1 && series.times() != series_.front().times())
        throw input_error(
            {file, "header", "has other times than " + series_.front().file(), "the same ones"});
      if (!series.unit().empty()) info.notes.push_back(series.info().name + " in " + series.unit());
    }
    if (series_.empty()) return;
    info.times = series_.front().times();
    if (!series_.front().time_unit().empty()) info.notes.push_back("times in " + series_.front().time_unit());
  }

  void open_ex(const std::vector<std::string>& named, int refine, FileInfo& info) {
    ex::Model model;
    const std::vector<std::string> files = ex_files(named);
    for (const std::string& file : files) ex::read_ex_file(file, model);
    ex::SampledModel sampled = ex::sample(model, refine, files.back(), usable_memory());
    info.notes = std::move(sampled.notes);
    info.exact_volume = ex::exact_volume(model, kQuadrature, files.back());
    info.notes.push_back("volume of the curved model " + short_number(info.exact_volume));
    info.long_axis = ex::long_axis(model);
    mesh_ = std::move(sampled.mesh);
  }

  DataSet mesh_;
  std::vector<IgbFile> series_;  ///< of which a step is read when it is asked for
};

}  // namespace

std::unique_ptr<Loader> make_cardiac_loader() { return std::make_unique<CardiacLoader>(); }

}  // namespace palpate
