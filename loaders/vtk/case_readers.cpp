/// Cases of several files, EnSight and OpenFOAM, through VTK's readers: both offer their arrays by name and
/// their time steps one by one.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <limits>
#include <map>
#include <set>

#include <vtkGenericEnSightReader.h>
#include <vtkInformation.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkOpenFOAMReader.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>

#include "common/base/error.h"
#include "common/base/files/memory_text.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/helper/chosen_loader.h"
#include "common/load/step_times.h"
#include "loaders/vtk/ensight/ensight_check.h"
#include "loaders/vtk/ensight/ensight_rows.h"
#include "loaders/vtk/ensight/ensight_times.h"
#include "loaders/vtk/foam/foam_case.h"
#include "loaders/vtk/foam/foam_collated.h"
#include "loaders/vtk/solver_readers.h"
#include "loaders/vtk/vtk_convert.h"
#include "loaders/vtk/vtk_errors.h"

namespace palpate {
namespace {

/// EnSight: its parts are all taken.
class EnsightCase {
 public:
  using Reader = vtkGenericEnSightReader;
  static constexpr bool kChecksFields = false;

  void set_up(Reader& reader, const std::string& file, std::vector<std::string>& notes) {
    text_ = read_head(file, kCaseBytes).bytes;
    times_ = ensight_times(text_);
    const std::string& timed = times_.all.empty() ? text_ : times_.text;
    // From /proc/self/fd the names of its files lead back to the root.
    const std::string text = ensight_case_for_vtk(timed, file, "../../..", lost_, notes);
    reader.SetCaseFileName(memory_.write(text).c_str());
    reader.ReadAllVariablesOff();
  }
  /// @param offered the variables that can be read.
  void note_unused(std::set<std::string> offered, std::vector<std::string>& notes) const {
    offered.insert(lost_.begin(), lost_.end());
    for (std::string& unused : ensight_unused(text_, offered)) notes.push_back(std::move(unused));
  }

  static void choose_parts(Reader&) {}

  /// The time that VTK calls `time`.
  [[nodiscard]] double true_time(double time) const {
    const auto last = static_cast<double>(times_.all.size()) - 1.0;
    return time >= 0.0 && time <= last ? times_.all[as_size(std::lround(time))] : time;
  }

  /// The steps at which a field is given; empty: at all of them.
  [[nodiscard]] std::vector<std::size_t> steps_of(const std::string& name,
                                                  const std::vector<double>& times) const {
    return times.size() == times_.all.size() ? ensight_steps_of(text_, times_, name)
                                             : std::vector<std::size_t>{};
  }

  static std::vector<std::string> add_boundary(std::vector<DataSet>&, double) { return {}; }
  static bool add_values(DataSet&, const std::string&, double) { return false; }

  /// VTK's readers take what is there of a truncated file: its size has to account for the values. Those of
  /// the nodes stand once in EnSight 6, which gives every part all nodes.
  void check_values(const std::string& file, const std::vector<DataArray>& parts, std::size_t step,
                    std::size_t steps) const {
    std::size_t tuples = 0;
    for (const DataArray& part : parts) tuples += part.tuples;
    if (parts.front().association == Association::kPoint && is_ensight6(text_)) {
      tuples = 0;
      for (const DataArray& part : parts) tuples = std::max(tuples, part.tuples);
    }
    std::size_t missing = 0;
    for (const DataArray& part : parts)
      for (std::size_t t = 0; t < part.tuples; ++t)
        for (int c = 0; c < part.components; ++c) missing += std::isnan(part.at(t, c)) ? 1 : 0;
    const std::size_t values = tuples * as_size(parts.front().components);
    EnsightCounts due{parts.front().association, as_size(parts.front().components), {}};
    for (const DataArray& part : parts) due.tuples.push_back(part.tuples);
    check_ensight_values(file, parts.front().name, due, values, std::min(missing, values), step, steps);
  }

 private:
  static constexpr std::size_t kCaseBytes = std::size_t{4} << 20U;
  std::string text_;
  std::set<std::string> lost_;  ///< variables whose files are not there
  EnsightTimes times_;          ///< VTK has their places in the list in place of them
  MemoryText memory_;
};

/// OpenFOAM: the mesh inside each region; boundary patches are switched off.
class OpenFoamCase {
 public:
  using Reader = vtkOpenFOAMReader;
  /// A field of one time may hold what VTK cannot read (#calc, #codeStream, #include of a file elsewhere).
  static constexpr bool kChecksFields = true;

