#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "apps/cardiac/cardiac_verbs.h"
#include "common/base/clock.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/cli/json/json_output.h"
#include "common/cli/summaries.h"
#include "common/cli/verbs.h"
#include "common/field/grid/cell_split.h"
#include "common/field/heart/heart.h"
#include "common/field/heart/tissue.h"
#include "common/load/stated_unit.h"
#include "common/load/write/write_carp.h"
#include "common/load/write/write_mesh.h"
#include "common/load/write/write_tetgen.h"
#include "common/math/symmetric3.h"
#include "common/scene/time_steps.h"

namespace palpate {
namespace {

constexpr double kMicrometres = 1000.0;  // of a millimetre

/// Cells as they are written, and the way back to the input's arrays.
class WrittenCells {
 public:
  /// @param own the input's cells are written where openCARP has all their kinds, tetrahedra otherwise.
  WrittenCells(const DataSet& mesh, const std::string& file, bool own) {
    const auto* const cells = std::get_if<UnstructuredTopology>(&mesh.topology);
    if (own && cells != nullptr && mesh.visible.empty() && mesh.hidden_cells.empty() && all_in_carp(*cells)) {
      topology_ = *cells;
      return;
    }
    split_ = split_into_tetrahedra(std::span(&mesh, 1), file);
    input_of_.resize(split_->points.size());
    for (std::size_t i = 0; i < split_->point_of_input.size(); ++i)
      if (split_->point_of_input[i] < input_of_.size()) input_of_[split_->point_of_input[i]] = i;
    topology_ = cells_of(split_->points, split_->tets);
    const auto tetrahedra = cells == nullptr ? 0 : std::count(cells->types.begin(), cells->types.end(), 10);
    others_ = mesh.cell_count() - as_size(tetrahedra);
  }

  [[nodiscard]] const UnstructuredTopology& topology() const { return topology_; }
  /// @pre not `own`.
  [[nodiscard]] const SplitMesh& split() const { return *split_; }
  /// What has become of cells that are no tetrahedra; empty: nothing.
  [[nodiscard]] std::string note() const {
    if (others_ == 0) return {};
    return counted(others_, "cell") + " that " + (others_ == 1 ? "is" : "are") +
           " no tetrahedra are written as tetrahedra, " + counted(topology_.types.size(), "element") +
           " in all: results of elements do not fit the input's";
  }
  /// The places among the input's tuples that an array of points or of cells is taken from.
  [[nodiscard]] std::size_t source(Association association, std::size_t at) const {
    if (!split_) return at;
    return association == Association::kPoint ? input_of_[at] : split_->source_cell[at];
  }
  [[nodiscard]] std::size_t count(Association association) const {
    return association == Association::kPoint ? topology_.positions.tuples : topology_.types.size();
  }
  [[nodiscard]] std::vector<double> values(const DataArray& array) const {
    std::vector<double> values(count(array.association) * as_size(array.components));
    for (std::size_t i = 0; i < values.size(); ++i)
      values[i] = array.at(source(array.association, i / as_size(array.components)),
                           static_cast<int>(i % as_size(array.components)));
    return values;
  }
  /// Of each cell: directions of points by the mean of their outer products, which knows no signs.
  [[nodiscard]] std::vector<Vec3> directions(const DataArray& array) const {
    const auto at = [&](std::size_t i) {
      const std::size_t s = source(array.association, i);
      return Vec3{array.at(s, 0), array.at(s, 1), array.at(s, 2)};
    };
    std::vector<Vec3> found;
    found.reserve(topology_.types.size());
    for (std::size_t c = 0; c < topology_.types.size(); ++c) {
      if (array.association == Association::kCell) {
        found.push_back(at(c));
        continue;
      }
      Mat3 sum{0.0};
      for (std::int64_t i = topology_.offsets[c]; i < topology_.offsets[c + 1]; ++i) {
        const Vec3 d = at(as_size(topology_.connectivity[as_size(i)]));
        const double length = glm::length(d);
        if (length > 0.0 && std::isfinite(length)) sum += glm::outerProduct(d / length, d / length);
      }
      found.push_back(sum == Mat3{0.0} ? Vec3{0.0} : symmetric_eigen(sum).vectors[0]);
    }
    return found;
  }

