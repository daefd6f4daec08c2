#include "loaders/mesh/gmsh_values.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

class GmshSteps {
 public:
  GmshSteps(GmshMesh mesh, std::vector<GmshValues> values, std::string file)
      : mesh_(std::move(mesh)), values_(std::move(values)), file_(std::move(file)) {}

  void add_to(MeshFile& out) {
    std::size_t coefficients = 0;
    for (const GmshValues& values : values_) coefficients += values.coefficients ? 1 : 0;
    if (coefficients > 0) {
      out.notes.push_back(
          counted(coefficients, "section") +
          " of coefficients of an interpolation scheme left out: only values at nodes are read");
    }
    std::erase_if(values_, [](const GmshValues& values) { return values.coefficients; });
    for (GmshValues& values : values_) {
      const bool twice =
          values.on == On::kElementNodes && std::ranges::any_of(values_, [&](const GmshValues& v) {
            return v.on == On::kNodes && v.name == values.name;
          });
      if (twice) values.name += " of elements";
    }
    own_points_ = std::ranges::any_of(values_, [](const GmshValues& v) { return v.on == On::kElementNodes; });
    DataSet block;
    UnstructuredTopology mesh = mesh_.cells;
    if (own_points_) std::iota(mesh.connectivity.begin(), mesh.connectivity.end(), 0);
    mesh.positions = mesh_array("positions", Association::kPoint, 3,
                                own_points_ ? at_own_points(mesh_.positions, 3) : mesh_.positions);
    block.topology = std::move(mesh);
    add_steps(block, out);
    keep_common(out);
  }

 private:
  using On = GmshValues::On;
  using Name = std::pair<std::string, On>;          ///< and what it is of
  using Sections = std::vector<const GmshValues*>;  ///< one for each partition
  using Moment = std::pair<double, std::int64_t>;   ///< time and step
  static Name name_of(const GmshValues& values) { return {values.name, values.on}; }

  /// A view has a section for each step and partition. Steps are told apart by their times, or, where a view has
  /// several at one time, by their numbers, too.
  void add_steps(const DataSet& block, MeshFile& out) {
    std::map<Name, std::map<Moment, Sections>> views;
    for (const GmshValues& values : values_)
      views[name_of(values)][{values.time, values.step}].push_back(&values);
    bool numbered = false;
    for (const auto& [name, moments] : views) {
      for (auto at = moments.begin(); at != moments.end(); ++at)
        numbered = numbered || (at != moments.begin() && std::prev(at)->first.first == at->first.first);
    }
    // What stands once holds at all times.
    std::map<Moment, std::map<Name, Sections>> steps;
    for (const auto& [name, moments] : views) {
      if (moments.size() == 1) continue;
      for (const auto& [moment, sections] : moments)
        steps[{moment.first, numbered ? moment.second : 0}][name] = sections;
    }
    for (const auto& [name, moments] : views) {
      if (moments.size() > 1) continue;
      const auto& [moment, sections] = *moments.begin();
      if (steps.empty()) continue;
      add_note("'" + name.first + "' is given at time " + short_number(moment.first) +
                   " alone: it is held constant",
               out.notes);
      for (auto& [when, arrays] : steps) arrays[name] = sections;
    }
    if (steps.empty()) {
      auto& all = steps[{0.0, 0}];
      for (const auto& [name, moments] : views) all[name] = moments.begin()->second;
    }
    for (const auto& [moment, arrays] : steps) {
      DataSet step = block;
      for (const auto& [name, sections] : arrays) add_array(sections, step, out.notes);
      out.times.push_back(moment.first);
      out.steps.push_back({std::move(step)});
    }
    if (numbered) {
      bool rising = true;
      std::vector<double> numbers;
      for (const auto& [moment, arrays] : steps) {
        rising = rising && (numbers.empty() || numbers.back() < static_cast<double>(moment.second));
        numbers.push_back(static_cast<double>(moment.second));
      }
      for (std::size_t i = 0; !rising && i < numbers.size(); ++i) numbers[i] = static_cast<double>(i);
      out.times = std::move(numbers);
      add_note(std::string("several steps have one time: ") +
                   (rising ? "the numbers of the steps" : "the numbers 0, 1, 2, ...") +
                   " are taken for times",
               out.notes);
    }
  }

  static void add_note(const std::string& text, std::vector<std::string>& notes) {
    if (std::ranges::find(notes, text) == notes.end()) notes.push_back(text);
  }