  void set_up(Reader& reader, const std::string& file, std::vector<std::string>&) {
    // The reader wants a file in the case's folder; it need not be there.
    const bool is_folder = std::filesystem::is_directory(file);
    reader.SetFileName(is_folder ? (std::filesystem::path(file) / "case.foam").c_str() : file.c_str());
    folder_ = foam_folder(file);
    boundary_ = FoamBoundaryReader(folder_);
    // Cell values stay cell values and polyhedra polyhedra: how they become tetrahedra is the field's matter.
    reader.CreateCellToPointOff();
    reader.DecomposePolyhedraOff();
    reader.SkipZeroTimeOff();
  }

  static void note_unused(const std::set<std::string>&, std::vector<std::string>&) {}

  static void choose_parts(Reader& reader) {
    reader.DisableAllPatchArrays();
    for (int i = 0; i < reader.GetNumberOfPatchArrays(); ++i) {
      const std::string name = reader.GetPatchArrayName(i);
      constexpr std::string_view kInside = "internalMesh";
      if (name.size() >= kInside.size() && name.substr(name.size() - kInside.size()) == kInside)
        reader.SetPatchArrayStatus(name.c_str(), 1);
    }
    reader.DisableAllLagrangianArrays();
  }

  static double true_time(double time) { return time; }

  /// The steps at which a field's file is there, in a region at least; empty: at all of them.
  [[nodiscard]] std::vector<std::size_t> steps_of(const std::string& name,
                                                  const std::vector<double>& times) const {
    std::vector<std::size_t> steps;
    std::error_code error;
    const auto has = [&name](const std::filesystem::path& folder) {
      std::error_code none;
      return std::filesystem::exists(folder / name, none) ||
             std::filesystem::exists(folder / (name + ".gz"), none);
    };
    for (std::filesystem::directory_iterator it(folder_, error), end; !error && it != end;
         it.increment(error)) {
      const auto time = number(it->path().filename().string());
      if (!time || !it->is_directory(error)) continue;
      bool there = has(it->path());
      for (std::filesystem::directory_iterator region(it->path(), error), last;
           !there && !error && region != last; region.increment(error))
        there = region->is_directory(error) && has(region->path());
      error.clear();
      if (!there) continue;
      for (std::size_t t = 0; t < times.size(); ++t) {
        if (joined_times({times[t], *time})[0] == joined_times({times[t], *time})[1]) steps.push_back(t);
      }
    }
    std::sort(steps.begin(), steps.end());
    steps.erase(std::unique(steps.begin(), steps.end()), steps.end());
    return steps.size() == times.size() ? std::vector<std::size_t>{} : steps;
  }

  static void check_values(const std::string&, const std::vector<DataArray>&, std::size_t, std::size_t) {}
  std::vector<std::string> add_boundary(std::vector<DataSet>& blocks, double time) {
    return boundary_.add(blocks, time);
  }
  /// Those of a field that VTK's reader cannot read.
  [[nodiscard]] bool add_values(DataSet& block, const std::string& name, double time) const {
    return boundary_.add_values(block, name, time);
  }

 private:
  std::filesystem::path folder_;
  FoamBoundaryReader boundary_;
};

std::set<std::string> without(const std::set<std::string>& all, const std::set<std::string>& some) {
  std::set<std::string> out;
  std::ranges::set_difference(all, some, std::inserter(out, out.end()));
  return out;
}

template <class Case>
class CaseReader : public Loader {
 public:
  explicit CaseReader(Format format) : format_(format) {}

  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1) {
      throw input_error({request.files[1].string(), "", "is a second case",
                         "one " + std::string(row_of(format_).name) + " case"});
    }
    file_ = request.files.front().string();
    reader_ = vtkSmartPointer<typename Case::Reader>::New();
    FileInfo info;
    case_.set_up(*reader_, file_, info.notes);
    reader_->UpdateInformation();
    // Complaints about one field must not cost the others: that field's own reading repeats them.
    try {
      errors_.check(file_);
    } catch (const Error&) {
      if (!Case::kChecksFields || arrays().empty()) throw;
    }
    case_.choose_parts(*reader_);
    case_.note_unused(arrays(), info.notes);

