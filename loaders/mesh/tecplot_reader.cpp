// Tecplot's ASCII data: variables, then zones, each with its header of KEY=value and its numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/load/step_times.h"
#include "loaders/mesh/mesh_file.h"
#include "loaders/mesh/mesh_words.h"

namespace palpate {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return out;
}

struct Zone {
  std::string name;
  bool block = false, elements = false;
  std::int64_t i = 1, j = 1, k = 1, nodes = 0, cells = 0;
  std::uint8_t type = 0;  ///< of VTK's file format; 0: of lower dimension
  int corners = 0;
  std::optional<double> time;
  std::set<std::size_t> of_cells, passive;
  std::map<std::size_t, std::size_t> shared;  ///< variables, and from which zone
  std::optional<std::size_t> cells_of;        ///< the zone that has its connectivity
  std::vector<std::vector<double>> values;    ///< by variable
  std::vector<std::int64_t> connectivity;

  [[nodiscard]] std::size_t node_count() const {
    return static_cast<std::size_t>(elements ? nodes : i * j * k);
  }
  [[nodiscard]] std::size_t cell_count() const {
    if (elements) return static_cast<std::size_t>(cells);
    const auto along = [](std::int64_t n) { return std::max<std::int64_t>(1, n - 1); };
    return static_cast<std::size_t>(along(i) * along(j) * along(k));
  }
};

class TecplotReader {
 public:
  TecplotReader(std::string_view text, const std::string& file)
      : words_(text, file, '#'), budget_(kFew + kMostABytes * text.size()) {}

  MeshFile read() {
    next();
    while (!token_.empty()) {
      const std::string key = upper(token_);
      if (key == "TITLE") {
        value_of("TITLE");
        next();
      } else if (key == "FILETYPE") {
        const std::string type = upper(value_of("FILETYPE"));
        if (type == "SOLUTION")
          throw input_error({words_.file(), "", "holds a solution without its grid (FILETYPE=SOLUTION)",
                             "both in one file", ""});
        next();
      } else if (key == "VARIABLES") {
        read_variables();
      } else if (key == "ZONE") {
        read_zone();
      } else if (key == "DATASETAUXDATA" || key == "VARAUXDATA") {
        skip_line();
      } else if (key == "TEXT" || key == "GEOMETRY" || key == "CUSTOMLABELS") {
        notes_.insert("records " + key + " left out");
        do skip_line();
        while (!token_.empty() && !starts_record(upper(token_)));
      } else {
        words_.refuse("'" + printable(token_.substr(0, 40)) + "'", "TITLE, VARIABLES or ZONE");
      }
    }
    return made();
  }

 private:
  /// Numbers that a file of so many bytes may have without a letter for each: repeated and shared ones.
  static constexpr std::size_t kFew = std::size_t{1} << 22U, kMostABytes = 64;

  /// A few letters must not fill the memory.
  void spend(std::size_t numbers, const std::string& what) {
    if (numbers > budget_) words_.refuse(what, "as many as the file is long");
    budget_ -= numbers;
  }

  static bool starts_record(const std::string& key) {
    for (const char* const known : {"TITLE", "FILETYPE", "VARIABLES", "ZONE", "TEXT", "GEOMETRY",
                                    "CUSTOMLABELS", "DATASETAUXDATA", "VARAUXDATA"}) {
      if (key == known) return true;
    }
    return false;
  }

