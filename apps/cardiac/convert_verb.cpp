#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/clock.h"
#include "common/base/output_file.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/grid/cell_split.h"
#include "common/field/heart/heart.h"
#include "common/load/write/write_carp.h"
#include "common/load/write/write_mesh.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

constexpr double kMicrometres = 1000.0;  // of a millimetre

/// Arrays of the input in tetrahedra.
class Tetrahedra {
 public:
  Tetrahedra(const DataSet& mesh, const std::string& file)
      : split_(split_into_tetrahedra(std::span(&mesh, 1), file)), input_of_(split_.points.size()) {
    for (std::size_t i = 0; i < split_.point_of_input.size(); ++i)
      if (split_.point_of_input[i] < input_of_.size()) input_of_[split_.point_of_input[i]] = i;
  }

  [[nodiscard]] const SplitMesh& mesh() const { return split_; }
  /// The places among the input's tuples that an array of points or of cells is taken from.
  [[nodiscard]] std::size_t source(Association association, std::size_t at) const {
    return association == Association::kPoint ? input_of_[at] : split_.source_cell[at];
  }
  [[nodiscard]] std::size_t count(Association association) const {
    return association == Association::kPoint ? split_.points.size() : split_.tets.size();
  }
  [[nodiscard]] std::vector<double> values(const DataArray& array) const {
    std::vector<double> values(count(array.association) * static_cast<std::size_t>(array.components));
    for (std::size_t i = 0; i < values.size(); ++i) {
      const auto c = static_cast<int>(i % static_cast<std::size_t>(array.components));
      values[i] = array.at(source(array.association, i / static_cast<std::size_t>(array.components)), c);
    }
    return values;
  }
  /// Of each tetrahedron: directions of points by the mean of their outer products, which knows no signs.
  [[nodiscard]] std::vector<Vec3> directions(const DataArray& array) const {
    const auto at = [&](std::size_t i) {
      const std::size_t s = source(array.association, i);
      return Vec3{array.at(s, 0), array.at(s, 1), array.at(s, 2)};
    };
    std::vector<Vec3> found;
    found.reserve(split_.tets.size());
    for (std::size_t t = 0; t < split_.tets.size(); ++t) {
      if (array.association == Association::kCell) {
        found.push_back(at(t));
        continue;
      }
      Mat3 sum{0.0};
      for (const std::uint32_t p : split_.tets[t]) {
        const Vec3 d = at(p);
        const double length = glm::length(d);
        if (length > 0.0 && std::isfinite(length)) sum += glm::outerProduct(d / length, d / length);
      }
      found.push_back(sum == Mat3{0.0} ? Vec3{0.0} : symmetric_eigen(sum).vectors[0]);
    }
    return found;
  }

 private:
  SplitMesh split_;
  std::vector<std::size_t> input_of_;
};

/// The input's steps in the order of time, and what of it is written.
struct Task {
  Input& input;
  std::vector<std::size_t> steps;
  std::vector<double> times;
  std::optional<HeartChoice> heart;
  std::vector<ArrayInfo> scalars;

  [[nodiscard]] DataSet read(std::size_t step, const std::vector<std::string>& names) const {
    if (!times.empty()) input.set_time_step(steps[step]);
    std::vector<DataSet> blocks = input.read(names);
    if (blocks.size() != 1)
      throw input_error({input.title(), "", "has " + counted(blocks.size(), "block"), "one mesh"});
    return std::move(blocks.front());
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    if (heart) all.push_back(heart->fibre.array);
    if (heart && !heart->sheet.array.empty()) all.push_back(heart->sheet.array);
    for (const ArrayInfo& scalar : scalars) all.push_back(scalar.name);
    return all;
  }
};

Task task_of(Input& input) {
  Task task{.input = input, .steps = steps_in_order(input.times()), .times = {}, .heart = {}, .scalars = {}};
  if (!input.times().empty())
    for (const std::size_t step : task.steps) task.times.push_back(input.times()[step]);
  if (!fibre_choices(input.arrays()).empty()) task.heart = input.heart_choice();
  for (const ArrayInfo& array : input.arrays())
    if (array.components == 1) task.scalars.push_back(array);
  return task;
}

const DataArray& array_of(const DataSet& data, const std::string& name, Association association) {
  const DataArray* array = data.find(name, association);
  if (array == nullptr) throw work_error("the array " + name + " is not there at every time");
  return *array;
}

/// Which scalars differ between time steps. Every step is read.
std::vector<bool> changing(const Task& task, const Tetrahedra& cells, const DataSet& first,
                           Progress& progress) {
  std::vector<bool> changes(task.scalars.size());
  for (std::size_t step = 1; step < task.times.size(); ++step) {
    progress.check();
    const DataSet data = task.read(step, task.names());
    for (std::size_t s = 0; s < task.scalars.size(); ++s) {
      if (changes[s]) continue;
      const ArrayInfo& scalar = task.scalars[s];
      const DataArray& a = array_of(first, scalar.name, scalar.association);
      const DataArray& b = array_of(data, scalar.name, scalar.association);
      for (std::size_t i = 0; i < cells.count(scalar.association) && !changes[s]; ++i) {
        const std::size_t from = cells.source(scalar.association, i);
        const double was = a.at(from), is = b.at(from);
        changes[s] = !(was == is || (std::isnan(was) && std::isnan(is)));
      }
    }
  }
  return changes;
}