    vtkInformation* about = reader_->GetOutputInformation(0);
    auto* const steps = vtkStreamingDemandDrivenPipeline::TIME_STEPS();
    if (about->Has(steps) != 0) {
      times_.assign(about->Get(steps), about->Get(steps) + about->Length(steps));
    }
    // VTK knows the arrays' shapes only once they are read: the last step has them all (at the first one an
    // OpenFOAM case often has no mesh values yet), and only that one is read here.
    if (Case::kChecksFields) leave_out_broken(info.notes);
    std::vector<double> times;
    for (const double time : times_) times.push_back(case_.true_time(time));
    if (times.size() > 1) info.times = times;
    select(nullptr);
    update(times_.empty() ? 0 : times_.size() - 1);
    for (const VtkBlock& block : usable(&info.notes)) {
      info.blocks.push_back(describe_block(block.data, block.name));
      for (const std::string& name : own_) {
        DataSet with = convert_block(block.data, block.name, {}, file_);
        if (!case_.add_values(with, name, times_.back())) continue;
        const DataArray& array = with.arrays.back();
        info.blocks.back().arrays.push_back(
            {name, array.association, array.components, array.type, array.tuples});
      }
    }
    note_boundary(info);
    find_steps(times, info);
    blocks_ = info.blocks;
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    const std::set<std::string> wanted(names.begin(), names.end());
    const std::set<std::string> own = read_here(wanted, step), of_vtk = without(wanted, own);
    select(&of_vtk);
    update(step);
    std::vector<DataSet> blocks;
    for (const VtkBlock& block : usable(nullptr)) {
      blocks.push_back(convert_block(block.data, block.name, of_vtk, file_));
      // Behind a field that it could not read, VTK's reader leaves those of other times out without a word.
      if (!Case::kChecksFields || times_.empty()) continue;
      for (const std::string& name : wanted) {
        if (blocks.back().find(name, Association::kCell) == nullptr &&
            blocks.back().find(name, Association::kPoint) == nullptr)
          (void)case_.add_values(blocks.back(), name, times_[step]);
      }
    }
    // VTK goes on with the values of the time before.
    for (DataSet& block : blocks)
      std::erase_if(block.arrays, [&](const DataArray& array) { return !is_given(array.name, step); });
    std::map<std::pair<std::string, Association>, std::vector<DataArray>> parts;
    for (const DataSet& block : blocks) {
      for (const DataArray& array : block.arrays) parts[{array.name, array.association}].push_back(array);
    }
    for (const auto& [key, found] : parts)
      case_.check_values(file_, found, step, std::max<std::size_t>(1, times_.size()));
    if (!times_.empty()) (void)case_.add_boundary(blocks, times_[step]);
    for (DataSet& block : blocks) add_not_given(block, wanted, step);
    return blocks;
  }

 private:
  [[nodiscard]] std::set<std::string> arrays() const {
    std::set<std::string> names;
    for (int i = 0; i < reader_->GetNumberOfPointArrays(); ++i) names.insert(reader_->GetPointArrayName(i));
    for (int i = 0; i < reader_->GetNumberOfCellArrays(); ++i) names.insert(reader_->GetCellArrayName(i));
    return names;
  }

  /// Null: every array that can be read.
  void select(const std::set<std::string>* wanted) {
    const auto status = [this, wanted](const std::string& name) {
      return broken_.count(name) == 0 && (wanted == nullptr || wanted->count(name) > 0) ? 1 : 0;
    };
    for (int i = 0; i < reader_->GetNumberOfPointArrays(); ++i) {
      reader_->SetPointArrayStatus(reader_->GetPointArrayName(i), status(reader_->GetPointArrayName(i)));
    }
    for (int i = 0; i < reader_->GetNumberOfCellArrays(); ++i) {
      reader_->SetCellArrayStatus(reader_->GetCellArrayName(i), status(reader_->GetCellArrayName(i)));
    }
  }

  [[nodiscard]] bool is_given(const std::string& name, std::size_t step) const {
    const auto known = given_.find(name);
    return known == given_.end() || std::binary_search(known->second.begin(), known->second.end(), step);
  }