  /// The next token: a word up to '=', '=' itself, a list in brackets, or a string.
  void next() {
    if (!pending_.empty()) {
      token_ = std::exchange(pending_, {});
      quoted_ = false;
    } else {
      token_ = std::string(words_.word());
      quoted_ = words_.quoted();
    }
    if (quoted_ || token_.empty()) return;
    const std::size_t open = token_.find('(');
    const std::size_t equal = token_.find('=');
    if (equal != std::string::npos && (open == std::string::npos || equal < open) && token_.size() > 1) {
      pending_ = token_.substr(equal == 0 ? 1 : equal);
      token_.resize(equal == 0 ? 1 : equal);
      return;
    }
    if (open == 0) {
      // Lists may hold blanks and commas, which part words.
      const auto opened = [](std::string_view text) {
        return std::ranges::count(text, '(') - std::ranges::count(text, ')');
      };
      std::string_view more;
      for (auto depth = opened(token_); depth > 0; depth += opened(more)) {
        more = words_.word();
        if (more.empty()) words_.refuse("'" + printable(token_.substr(0, 40)) + "'", "a closed list");
        (token_ += ' ') += more;
      }
      const std::size_t close = token_.rfind(')');
      pending_ = token_.substr(close + 1);
      token_.resize(close + 1);
    }
  }
  std::string value_of(const char* key) {
    next();
    if (token_ != "=")
      words_.refuse("'" + printable(token_.substr(0, 40)) + "'", std::string("= after ") + key);
    next();
    if (token_.empty() && !quoted_) words_.refuse("ends", std::string("a value of ") + key);
    return token_;
  }
  void skip_line() {
    pending_.clear();
    (void)words_.rest_of_line();
    next();
  }

  void read_variables() {
    (void)value_of("VARIABLES");
    std::vector<std::string> found;
    while (!token_.empty() || quoted_) {
      if (!quoted_ && starts_record(upper(token_))) break;
      found.push_back(token_);
      next();
    }
    if (!variables_.empty() && found != variables_)
      words_.refuse("other VARIABLES than before", "the same for all zones");
    variables_ = std::move(found);
  }

  std::int64_t whole(const std::string& text, const char* what, std::int64_t least) {
    const auto value = parsed<std::int64_t>(text);
    constexpr std::int64_t kMost = std::int64_t{1} << 36U;
    if (!value || *value < least || *value > kMost)
      words_.refuse("'" + printable(text.substr(0, 40)) + "'", what);
    return *value;
  }

  /// The variables that a list such as "1-3,7" names, each once.
  std::set<std::size_t> variables_in(std::string_view list) {
    std::set<std::size_t> out;
    const auto known = [&](std::string_view text) {
      const auto n = parsed<std::size_t>(trimmed(text));
      if (!n || *n == 0)
        words_.refuse("'" + printable(list.substr(0, 40)) + "'", "numbers of variables such as 1-3,7");
      if (*n > variables_.size()) words_.refuse("variable " + std::to_string(*n), "one that there is");
      return *n;
    };
    for (const std::string_view part : split(list, ',')) {
      if (trimmed(part).empty()) continue;
      const std::size_t dash = part.find('-');
      const std::size_t first = known(part.substr(0, dash));
      const std::size_t last = dash == std::string_view::npos ? first : known(part.substr(dash + 1));
      for (std::size_t n = first; n <= last; ++n) {
        spend(1, "a list of many variables");
        out.insert(n - 1);
      }
    }
    return out;
  }

  /// "([4-6]=CELLCENTERED, [7]=NODAL)" or "(NODAL, CELLCENTERED, ...)": what stands for which variables.
  std::map<std::size_t, std::string> by_variable(const std::string& list) {
    std::map<std::size_t, std::string> out;
    std::string_view rest(list);
    if (!rest.empty() && rest.front() == '(') rest = rest.substr(1, rest.size() - 2);
    std::size_t place = 0;
    while (!trimmed(rest).empty()) {
      rest = trimmed(rest);
      while (!rest.empty() && (rest.front() == ',' || rest.front() == ' ')) rest.remove_prefix(1);
      std::set<std::size_t> of{place};
      if (!rest.empty() && rest.front() == '[') {
        const std::size_t close = rest.find(']');
        if (close == std::string_view::npos) break;
        std::string numbers(rest.substr(1, close - 1));
        std::ranges::replace(numbers, ' ', ',');
        of = variables_in(numbers);
        rest = trimmed(rest.substr(close + 1));
        if (!rest.empty() && rest.front() == '=') rest = trimmed(rest.substr(1));
      } else if (!rest.empty() && rest.front() >= '0' && rest.front() <= '9') {
        // "(4=2)" and "(1,2,3)": a variable, and perhaps the zone.
        const std::size_t end = std::min(rest.find_first_of(", "), rest.size());
        const std::string_view word = rest.substr(0, end);
        const std::size_t equal = word.find('=');
        of = variables_in(word.substr(0, equal));
        for (const std::size_t v : of)
          out[v] = equal == std::string_view::npos ? "" : std::string(word.substr(equal + 1));
        rest.remove_prefix(end);
        continue;
      }
      const std::size_t end = std::min(rest.find_first_of(", "), rest.size());
      for (const std::size_t v : of) out[v] = upper(rest.substr(0, end));
      rest.remove_prefix(end);
      ++place;
    }
    return out;
  }