std::vector<std::filesystem::path> write_carp(const Task& task, const Document& options,
                                              const VerbContext& context) {
  const IgbTimes times = igb_times(task.times, task.input.title());
  CarpOutput out(options.output.file, options.common.force);
  const DataSet first = task.read(0, task.names());
  const Tetrahedra cells(first, task.input.title());
  std::vector<int> regions;
  if (const DataArray* region = first.find("region", Association::kCell))
    for (const double value : cells.values(*region)) regions.push_back(static_cast<int>(value));
  out.write_mesh(cells.mesh().points, kMicrometres, cells.mesh().tets, regions);
  std::vector<Vec3> fibres(cells.mesh().tets.size(), Vec3{0.0}), sheets;
  if (task.heart) {
    fibres = cells.directions(array_of(first, task.heart->fibre.array, task.heart->fibre.association));
    if (!task.heart->sheet.array.empty())
      sheets = cells.directions(array_of(first, task.heart->sheet.array, task.heart->sheet.association));
  }
  out.write_directions(fibres, sheets);
  const std::vector<bool> changes = changing(task, cells, first, context.progress);
  std::vector<std::pair<std::size_t, std::size_t>> series;  // of a scalar, of the output
  for (std::size_t s = 0; s < task.scalars.size(); ++s) {
    const ArrayInfo& scalar = task.scalars[s];
    if (scalar.name == "region") continue;
    if (!changes[s]) {
      out.write_values(scalar.name, cells.values(array_of(first, scalar.name, scalar.association)));
    } else if (scalar.association == Association::kPoint) {
      series.emplace_back(s, out.begin_series(scalar.name, cells.mesh().points.size(), times));
    } else {
      context.console.note(scalar.name + " changes in cells, which .igb does not hold: left out");
    }
  }
  for (std::size_t step = 0; step < task.times.size() && !series.empty(); ++step) {
    context.progress.check();
    const DataSet data = task.read(step, task.names());
    for (const auto& [scalar, file] : series)
      out.write_step(file, cells.values(array_of(data, task.scalars[scalar].name, Association::kPoint)));
  }
  out.finish();
  return out.files();
}

/// The mesh at a time with its arrays, beside the collection that names it.
std::filesystem::path step_file(const std::filesystem::path& pvd, std::size_t step) {
  const std::string digits = std::to_string(step);
  constexpr std::size_t kDigits = 4;
  return pvd.parent_path() / (pvd.stem().string() + "_" +
                              std::string(kDigits - std::min(kDigits, digits.size()), '0') + digits + ".vtu");
}

std::vector<std::filesystem::path> write_pvd(const Task& task, const Document& options,
                                             const VerbContext& context) {
  const std::size_t steps = std::max<std::size_t>(1, task.times.size());
  for (std::size_t step = 0; step < steps; ++step)
    check_mesh_output(step_file(options.output.file, step), options.common.force);
  OutputFile collection(options.output.file, options.common.force);
  collection.write("<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\">\n<Collection>\n");
  std::vector<std::filesystem::path> files{options.output.file};
  for (std::size_t step = 0; step < steps; ++step) {
    context.progress.check();
    const DataSet data = task.read(step, task.names());
    const Tetrahedra cells(data, task.input.title());
    std::vector<MeshColumn> columns;
    for (const DataArray& array : data.arrays)
      columns.push_back({.name = array.name,
                         .values = cells.values(array),
                         .components = static_cast<std::size_t>(array.components),
                         .of_cells = array.association == Association::kCell});
    files.push_back(step_file(options.output.file, step));
    write_mesh(files.back(), cells.mesh().points, cells.mesh().tets, columns, options.common.force,
               task.input.file()->long_axis);
    collection.write("<DataSet timestep=\"" + exact_number(task.times.empty() ? 0.0 : task.times[step]) +
                     "\" file=\"" + files.back().filename().string() + "\"/>\n");
  }
  collection.write("</Collection>\n</VTKFile>\n");
  collection.finish();
  return files;
}

ExitCode run_convert(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const std::string ending = options.output.file.extension().string();
  if (ending != ".pts" && ending != ".pvd")
    throw usage_error(options.output.file.empty()
                          ? "convert needs an output: try --out heart.pts or --out heart.pvd"
                          : options.output.file.string() +
                                ": a heart is written as .pts (openCARP) or .pvd (VTK)");
  Input input = open_input(options, context);
  if (!input.not_volume().empty())
    throw input_error({input.title(), "", input.not_volume(), "a mesh of the wall"});
  const Stopwatch watch;
  const Task task = task_of(input);
  context.progress.begin("writing " + options.output.file.string(), 0);
  ConvertSummary summary{.input = input.title(), .times = task.times.size()};
  for (const auto& file :
       ending == ".pts" ? write_carp(task, options, context) : write_pvd(task, options, context)) {
    summary.files.push_back(file.string());
    context.interrupt.keep(file);
  }
  summary.seconds = watch.seconds();
  std::string text = summary.input + " -> " + counted(summary.files.size(), "file");
  if (summary.times > 0) text += ", " + counted(summary.times, "time step");
  text += " in " + short_number(summary.seconds) + " s\n";
  std::string open;
  for (const std::string& file : summary.files)
    if (ending == ".pts" && !file.ends_with(".elem") && !file.ends_with(".lon")) open += " " + file;
  context.console.print(text + "  open it    " + context.explorer.name +
                        (open.empty() ? " " + options.output.file.string() : open) + "\n");
  context.console.print_json(convert_json(summary));
  return ExitCode::kDone;
}

}  // namespace

Verb convert_verb(std::vector<UsageExample> examples) {
  return {.name = "convert",
          .summary = "write mesh, fibres and results for openCARP or as a time series of VTK",
          .groups = {Group::kInput, Group::kOut},
          .examples = std::move(examples),
          .run = run_convert};
}

}  // namespace palpate