 private:
  UnstructuredTopology topology_;
  std::optional<SplitMesh> split_;
  std::vector<std::size_t> input_of_;  ///< of its points
  std::size_t others_ = 0;
};

/// The input's steps in the order of time, and what of it is written.
struct Task {
  Input& input;
  std::vector<std::size_t> steps;
  std::vector<double> times;
  std::optional<HeartChoice> heart;
  std::string regions;             ///< the array that numbers them, of cells; empty: there is none
  std::vector<ArrayInfo> results;  ///< all arrays but fibres, sheets and regions

  [[nodiscard]] DataSet read(std::size_t step, const std::vector<std::string>& names) const {
    if (!times.empty()) input.set_time_step(steps[step]);
    std::vector<DataSet> blocks = input.read(names);
    if (blocks.size() != 1)
      throw input_error({input.title(), "", "has " + counted(blocks.size(), "block"), "one mesh"});
    return std::move(blocks.front());
  }
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> all;
    if (!regions.empty()) all.push_back(regions);
    if (heart) all.push_back(heart->fibre.array);
    if (heart && !heart->sheet.array.empty()) all.push_back(heart->sheet.array);
    for (const ArrayInfo& result : results) all.push_back(result.name);
    return all;
  }
};

bool is_named(const ArrayInfo& array, const DirectionChoice& choice) {
  return array.name == choice.array && array.association == choice.association;
}

Task task_of(Input& input) {
  Task task{.input = input,
            .steps = steps_in_order(input.times()),
            .times = {},
            .heart = {},
            .regions = region_array(input.arrays()),
            .results = {}};
  if (!input.spec().time.empty()) task.steps = {input.time().step};
  if (!input.times().empty())
    for (const std::size_t step : task.steps) task.times.push_back(input.times()[step]);
  if (!fibre_choices(input.arrays()).empty()) task.heart = input.heart_choice();
  for (const ArrayInfo& array : input.arrays()) {
    const bool direction =
        task.heart && (is_named(array, task.heart->fibre) || is_named(array, task.heart->sheet));
    const bool region = array.name == task.regions && array.association == Association::kCell;
    if (!region && !direction) task.results.push_back(array);
  }
  return task;
}

const DataArray& array_of(const DataSet& data, const std::string& name, Association association) {
  const DataArray* array = data.find(name, association);
  if (array == nullptr) throw work_error("the array " + name + " is not there at every time");
  return *array;
}

/// Which results differ between time steps. Every step is read.
std::vector<bool> changing(const Task& task, const WrittenCells& cells, const DataSet& first,
                           Progress& progress) {
  std::vector<bool> changes(task.results.size());
  for (std::size_t step = 1; step < task.times.size(); ++step) {
    progress.check();
    const DataSet data = task.read(step, task.names());
    for (std::size_t r = 0; r < task.results.size(); ++r) {
      if (changes[r]) continue;
      const ArrayInfo& result = task.results[r];
      const DataArray& a = array_of(first, result.name, result.association);
      const DataArray& b = array_of(data, result.name, result.association);
      const std::size_t components = as_size(result.components);
      for (std::size_t i = 0; i < components * cells.count(result.association) && !changes[r]; ++i) {
        const std::size_t from = cells.source(result.association, i / components);
        const int component = static_cast<int>(i % components);
        const double was = a.at(from, component), is = b.at(from, component);
        changes[r] = !(was == is || (std::isnan(was) && std::isnan(is)));
      }
    }
  }
  return changes;
}

/// Of each written element; both empty: the input has none.
struct ElementDirections {
  std::vector<Vec3> fibres, sheets;
  std::vector<std::string> notes;  ///< elements without any, and sheets that were turned

  /// @param ending of the file that they are written to.
  ElementDirections(const Task& task, const DataSet& first, const WrittenCells& cells,
                    const std::string& ending) {
    if (!task.heart) return;
    fibres = cells.directions(array_of(first, task.heart->fibre.array, task.heart->fibre.association));
    if (!task.heart->sheet.array.empty()) {
      sheets = cells.directions(array_of(first, task.heart->sheet.array, task.heart->sheet.association));
      // Means over an element's points are skew where these turn.
      if (task.heart->sheet.association == Association::kPoint) stand_on_fibres();
    }
    const auto without = as_size(std::count_if(fibres.begin(), fibres.end(), [](const Vec3& fibre) {
      return !(glm::length(fibre) > 0.0) || !is_finite(fibre);
    }));
    if (without > 0) notes.push_back(counted(without, "element") + " without a fibre: zeros in " + ending);
  }