  void set_type(Zone& zone, std::string type) {
    if (type.substr(0, 2) == "FE") type.erase(0, 2);
    static const std::map<std::string, std::pair<std::uint8_t, int>> kTypes{{"LINESEG", {0, 2}},
                                                                            {"TRIANGLE", {0, 3}},
                                                                            {"QUADRILATERAL", {0, 4}},
                                                                            {"TETRAHEDRON", {10, 4}},
                                                                            {"BRICK", {12, 8}}};
    if (type == "ORDERED") return;
    const auto known = kTypes.find(type);
    if (known == kTypes.end())
      words_.refuse("a zone of type " + printable(type.substr(0, 40)), "ORDERED, FETETRAHEDRON or FEBRICK",
                    "polyhedral zones: write them as .vtu or .cgns");
    zone.elements = true;
    zone.type = known->second.first;
    zone.corners = known->second.second;
  }

  void read_zone() {
    if (variables_.empty()) words_.refuse("a zone", "VARIABLES before it");
    Zone zone;
    zone.name = "zone " + std::to_string(zones_.size() + 1);
    next();
    // Up to the first number that no key stands before.
    while (!token_.empty() && (quoted_ || !looks_like_number(token_))) {
      const std::string key = upper(token_);
      if (starts_record(key)) break;
      if (key == "AUXDATA") {
        next();
        (void)value_of("AUXDATA");
        next();
        continue;
      }
      const std::string value = value_of(key.substr(0, 40).c_str());
      if (key == "T") zone.name = value;
      if (key == "I") zone.i = whole(value, "a count of points", 1);
      if (key == "J") zone.j = whole(value, "a count of points", 1);
      if (key == "K") zone.k = whole(value, "a count of points", 1);
      if (key == "N" || key == "NODES") zone.nodes = whole(value, "a count of nodes", 0);
      if (key == "E" || key == "ELEMENTS") zone.cells = whole(value, "a count of elements", 0);
      if (key == "F") {
        const std::string packing = upper(value);
        if (packing.substr(0, 2) == "FE" && !zone.elements) set_type(zone, "FEBRICK");
        zone.block = packing == "BLOCK" || packing == "FEBLOCK";
        if (!zone.block && packing != "POINT" && packing != "FEPOINT")
          words_.refuse("'" + printable(value.substr(0, 40)) + "'", "POINT, BLOCK, FEPOINT or FEBLOCK");
      }
      if (key == "DATAPACKING") zone.block = upper(value) == "BLOCK";
      if (key == "ZONETYPE" || key == "ET") set_type(zone, upper(value));
      if (key == "SOLUTIONTIME") {
        zone.time = palpate::number(value);
        if (!zone.time || !std::isfinite(*zone.time))
          words_.refuse("'" + printable(value.substr(0, 40)) + "'", "a time");
      }
      if (key == "VARLOCATION") {
        for (const auto& [variable, where] : by_variable(value)) {
          if (where == "CELLCENTERED") zone.of_cells.insert(variable);
        }
      }
      if (key == "PASSIVEVARLIST") {
        for (const auto& entry : by_variable(value)) zone.passive.insert(entry.first);
      }
      if (key == "VARSHARELIST") {
        for (const auto& [variable, from] : by_variable(value)) {
          const std::size_t other =
              from.empty() ? zones_.size() : static_cast<std::size_t>(whole(from, "a zone", 1));
          if (other == 0 || other > zones_.size())
            words_.refuse("variables of zone " + std::to_string(other), "a zone before this");
          zone.shared[variable] = other - 1;
        }
      }
      if (key == "CONNECTIVITYSHAREZONE") {
        const auto other = static_cast<std::size_t>(whole(value, "a zone", 1));
        if (other > zones_.size())
          words_.refuse("the elements of zone " + std::to_string(other), "a zone before this");
        zone.cells_of = other - 1;
      }
      next();
    }
    read_numbers(zone);
    zones_.push_back(std::move(zone));
  }