  /// @param sections of one view, which its partitions may have in part each.
  void add_array(const Sections& sections, DataSet& block, std::vector<std::string>& notes) {
    const GmshValues& first = *sections.front();
    const auto n = as_size(first.components);
    // Values of nodes stand at these, whoever has points.
    const std::size_t tuples = first.on == On::kNodes      ? mesh_.positions.size() / 3
                               : first.on == On::kElements ? cell_count()
                                                           : mesh_.cells.connectivity.size();
    std::vector<double> all(n * tuples, std::numeric_limits<double>::quiet_NaN());
    std::vector<std::uint8_t> known(tuples, 0);
    std::size_t unknown = 0, given = 0, other = 0, odd = 0;
    const auto& index = first.on == On::kNodes ? mesh_.point_of : mesh_.cell_of;
    for (const GmshValues* const section : sections) {
      if (section->components != first.components) {
        throw input_error({file_, "'" + first.name + "'",
                           "has " + std::to_string(first.components) + " and " +
                               std::to_string(section->components) + " components at one time",
                           "as many in each section", ""});
      }
      for (const GmshValues::Tuple& tuple : section->tuples) {
        const auto found = index.find(tuple.tag);
        if (found == index.end()) {
          ++unknown;
          continue;
        }
        const auto put = [&](std::size_t at, std::size_t node) {
          const auto from = section->numbers.begin() + static_cast<std::ptrdiff_t>(tuple.begin + n * node);
          const auto to = all.begin() + static_cast<std::ptrdiff_t>(n * at);
          if (known[at] != 0 && !std::equal(to, to + static_cast<std::ptrdiff_t>(n), from)) ++other;
          if (known[at] == 0) ++given;
          known[at] = 1;
          std::copy_n(from, n, to);
        };
        if (first.on != On::kElementNodes) {
          put(found->second, 0);
          continue;
        }
        const auto begin = as_size(mesh_.cells.offsets[found->second]);
        if (as_size(mesh_.cells.offsets[found->second + 1]) - begin != tuple.nodes) {
          ++odd;
          continue;
        }
        const std::int8_t* const order = mesh_.order_of[found->second];
        for (std::size_t i = 0; i < tuple.nodes; ++i)
          put(begin + i, order == nullptr ? i : as_size(order[i]));
      }
    }
    const auto note = [&](const std::string& text) { add_note("'" + first.name + "': " + text, notes); };
    if (first.on == On::kNodes && unknown > 0)
      note(counted(unknown, "value") + " of nodes that there are not");
    if (other > 0) note(counted(other, "value") + " given again, and otherwise: the last are taken");
    if (odd > 0) note(counted(odd, "element") + " with other counts of values than of nodes: no data there");
    if (given < tuples) {
      const char* const what = first.on == On::kNodes      ? "node"
                               : first.on == On::kElements ? "cell"
                                                           : "node of a cell";
      note(counted(tuples - given, what) + " without a value: no data there");
    }
    if (given == 0 && first.on != On::kNodes) return;  // of surfaces alone
    if (first.on == On::kNodes && own_points_) all = at_own_points(all, n);
    block.arrays.push_back(mesh_array(first.name,
                                      first.on == On::kElements ? Association::kCell : Association::kPoint,
                                      first.components, all));
  }

  /// Tuples of nodes, for the points that each cell has of its own.
  [[nodiscard]] std::vector<double> at_own_points(const std::vector<double>& of_nodes, std::size_t n) const {
    std::vector<double> out;
    out.reserve(n * mesh_.cells.connectivity.size());
    for (const std::int64_t node : mesh_.cells.connectivity) {
      const auto from = of_nodes.begin() + static_cast<std::ptrdiff_t>(n * as_size(node));
      out.insert(out.end(), from, from + static_cast<std::ptrdiff_t>(n));
    }
    return out;
  }

  [[nodiscard]] std::size_t cell_count() const { return mesh_.cells.types.size(); }

  /// Arrays that all steps have: others would be missing at some time.
  static void keep_common(MeshFile& file) {
    std::vector<std::string> lost;
    for (const auto& step : file.steps) {
      for (const DataArray& array : step.front().arrays) {
        const bool everywhere = std::ranges::all_of(file.steps, [&](const auto& other) {
          return other.front().find(array.name, array.association) != nullptr;
        });
        if (!everywhere && std::ranges::find(lost, array.name) == lost.end()) lost.push_back(array.name);
      }
    }
    for (const std::string& name : lost) {
      file.notes.push_back("'" + name + "' left out: it is not there at all times");
      for (auto& step : file.steps)
        std::erase_if(step.front().arrays, [&](const DataArray& array) { return array.name == name; });
    }
  }

  GmshMesh mesh_;
  std::vector<GmshValues> values_;
  std::string file_;
  bool own_points_ = false;
};

}  // namespace

void add_gmsh_values(GmshMesh mesh, std::vector<GmshValues> values, const std::string& file, MeshFile& out) {
  GmshSteps(std::move(mesh), std::move(values), file).add_to(out);
}

}  // namespace palpate
