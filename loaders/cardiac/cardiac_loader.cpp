#include "loaders/cardiac/cardiac_loader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/memory.h"
#include "common/base/text.h"
#include "common/load/volume_block.h"
#include "loaders/cardiac/carp_reader.h"
#include "loaders/cardiac/carp_results.h"
#include "loaders/cardiac/ex/ex_mesh.h"
#include "loaders/cardiac/ex/ex_times.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/tetgen_reader.h"

namespace palpate {
namespace {

/// Hexahedra along each axis of a curved element.
constexpr int kRefine = 4;
/// Of the quadrature: nine points are exact to rounding on elements that hardly bend within themselves.
constexpr int kQuadrature = 9;

/// What a result is called: "vm" for heart.vm.igb beside heart.pts. @param name that of its file.
std::string result_name(const std::string& name, const std::string& pts) {
  const std::string start = std::filesystem::path(stem_of(pts)).filename().string() + ".";
  return name.starts_with(start) && name.size() > start.size() ? name.substr(start.size()) : name;
}

/// What results have by openCARP's convention, by their names: potentials in mV ("vm", "phie"), times at which something
/// happened in ms ("activation", "init_acts_vm", "lat", "repol", "apd"); empty: others.
const char* usual_unit(const std::string& name) {
  const std::string low = lowered(name);
  if (low == "potential" || low == "phi_e") return "mV";
  const char* unit = "";
  for (const std::string_view part : split(low, '_')) {
    for (const std::string_view of : split(part, '.')) {
      for (const char* word : {"act", "acts", "activation", "lat", "lats", "repol", "apd"})
        if (of == word) return "ms";
      if (of == "vm" || of == "phie") unit = "mV";
    }
  }
  return unit;
}

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
    if (!request.surface_markers.empty() && format == Format::kEx)
      throw usage_error("--surface-markers " + request.surface_markers +
                        ": surfaces of EX models are those that their groups name");
    switch (format) {
      case Format::kEx:
        open_ex(named, request.refine > 0 ? request.refine : kRefine, info);
        break;
      case Format::kCarp:
        info.units = "coordinates in mm";
        open_carp(find_carp_files(named), info);
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
      if (std::find(names.begin(), names.end(), array.name) != names.end())
        chosen.arrays.push_back(at_step(array, step));
    for (std::size_t r = 0; r < series_.size(); ++r)
      if (std::find(names.begin(), names.end(), series_[r].info().name) != names.end())
        chosen.arrays.push_back(result_at(r, step));
    std::vector<DataSet> blocks;
    blocks.push_back(std::move(chosen));
    return blocks;
  }

 private:
  void open_carp(const CarpFiles& files, FileInfo& info) {
    mesh_ = read_carp(files, info.notes);
    const auto taken = [this](const std::string& name) {
      return std::any_of(mesh_.arrays.begin(), mesh_.arrays.end(),
                         [&](const DataArray& array) { return array.name == name; }) ||
             std::any_of(series_.begin(), series_.end(),
                         [&](const IgbFile& series) { return series.info().name == name; });
    };
    for (const std::string& file : files.results) {
      if (ending_of(file) == ".dat") {
        DataArray values = read_dat(file, mesh_.point_count(), mesh_.cell_count(), info.notes);
        if (const std::string name = result_name(values.name, files.pts); !taken(name)) values.name = name;
        state_unit(values.name, "", info);
        mesh_.arrays.push_back(std::move(values));
        continue;
      }
      IgbFile series(file, mesh_.point_count(), mesh_.cell_count());
      if (const std::string name = result_name(series.info().name, files.pts); !taken(name))
        series.set_name(name);
      info.notes.insert(info.notes.end(), series.notes().begin(), series.notes().end());
      state_unit(series.info().name, series.unit(), info);
      series_.push_back(std::move(series));
    }
    if (series_.empty()) return;
    const std::string unit = series_.front().time_unit();
    for (IgbFile& series : series_) {
      const std::string own = series.time_unit();
      if (own == unit) continue;
      info.notes.push_back(series.state_times_in(unit)
                               ? "times of " + series.file() + ", in " + own + ", turned into " + unit
                               : "WARNING: times of " + series.file() + " are in " +
                                     (own.empty() ? "no unit that it states" : own) + ", those of " +
                                     series_.front().file() + " in " + (unit.empty() ? "none" : unit) +
                                     ": taken as they stand");
    }
    shared_ = shared_times(series_);
    info.times = shared_.times;
    for (std::size_t r = 0; r < series_.size(); ++r) {
      const auto without = std::count(shared_.steps[r].begin(), shared_.steps[r].end(), SharedTimes::kNone);
      if (without > 0)
        info.notes.push_back(series_[r].info().name + " has no step at " +
                             counted(static_cast<std::uint64_t>(without), "time") +
                             " of the other results: no "
                             "data there");
    }
    info.units += ", times in " + (unit.empty() ? "ms" : unit);
    if (unit.empty())
      info.notes.emplace_back("times in ms, by openCARP's convention: the file states no unit");
  }

  /// @param stated by the file; empty: not.
  static void state_unit(const std::string& name, const std::string& stated, FileInfo& info) {
    const std::string unit = stated.empty() ? usual_unit(name) : stated;
    if (unit.empty()) return;
    info.units += ", " + name + " in " + unit;
    if (stated.empty())
      info.notes.push_back(name + " in " + unit + ", by openCARP's convention: the file states no unit");
  }

  /// An array of an EX model as it is at a step.
  [[nodiscard]] const DataArray& at_step(const DataArray& array, std::size_t step) const {
    if (step == 0 || step > later_.size()) return array;
    const std::vector<DataArray>& changed = later_[step - 1];
    const auto found = std::find_if(changed.begin(), changed.end(), [&](const DataArray& other) {
      return other.name == array.name && other.association == array.association;
    });
    return found == changed.end() ? array : *found;
  }

  /// NaN at a time where it has no step.
  [[nodiscard]] DataArray result_at(std::size_t result, std::size_t step) const {
    const IgbFile& series = series_[result];
    const std::size_t own = shared_.steps[result].at(step);
    if (own != SharedTimes::kNone) return series.read(own);
    const ArrayInfo& info = series.info();
    const std::vector<double> none(info.tuples * as_size(info.components),
                                   std::numeric_limits<double>::quiet_NaN());
    return make_array(info.name, info.association, info.components, std::span<const double>(none));
  }

  void open_ex(const std::vector<std::string>& named, int refine, FileInfo& info) {
    const std::vector<std::string> files = ex_files(named);
    const ex::TimedModel timed = ex::read_ex_files(files);
    const ex::Model& model = timed.model;
    ex::SampledModel sampled = ex::sample(model, refine, files.back(), usable_memory());
    if (!timed.later.empty())
      later_ = ex::sample_later(timed, sampled.mesh, refine, usable_memory(), sampled.notes);
    info.times = timed.times;
    info.notes = std::move(sampled.notes);
    info.exact_volume = ex::exact_volume(model, kQuadrature, files.back());
    info.notes.push_back("volume of the curved model " + short_number(info.exact_volume));
    info.long_axis = ex::long_axis(model);
    mesh_ = std::move(sampled.mesh);
  }

  DataSet mesh_;
  std::vector<std::vector<DataArray>> later_;  ///< of an EX model: what differs at times after the first
  std::vector<IgbFile> series_;                ///< of which a step is read when it is asked for
  SharedTimes shared_;                         ///< of them
};

}  // namespace

std::unique_ptr<Loader> make_cardiac_loader() { return std::make_unique<CardiacLoader>(); }

}  // namespace palpate