  static bool is_value(std::string_view token) {
    const char first = token.front();
    return (first >= '0' && first <= '9') || first == '-' || first == '+' || first == '.';
  }

  /// The next number of the data, of which "3*1.5" are three.
  double value(const char* what) {
    if (repeats_ > 0) {
      --repeats_;
      return repeated_;
    }
    if (token_.empty()) words_.refuse("ends", what, "the file may be truncated");
    const std::size_t star = token_.find('*');
    if (star != std::string::npos) {
      repeats_ = static_cast<std::size_t>(whole(token_.substr(0, star), "a repetition", 1)) - 1;
      spend(repeats_, "a number repeated " + std::to_string(repeats_ + 1) + " times");
      token_.erase(0, star + 1);
    }
    MeshWords one(token_, words_.file());
    const std::string text = token_;
    if (!looks_like_number(text)) words_.refuse("'" + printable(text.substr(0, 40)) + "'", what);
    repeated_ = one.number(what);
    token_ = std::string(words_.word());
    quoted_ = words_.quoted();
    return repeated_;
  }
  static bool looks_like_number(const std::string& text) {
    const std::string lower = lowered(text);
    return !text.empty() && (is_value(text) || lower.substr(0, 3) == "nan" || lower.substr(0, 3) == "inf");
  }

  void read_numbers(Zone& zone) {
    constexpr std::int64_t kMostPoints = std::int64_t{1} << 36U;
    if (zone.i > kMostPoints / zone.j || zone.i * zone.j > kMostPoints / zone.k)
      words_.refuse("a zone of more points than 2^36", "one that can be");
    const std::size_t nodes = zone.node_count(), cells = zone.cell_count(), variables = variables_.size();
    if (zone.elements && nodes == 0) words_.refuse("a zone without NODES", "a count of them");
    std::vector<std::size_t> own;
    for (std::size_t v = 0; v < variables; ++v) {
      if (zone.shared.count(v) == 0 && zone.passive.count(v) == 0) own.push_back(v);
    }
    zone.values.resize(variables);
    repeats_ = 0;
    if (!zone.block && !zone.of_cells.empty())
      words_.refuse("values of cells point by point", "DATAPACKING=BLOCK");
    // A word takes a byte and a blank, unless it is repeated: memory grows with what is read.
    if (zone.block) {
      for (const std::size_t v : own) {
        const std::size_t count = zone.of_cells.count(v) > 0 ? cells : nodes;
        for (std::size_t n = 0; n < count; ++n) zone.values[v].push_back(value("a value"));
      }
    } else if (!own.empty()) {
      for (std::size_t n = 0; n < nodes; ++n) {
        for (const std::size_t v : own) zone.values[v].push_back(value("a value"));
      }
    }
    if (repeats_ > 0) words_.refuse("more values than the zone has", "as many as it says");
    for (const auto& [variable, from] : zone.shared) {
      if (variable >= variables)
        words_.refuse("variable " + std::to_string(variable + 1), "one that there is");
      if (zones_[from].values[variable].size() != (zone.of_cells.count(variable) > 0 ? cells : nodes))
        words_.refuse("a variable of a zone of another size", "one of the same");
      spend(zones_[from].values[variable].size(), "many values of other zones");
      zone.values[variable] = zones_[from].values[variable];
    }
    if (zone.elements) read_elements(zone, nodes, cells);
    if (!token_.empty() && !quoted_ && looks_like_number(token_))
      words_.refuse("'" + printable(token_.substr(0, 40)) + "' behind the last value of a zone",
                    "as many values as it says");
  }