 private:
  void stand_on_fibres() {
    constexpr double kSaid = 0.0871557427;  // sine of 5 degrees
    constexpr double kParallel = 1e-6;
    std::size_t turned = 0;
    double most = 0.0;
    for (std::size_t c = 0; c < sheets.size(); ++c) {
      const double fibre = glm::length(fibres[c]), sheet = glm::length(sheets[c]);
      if (!(fibre > 0.0 && sheet > 0.0)) continue;
      const double sine = std::abs(glm::dot(fibres[c], sheets[c])) / (fibre * sheet);
      const Vec3 across = sheets[c] - glm::dot(sheets[c], fibres[c]) / (fibre * fibre) * fibres[c];
      sheets[c] = glm::length(across) > kParallel * sheet ? glm::normalize(across) : Vec3{0.0};
      turned += sine > kSaid ? 1 : 0;
      most = std::max(most, sine);
    }
    if (turned > 0)
      notes.push_back("sheets of " + counted(turned, "element") + " turned by up to " +
                      short_number(std::round(std::asin(std::min(most, 1.0)) * 180.0 / std::numbers::pi)) +
                      " degrees to stand on the fibre: means over the element's points");
  }
};

/// The regions of written elements, and what became of them.
CarpRegions regions_of(const Task& task, const DataSet& first, const WrittenCells& cells) {
  const DataArray* const region = first.find(task.regions, Association::kCell);
  return region == nullptr ? CarpRegions{} : carp_regions(cells.values(*region), task.regions);
}

std::vector<std::filesystem::path> write_carp(const Task& given, const Document& options,
                                              const VerbContext& context) {
  Task task = given;
  IgbTimes times = igb_times(task.times, task.input.title());
  const std::string& units = task.input.file()->units;
  times.unit = stated_unit(units, "times");
  keep_carp_inputs(options.input.files);
  CarpOutput out(options.output.file, options.common.force, task.heart.has_value());
  if (!task.heart)
    context.console.note(
        "there are no fibres, and no .lon is written: openCARP takes one; 'cardiac fibers --rule bayer' "
        "makes fibres");
  if (task.heart && !means_fibre(task.heart->fibre.array)) {
    const std::string& array = task.heart->fibre.array;
    context.console.note("directions of .lon are those of the array " + array +
                         ": --field names another one");
    for (const ArrayInfo& each : task.input.arrays())
      if (is_named(each, task.heart->fibre)) task.results.push_back(each);
  }
  // The normals of fibres and sheets come back with them; .igb has tuples of one to four numbers.
  constexpr int kMostComponents = 4;
  std::erase_if(task.results, [&](const ArrayInfo& array) {
    const bool normal = array.name == "normal" && task.heart && !task.heart->sheet.array.empty();
    const bool wide = array.components > kMostComponents;
    if (wide)
      context.console.note(array.name + " has " + std::to_string(array.components) +
                           " numbers a place, which .igb does not hold: left out; .pvd holds them");
    return normal || wide;
  });
  const DataSet first = task.read(0, task.names());
  const WrittenCells cells(first, task.input.title(), true);
  if (!cells.note().empty()) context.console.note(cells.note());
  const CarpRegions regions = regions_of(task, first, cells);
  if (!regions.note.empty()) context.console.note(regions.note);
  out.write_mesh(cells.topology(), kMicrometres, regions.numbers);
  const ElementDirections directions(task, first, cells, ".lon");
  if (task.heart) out.write_directions(directions.fibres, directions.sheets);
  for (const std::string& note : directions.notes) context.console.note(note);
  const std::vector<bool> changes = changing(task, cells, first, context.progress);
  std::vector<std::pair<std::size_t, std::size_t>> series;  // of a result, of the output
  for (std::size_t r = 0; r < task.results.size(); ++r) {
    const ArrayInfo& result = task.results[r];
    const DataArray& values = array_of(first, result.name, result.association);
    const std::size_t count = cells.count(result.association);
    if (changes[r]) {
      series.emplace_back(
          r, out.begin_series(result.name, count, result.components, times, stated_unit(units, result.name)));
    } else if (result.components == 1) {
      out.write_values(result.name, cells.values(values));
    } else {
      const IgbTimes once{.first = times.first, .apart = 1.0, .count = 1, .unit = times.unit};
      out.write_step(
          out.begin_series(result.name, count, result.components, once, stated_unit(units, result.name)),
          cells.values(values));
    }
  }
  for (std::size_t step = 0; step < task.times.size() && !series.empty(); ++step) {
    context.progress.check();
    const DataSet data = task.read(step, task.names());
    for (const auto& [result, file] : series)
      out.write_step(
          file, cells.values(array_of(data, task.results[result].name, task.results[result].association)));
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
    const WrittenCells cells(data, task.input.title(), false);
    if (step == 0 && !cells.note().empty()) context.console.note(cells.note());
    std::vector<MeshColumn> columns;
    for (const DataArray& array : data.arrays)
      columns.push_back({.name = array.name,
                         .values = cells.values(array),
                         .components = as_size(array.components),
                         .of_cells = array.association == Association::kCell});
    files.push_back(step_file(options.output.file, step));
    write_mesh(files.back(), cells.split().points, cells.split().tets, columns, options.common.force,
               task.input.file()->long_axis);
    collection.write("<DataSet timestep=\"" + exact_number(task.times.empty() ? 0.0 : task.times[step]) +
                     "\" file=\"" + files.back().filename().string() + "\"/>\n");
  }
  collection.write("</Collection>\n</VTKFile>\n");
  collection.finish();
  return files;
}

std::vector<std::filesystem::path> write_chaste(const Task& task, const Document& options,
                                                const VerbContext& context) {
  const DataSet first = task.read(0, task.names());
  const WrittenCells cells(first, task.input.title(), false);
  if (!cells.note().empty()) context.console.note(cells.note());
  std::string left_out;
  for (const ArrayInfo& result : task.results)
    if (result.name != "normal" || !task.heart) left_out += (left_out.empty() ? "" : ", ") + result.name;
  if (!left_out.empty())
    context.console.note("left out, as .node and .ele hold no results: " + left_out +
                         "; .pts and .pvd hold them");
  if (task.times.size() > 1)
    context.console.note("of " + counted(task.times.size(), "time step") +
                         " the fibres of the first are written");
  const CarpRegions regions = regions_of(task, first, cells);
  if (!regions.note.empty()) context.console.note(regions.note);
  const ElementDirections directions(task, first, cells, ".ortho or .axi");
  for (const std::string& note : directions.notes) context.console.note(note);
  return write_tetgen(options.output.file, cells.split().points, cells.split().tets,
                      {.regions = regions.numbers, .fibres = directions.fibres, .sheets = directions.sheets},
                      options.common.force);
}

struct Writer {
  std::string_view ending;
  std::vector<std::filesystem::path> (*write)(const Task& task, const Document& options,
                                              const VerbContext& context);
  bool with_times;  ///< all that are asked for
};
constexpr std::array<Writer, 3> kWriters{
    {{".pts", write_carp, true}, {".pvd", write_pvd, true}, {".ele", write_chaste, false}}};

ExitCode run_convert(const Document& options, const VerbContext& context) {
  if (list_examples(options, context)) return ExitCode::kDone;
  const std::string ending = options.output.file.extension().string();
  const auto* const writer = std::ranges::find(kWriters, ending, &Writer::ending);
  if (writer == kWriters.end())
    throw usage_error(
        options.output.file.empty()
            ? "convert needs an output: try --out heart.pts or --out heart.pvd"
            : options.output.file.string() +
                  ": a heart is written as .pts (openCARP), .ele (Chaste, TetGen) or .pvd (VTK); EX files are "
                  "read, and not written");
  Input input = open_input(options, context);
  if (!input.not_volume().empty())
    throw input_error({input.title(), "", input.not_volume(), "a mesh of the wall"});
  const Stopwatch watch;
  const Task task = task_of(input);
  context.progress.begin("writing " + options.output.file.string(), 0);
  ConvertSummary summary{.input = input.title(), .times = writer->with_times ? task.times.size() : 0};
  for (const auto& file : writer->write(task, options, context)) {
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
  return {
      .name = "convert",
      .summary = "write mesh, fibres and results for openCARP, Chaste or as a time series of VTK",
      .details =
          "NAME.pts keeps the elements of the file; results become NAME.RESULT.igb and NAME.RESULT.dat. "
          "NAME.pvd has tetrahedra, and so has NAME.ele, beside which NAME.node and, for Chaste, NAME.ortho or "
          "NAME.axi lie, without results. All times are written, or the one of --time. EX files are read, and not "
          "written.",
      .groups = {Group::kInput, Group::kOut},
      .examples = std::move(examples),
      .run = run_convert};
}

}  // namespace palpate