  /// Finds the fields that are not given at all times, says so, and describes those that the last time lacks.
  void find_steps(const std::vector<double>& times, FileInfo& info) {
    for (const std::string& name : arrays()) {
      std::vector<std::size_t> steps = case_.steps_of(name, times);
      if (steps.empty() || (broken_.count(name) > 0 && own_.count(name) == 0)) continue;
      const std::set<std::string> one{name};
      if (steps.back() + 1 < times.size() && own_.count(name) == 0) {
        const std::string why = reads(&one, steps.back());
        if (!why.empty()) {
          info.notes.push_back("field '" + name + "' left out: " + why);
          continue;
        }
        for (const VtkBlock& block : usable(nullptr)) {
          const auto known =
              std::find_if(info.blocks.begin(), info.blocks.end(),
                           [&block](const BlockInfo& about) { return about.name == block.name; });
          if (known == info.blocks.end()) continue;
          for (const ArrayInfo& array : describe_block(block.data, block.name).arrays) {
            const bool there =
                std::any_of(known->arrays.begin(), known->arrays.end(), [&array](const ArrayInfo& a) {
                  return a.name == array.name && a.association == array.association;
                });
            if (array.name == name && !there) known->arrays.push_back(array);
          }
        }
      }
      info.notes.push_back("field '" + name + "' is given at " + std::to_string(steps.size()) + " of " +
                           std::to_string(times.size()) + " times, the first of them " +
                           short_number(times[steps.front()]) + " and the last " +
                           short_number(times[steps.back()]) + ": no data (NaN) at the others");
      given_[name] = std::move(steps);
    }
  }

  /// NaN for what is asked for and not given at this step.
  void add_not_given(DataSet& block, const std::set<std::string>& wanted, std::size_t step) const {
    const auto about = std::find_if(blocks_.begin(), blocks_.end(),
                                    [&block](const BlockInfo& known) { return known.name == block.name; });
    if (about == blocks_.end()) return;
    for (const ArrayInfo& array : about->arrays) {
      if (wanted.count(array.name) == 0 || is_given(array.name, step)) continue;
      const std::size_t tuples =
          array.association == Association::kPoint ? block.point_count() : block.cell_count();
      const std::vector<double> none(tuples * as_size(array.components),
                                     std::numeric_limits<double>::quiet_NaN());
      block.arrays.push_back(make_array(array.name, array.association, array.components, none));
    }
  }

  /// Fields that cannot be read at the last time, and times before the first at which all others can be read.
  void leave_out_broken(std::vector<std::string>& notes) {
    const std::size_t last = times_.empty() ? 0 : times_.size() - 1;
    if (!reads(nullptr, last).empty()) {
      const std::set<std::string> none;
      select(&none);
      update(last);  // refuses the case where the mesh cannot be read
      for (const std::string& name : arrays()) {
        const std::set<std::string> one{name};
        const std::string why = reads(&one, last);
        if (why.empty()) continue;
        broken_.insert(name);
        if (is_readable(name, last)) {
          own_.insert(name);
        } else {
          notes.push_back("field '" + name + "' left out: " + why);
        }
      }
    }
    while (times_.size() > 1) {
      const std::string why = reads(nullptr, 0);
      if (why.empty()) return;
      const std::set<std::string> all = arrays();
      if (std::ranges::all_of(all, [this](const std::string& name) { return can_be_read_first(name); }))
        return;
      notes.push_back("time " + short_number(times_.front()) + " left out: " + why);
      times_.erase(times_.begin());
    }
  }

  /// Whether a field that VTK's reader cannot read can be read without it.
  [[nodiscard]] bool is_readable(const std::string& name, std::size_t step) {
    const std::set<std::string> none;
    if (times_.empty() || !reads(&none, step).empty()) return false;
    const std::vector<VtkBlock> blocks = usable(nullptr);
    return std::ranges::any_of(blocks, [&](const VtkBlock& block) {
      DataSet with = convert_block(block.data, block.name, {}, file_);
      return case_.add_values(with, name, times_[step]);
    });
  }

  /// Whether a field is not given at the first step, is left out, or can be read there. Once it has complained, VTK's
  /// reader leaves a field out without a word: what it returns is looked at.
  [[nodiscard]] bool can_be_read_first(const std::string& name) {
    const std::vector<std::size_t> steps = case_.steps_of(name, times_);
    if (broken_.count(name) > 0 || (!steps.empty() && steps.front() > 0) || is_readable(name, 0)) return true;
    const std::set<std::string> one{name};
    if (!reads(&one, 0).empty()) return false;
    const std::vector<VtkBlock> blocks = usable(nullptr);
    return std::ranges::any_of(blocks, [&](const VtkBlock& block) {
      const std::vector<ArrayInfo> there = describe_block(block.data, block.name).arrays;
      return std::ranges::any_of(there, [&](const ArrayInfo& array) { return array.name == name; });
    });
  }