  void read_elements(Zone& zone, std::size_t nodes, std::size_t cells) {
    if (zone.cells_of) {
      const Zone& other = zones_[*zone.cells_of];
      if (other.cells != zone.cells || other.corners != zone.corners || other.nodes > zone.nodes)
        words_.refuse("the elements of a zone of another size", "one of the same");
      spend(other.connectivity.size(), "many elements of other zones");
      zone.connectivity = other.connectivity;
      return;
    }
    for (std::size_t n = 0; n < cells * static_cast<std::size_t>(zone.corners); ++n) {
      const double corner = value("a node of an element");
      if (!(corner >= 1.0) || corner > static_cast<double>(nodes) || corner != std::floor(corner))
        words_.refuse("node " + short_number(corner), "one of " + std::to_string(nodes) + ", counted from 1");
      zone.connectivity.push_back(static_cast<std::int64_t>(corner) - 1);
    }
  }

  /// A brick with corners that coincide, as wedges, pyramids and tetrahedra are written.
  static void add_brick(CellList& cells, const std::int64_t* p) {
    const auto cell = [&](std::uint8_t type, std::initializer_list<int> corners) {
      std::array<std::int64_t, 8> points{};
      std::size_t count = 0;
      for (const int corner : corners) points[count++] = p[corner];
      cells.add(type, points.data(), count);
    };
    const bool top_is_point = p[4] == p[5] && p[5] == p[6] && p[6] == p[7];
    if (top_is_point && p[2] == p[3]) {
      cell(10, {0, 1, 2, 4});
    } else if (top_is_point) {
      cell(14, {0, 1, 2, 3, 4});
    } else if (p[2] == p[3] && p[6] == p[7]) {
      cell(13, {0, 1, 2, 4, 5, 6});
    } else {
      cell(12, {0, 1, 2, 3, 4, 5, 6, 7});
    }
  }

