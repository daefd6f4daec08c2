#include "loaders/cardiac/ex/ex_times.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/cardiac/ex/ex_reader.h"
#include "loaders/cardiac/mesh_text.h"

namespace palpate::ex {
namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

/// The values of a component.
std::span<const double> values_of(const Node& node, const NodeComponent& component) {
  return std::span(node.values).subspan(as_size(component.first), as_size(component.count));
}

const NodeField* named(const std::vector<NodeField>& header, const std::string& name) {
  const auto found =
      std::find_if(header.begin(), header.end(), [&](const NodeField& field) { return field.name == name; });
  return found == header.end() ? nullptr : &*found;
}

/// Whether all nodes of `state` are in `model`, with the same fields, and some value differs.
bool is_another_time(const Model& state, const Model& model) {
  if (!state.elements.empty() || state.nodes.empty()) return false;
  bool differs = false;
  for (const auto& [name, node] : state.nodes) {
    const auto there = model.nodes.find(name);
    if (there == model.nodes.end()) return false;
    for (const NodeField& field : state.node_headers[node.header]) {
      const NodeField* known = named(model.node_headers[there->second.header], field.name);
      if (known == nullptr || known->components.size() != field.components.size()) return false;
      for (std::size_t c = 0; c < field.components.size(); ++c) {
        const auto now = values_of(node, field.components[c]);
        const auto before = values_of(there->second, known->components[c]);
        if (now.size() != before.size()) return false;
        differs = differs || !std::equal(now.begin(), now.end(), before.begin(), same);
      }
    }
  }
  return differs;
}

/// `model` with the values of `state` where that has some.
Model at_time(const Model& model, const Model& state) {
  Model made = model;
  for (const auto& [name, node] : state.nodes) {
    Node& there = made.nodes.at(name);
    for (const NodeField& field : state.node_headers[node.header]) {
      const NodeField* known = named(made.node_headers[there.header], field.name);
      for (std::size_t c = 0; c < field.components.size(); ++c) {
        const auto now = values_of(node, field.components[c]);
        std::copy(now.begin(), now.end(), there.values.begin() + known->components[c].first);
      }
    }
  }
  return made;
}

/// The number at the end of a file's name, before its endings.
std::optional<double> number_of(const std::string& file) {
  const std::string stem = std::filesystem::path(stem_of(file)).filename().string();
  std::size_t first = stem.size();
  while (first > 0 &&
         (std::isdigit(static_cast<unsigned char>(stem[first - 1])) != 0 || stem[first - 1] == '.'))
    --first;
  return number(std::string_view(stem).substr(first));
}

struct State {
  std::string file;
  Model model;
  std::optional<double> time;
};

}  // namespace

TimedModel read_ex_files(const std::vector<std::string>& files) {
  TimedModel timed;
  std::vector<State> states;
  std::string first;
  for (const std::string& file : files) {
    const bool nodes = ending_of(file) == ".exnode";
    if (nodes && !first.empty()) {
      Model state;
      read_ex_file(file, state);
      if (is_another_time(state, timed.model)) {
        states.push_back({.file = file, .model = std::move(state), .time = number_of(file)});
        continue;
      }
    }
    if (nodes && first.empty()) first = file;
    read_ex_file(file, timed.model);
  }
  if (states.empty()) return timed;
  states.insert(states.begin(), State{.file = first, .model = {}, .time = number_of(first)});
  std::set<double> numbers;
  for (const State& state : states)
    if (state.time) numbers.insert(*state.time);
  if (numbers.size() == states.size()) {
    std::stable_sort(states.begin(), states.end(),
                     [](const State& a, const State& b) { return *a.time < *b.time; });
  } else {
    for (std::size_t s = 0; s < states.size(); ++s) states[s].time = static_cast<double>(s);
  }
  const Model base = std::move(timed.model);
  for (std::size_t s = 0; s < states.size(); ++s) {
    timed.times.push_back(*states[s].time);
    timed.states.push_back(states[s].file);
    Model made = at_time(base, states[s].model);
    if (s == 0) {
      timed.model = std::move(made);
    } else {
      timed.later.push_back(std::move(made));
    }
  }
  return timed;
}

std::vector<std::vector<DataArray>> sample_later(const TimedModel& timed, const DataSet& first, int refine,
                                                 std::uint64_t memory, std::vector<std::string>& notes) {
  constexpr double kSamePlace = 1e-9;  // of the model's size
  const DataArray& places = std::get<UnstructuredTopology>(first.topology).positions;
  double size = 0.0;
  for (std::size_t p = 0; p < places.tuples; ++p)
    for (int c = 0; c < 3; ++c) size = std::max(size, std::abs(places.at(p, c) - places.at(0, c)));
  std::vector<std::vector<DataArray>> later;
  std::set<std::string> changing;
  for (std::size_t s = 0; s < timed.later.size(); ++s) {
    const std::string& file = timed.states[s + 1];
    SampledModel sampled = sample(timed.later[s], refine, file, memory);
    const DataArray& now = std::get<UnstructuredTopology>(sampled.mesh.topology).positions;
    bool moves = now.tuples != places.tuples;
    for (std::size_t p = 0; !moves && p < places.tuples; ++p)
      for (int c = 0; c < 3; ++c)
        moves = moves || std::abs(now.at(p, c) - places.at(p, c)) > kSamePlace * size;
    if (moves)
      throw input_error({file, "", "has other coordinates than " + timed.states.front(),
                         "values that change at places that stay", "name one .exnode file"});
    std::vector<DataArray> arrays;
    for (DataArray& array : sampled.mesh.arrays) {
      const DataArray* before = first.find(array.name, array.association);
      bool differs = before == nullptr || before->tuples != array.tuples;
      for (std::size_t p = 0; !differs && p < array.tuples; ++p)
        for (int c = 0; c < array.components; ++c)
          differs = differs || !same(array.at(p, c), before->at(p, c));
      if (!differs) continue;
      changing.insert(array.name);
      arrays.push_back(std::move(array));
    }
    later.push_back(std::move(arrays));
  }
  std::string names;
  for (const std::string& name : changing) names += (names.empty() ? "" : ", ") + name;
  notes.push_back(counted(timed.times.size(), ".exnode file") +
                  " with other values at the same nodes are times (" + short_number(timed.times.front()) +
                  " … " + short_number(timed.times.back()) + ", no unit stated); what changes: " + names);
  return later;
}

}  // namespace palpate::ex
