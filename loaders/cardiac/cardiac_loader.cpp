#include "loaders/cardiac/cardiac_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/volume_block.h"
#include "loaders/cardiac/carp_reader.h"
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
    info.format = name_of(format);
    switch (format) {
      case Format::kEx:
        open_ex(named, info);
        break;
      case Format::kCarp:
        mesh_ = read_carp(find_carp_files(named), info.notes);
        info.units = "coordinates in mm";
        break;
      default:
        mesh_ = read_tetgen(find_tetgen_files(named), info.notes);
        break;
    }
    if (mesh_.cell_count() == 0) throw input_error({named.front(), "", "holds no element"});
    info.blocks.push_back(describe_mesh(mesh_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t) override {
    DataSet chosen;
    chosen.topology = mesh_.topology;
    for (const DataArray& array : mesh_.arrays)
      if (std::find(names.begin(), names.end(), array.name) != names.end()) chosen.arrays.push_back(array);
    std::vector<DataSet> blocks;
    blocks.push_back(std::move(chosen));
    return blocks;
  }

 private:
  void open_ex(const std::vector<std::string>& named, FileInfo& info) {
    ex::Model model;
    const std::vector<std::string> files = ex_files(named);
    for (const std::string& file : files) ex::read_ex_file(file, model);
    ex::SampledModel sampled = ex::sample(model, kRefine, files.back());
    info.notes = std::move(sampled.notes);
    info.notes.push_back("volume of the curved model " +
                         short_number(ex::exact_volume(model, kQuadrature, files.back())));
    mesh_ = std::move(sampled.mesh);
  }

  DataSet mesh_;
};

}  // namespace

std::unique_ptr<Loader> make_cardiac_loader() { return std::make_unique<CardiacLoader>(); }

}  // namespace palpate