  /// The variables that are coordinates.
  std::array<std::size_t, 3> coordinates() {
    std::array<std::size_t, 3> out{0, 1, 2};
    int found = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::string letter(1, "xyz"[axis]);
      for (std::size_t v = variables_.size(); v-- > 0;) {
        const std::string name = lowered(variables_[v]);
        const bool own = name == letter || name.substr(0, 2) == letter + " " ||
                         name.substr(0, 2) == letter + "(" || name.substr(0, 2) == letter + "[" ||
                         name.substr(0, 2) == letter + "," || name == "coordinate" + letter ||
                         name == letter + "-coordinate" || name == letter + "_coordinate";
        if (!own) continue;
        out[axis] = v;
        found |= 1 << axis;
      }
    }
    if (variables_.size() < 3) {
      throw input_error({words_.file(), "", "has " + counted(variables_.size(), "variable"),
                         "three coordinates and values", ""});
    }
    if (found != 7) {
      out = {0, 1, 2};
      notes_.insert("the first three variables, " + variables_[0] + ", " + variables_[1] + " and " +
                    variables_[2] + ", are taken for the coordinates");
    }
    return out;
  }

  DataSet block_of(const Zone& zone, const std::array<std::size_t, 3>& xyz) {
    const std::size_t nodes = zone.node_count();
    std::vector<double> positions(3 * nodes);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::vector<double>& from = zone.values[xyz[axis]];
      if (from.size() != nodes)
        throw input_error({words_.file(), zone.name,
                           "has no coordinate " + variables_[xyz[axis]] + " of its points", "", ""});
      for (std::size_t n = 0; n < nodes; ++n) positions[3 * n + axis] = from[n];
    }
    DataSet block;
    block.name = zone.name;
    const DataArray placed = mesh_array("positions", Association::kPoint, 3, positions);
    if (zone.elements) {
      UnstructuredTopology mesh;
      mesh.positions = placed;
      CellList cells;
      for (std::size_t c = 0; c < zone.cell_count() && zone.type != 0; ++c) {
        const std::int64_t* const corners =
            zone.connectivity.data() + c * static_cast<std::size_t>(zone.corners);
        if (zone.type == 12) {
          add_brick(cells, corners);
        } else {
          cells.add(zone.type, corners, static_cast<std::size_t>(zone.corners));
        }
      }
      cells.take(mesh);
      block.topology = std::move(mesh);
    } else {
      block.topology = StructuredTopology{
          .points = {static_cast<int>(zone.i), static_cast<int>(zone.j), static_cast<int>(zone.k)},
          .positions = placed};
    }
    for (std::size_t v = 0; v < variables_.size(); ++v) {
      if (v == xyz[0] || v == xyz[1] || v == xyz[2] || zone.values[v].empty()) continue;
      block.arrays.push_back(mesh_array(variables_[v],
                                        zone.of_cells.count(v) > 0 ? Association::kCell : Association::kPoint,
                                        1, zone.values[v]));
    }
    return block;
  }

  MeshFile made() {
    if (zones_.empty())
      throw input_error({words_.file(), "", "has no zone", "data", "the file may be truncated"});
    const auto xyz = coordinates();
    std::vector<double> times;
    for (const Zone& zone : zones_) {
      if (zone.time) times.push_back(*zone.time);
    }
    times = joined_times(std::move(times));
    for (std::size_t z = 0, t = 0; z < zones_.size(); ++z) {
      if (zones_[z].time) zones_[z].time = times[t++];
    }
    MeshFile out;
    std::map<double, std::vector<DataSet>> by_time;
    std::vector<DataSet> always;
    std::size_t flat = 0;
    for (const Zone& zone : zones_) {
      const bool volume = zone.elements ? zone.type != 0 : std::min({zone.i, zone.j, zone.k}) > 1;
      constexpr std::int64_t kMostPoints = std::numeric_limits<int>::max();
      if (std::max({zone.i, zone.j, zone.k}) > kMostPoints)
        words_.refuse("a zone of too many points", "2^31 at most");
      if (!volume) {
        ++flat;
        continue;
      }
      (zone.time ? by_time[*zone.time] : always).push_back(block_of(zone, xyz));
    }
    if (by_time.empty() && always.empty()) {
      throw input_error({words_.file(), "",
                         "holds points, lines or surfaces only (" + counted(flat, "zone") + ")",
                         "a zone of a volume", ""});
    }
    if (flat > 0) notes_.insert(counted(flat, "zone") + " of points, lines or surfaces left out");
    if (by_time.empty()) {
      out.steps.push_back(std::move(always));
    } else {
      std::size_t repeated = 0;
      for (const DataSet& block : always) {
        if (const auto* mesh = std::get_if<UnstructuredTopology>(&block.topology))
          repeated += mesh->connectivity.size();
      }
      for (auto& [time, blocks] : by_time) {
        spend(repeated, "many elements that stand at all times");
        out.times.push_back(time);
        out.steps.push_back(always);
        out.steps.back().insert(out.steps.back().end(), blocks.begin(), blocks.end());
      }
    }
    out.notes.assign(notes_.begin(), notes_.end());
    return out;
  }

  MeshWords words_;
  std::size_t budget_;  ///< of spend()
  std::string token_, pending_;
  bool quoted_ = false;
  std::size_t repeats_ = 0;
  double repeated_ = 0.0;
  std::vector<std::string> variables_;
  std::vector<Zone> zones_;
  std::set<std::string> notes_;
};

}  // namespace

MeshFile read_tecplot(std::string_view text, const std::string& file) {
  return TecplotReader(text, file).read();
}

}  // namespace palpate