  /// Those of `wanted` that are read without VTK's reader at this step.
  [[nodiscard]] std::set<std::string> read_here(const std::set<std::string>& wanted, std::size_t step) {
    std::set<std::string> out;
    std::ranges::set_intersection(wanted, own_, std::inserter(out, out.end()));
    const std::set<std::string> others = without(wanted, out);
    if (!Case::kChecksFields || reads(&others, step).empty()) return out;
    for (const std::string& name : others) {
      if (is_readable(name, step)) out.insert(name);
    }
    return out;
  }

  /// What of the boundary cannot be read, at the time that was read last, and the precision that values have.
  void note_boundary(FileInfo& info) {
    if (!Case::kChecksFields || times_.empty()) return;
    std::vector<DataSet> blocks;
    for (const VtkBlock& block : usable(nullptr))
      blocks.push_back(convert_block(block.data, block.name, arrays(), file_));
    constexpr std::size_t kMost = 5;
    const std::vector<std::string> problems = case_.add_boundary(blocks, times_.back());
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      for (ArrayInfo& about : info.blocks[b].arrays) {
        if (const DataArray* const array = blocks[b].find(about.name, about.association))
          about.type = array->type;
      }
    }
    std::vector<std::string>& notes = info.notes;
    notes.insert(notes.end(), problems.begin(),
                 problems.begin() + static_cast<std::ptrdiff_t>(std::min(kMost, problems.size())));
    if (problems.size() > kMost)
      notes.push_back(std::to_string(problems.size() - kMost) + " more of the boundary");
  }

  /// Reads; what VTK says against it, or empty.
  std::string reads(const std::set<std::string>* wanted, std::size_t step) {
    select(wanted);
    try {
      update(step);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  }

  void update(std::size_t step) {
    if (times_.empty()) {
      reader_->Update();
    } else {
      reader_->UpdateTimeStep(times_[step]);
    }
    errors_.check(file_);
  }

  std::vector<VtkBlock> usable(std::vector<std::string>* notes) {
    return usable_blocks(leaves_of(reader_->GetOutput()), "part", file_, notes);
  }

  Format format_;
  VtkErrors errors_;
  Case case_;
  vtkSmartPointer<typename Case::Reader> reader_;
  std::string file_;
  std::vector<double> times_;
  std::vector<BlockInfo> blocks_;
  std::map<std::string, std::vector<std::size_t>> given_;  ///< steps of the fields that not all times have
  std::set<std::string> broken_;                           ///< fields that VTK's reader cannot read
  std::set<std::string> own_;                              ///< those of them that can be read without it
};

/// An OpenFOAM case, whole or in the folders of processors.
class OpenFoamReader : public ChosenLoader {
 public:
  FileInfo open(const LoadRequest& request, Format format) override {
    FileInfo info = ChosenLoader::open(request, format);
    info.notes.insert(info.notes.begin(), notes_.begin(), notes_.end());
    return info;
  }

 protected:
  std::unique_ptr<Loader> choose(const LoadRequest& request, Format) override {
    const auto make_case = [] { return std::make_unique<CaseReader<OpenFoamCase>>(Format::kOpenFoam); };
    const std::string file = request.files.front().string();
    FoamProcessors processors = foam_processors(foam_folder(file), notes_);
    if (processors.folders.empty() || request.files.size() > 1) return make_case();
    if (!processors.collated) return make_decomposed_reader(std::move(processors.folders), make_case);
    collated_ = std::make_unique<FoamCollated>(processors.folders);
    notes_.push_back("collated processor folders are parted into temporary files");
    return make_decomposed_reader(collated_->folders(), make_case);
  }

 private:
  std::vector<std::string> notes_;  ///< on the folders of processors
  std::unique_ptr<FoamCollated> collated_;
};

}  // namespace

std::unique_ptr<Loader> make_ensight_reader() {
  return std::make_unique<CaseReader<EnsightCase>>(Format::kEnsight);
}
std::unique_ptr<Loader> make_openfoam_reader() { return std::make_unique<OpenFoamReader>(); }

}  // namespace palpate
