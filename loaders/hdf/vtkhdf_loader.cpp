/// VTKHDF of versions 1 and 2, read from HDF5: VTK 9.1 knows only some files of version 1.
#include <algorithm>
#include <memory>
#include <set>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/grid/curved_cell.h"
#include "common/load/helper/serve.h"
#include "common/load/step_times.h"
#include "loaders/hdf/hdf5_check.h"
#include "loaders/hdf/vtkhdf_blocks.h"
#include "loaders/vtk/refined_levels.h"
#include "loaders/vtk/vtk_convert.h"

namespace palpate {
namespace {

constexpr const char* kWayOut = "open it in ParaView and save it as .vtu or .vti, or a series as .pvd";

class VtkHdfLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "",
                         "is a second " + std::string(row_of(format).name) + " file", "one file"});
    }
    file_ = request.files.front().string();
    check_hdf5(file_);
    const auto root = Hdf5Group::open(file_, "VTKHDF");
    if (!root) throw input_error({file_, "", "has no group VTKHDF", "one with its version and type"});
    check_version(*root);
    FileInfo info;
    find_sets(*root, info.notes);
    find_times();
    if (times_.size() > 1) info.times = times_;

    const Kept kept = keep(
        0, [](const std::string&) { return true; }, &info.notes);
    for (const VtkBlock& block : kept.used) info.blocks.push_back(describe_block(block.data, block.name));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    const std::set<std::string> wanted(names.begin(), names.end());
    const Kept kept = keep(
        step,
        [&](const std::string& name) {
          // The last two are parts of the topology (vtk_convert.h).
          return wanted.count(name) > 0 || name == kRationalWeights || name == kHigherOrderDegrees;
        },
        nullptr);
    std::vector<DataSet> out;
    std::vector<int> levels;
    for (const VtkBlock& block : kept.used) {
      out.push_back(convert_block(block.data, block.name, wanted, file_));
      const auto of = std::find_if(kept.all.begin(), kept.all.end(),
                                   [&](const HdfBlock& each) { return each.data == block.data; });
      levels.push_back(of == kept.all.end() ? -1 : of->level);
    }
    hide_refined_cells(out, levels);
    return out;
  }

 private:
  /// The blocks of a time step, and those of them that are used.
  struct Kept {
    std::vector<HdfBlock> all;
    std::vector<VtkBlock> used;
  };
  [[nodiscard]] Kept keep(std::size_t step, const ArrayChoice& wanted,
                          std::vector<std::string>* notes) const {
    Kept out;
    for (const HdfDataSet& set : sets_) {
      const std::size_t of_set = set.times().empty() ? 0 : std::min(step, set.times().size() - 1);
      for (HdfBlock& block : set.blocks(of_set, wanted, notes)) out.all.push_back(std::move(block));
    }
    std::vector<VtkBlock> leaves;
    for (const HdfBlock& block : out.all) leaves.push_back({block.data, block.name});
    out.used = usable_blocks(leaves, "block", file_, notes);
    return out;
  }

  void check_version(const Hdf5Group& root) const {
    const std::vector<double> version = root.numbers("Version");
    constexpr double kRead = 2.0;
    if (version.empty() || version[0] <= kRead) return;
    throw input_error(
        {file_, "", "is VTKHDF of version " + short_number(version[0]), "version 1 or 2", kWayOut});
  }

  void find_sets(const Hdf5Group& root, std::vector<std::string>& notes) {
    const std::string type = root.word("Type");
    if (type == "PartitionedDataSetCollection" || type == "MultiBlockDataSet") {
      for (const std::string& name : root.names()) {
        const auto group = root.group(name);
        if (!group || name == "Assembly" || group->word("Type").empty()) continue;
        HdfDataSet set(file_, *group, name);
        if (set.is_read()) {
          sets_.push_back(std::move(set));
        } else {
          notes.push_back("block '" + name + "' left out: it is of the type " + set.type());
        }
      }
      if (sets_.empty()) throw input_error({file_, "", "holds no images or meshes", "", kWayOut});
      return;
    }
    HdfDataSet set(file_, root, "");
    if (!set.is_read()) {
      throw input_error({file_, "",
                         type.empty() ? "does not state its type" : "holds data of the type " + type,
                         "ImageData, UnstructuredGrid, OverlappingAMR, or a collection of them", kWayOut});
    }
    sets_.push_back(std::move(set));
  }

  /// Those of all blocks that have any; they must be the same.
  void find_times() {
    for (const HdfDataSet& set : sets_) {
      if (set.times().empty()) continue;
      if (!times_.empty() && times_ != set.times()) {
        throw input_error({file_, "block '" + set.name() + "'", "has other times than the blocks before it",
                           "the same times for all blocks"});
      }
      times_ = set.times();
    }
    check_rising(file_, times_);
  }

  std::string file_;
  std::vector<HdfDataSet> sets_;
  std::vector<double> times_;
};

}  // namespace

[[nodiscard]] std::unique_ptr<Loader> make_vtkhdf_loader() { return std::make_unique<VtkHdfLoader>(); }

}  // namespace palpate
