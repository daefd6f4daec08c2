// Tecplot's ASCII data: variables, then zones, each with its header of KEY=value and its numbers.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/mesh/mesh_file.h"
#include "loaders/mesh/mesh_words.h"
#include "loaders/mesh/tecplot_zones.h"

namespace palpate {
namespace {

std::string upper(std::string_view text) {
  std::string out(text);
  for (char& c : out) {
    if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
  }
  return out;
}

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
        content_.notes.insert("records " + key + " left out");
        do skip_line();
        while (!token_.empty() && !starts_record(upper(token_)));
      } else {
        words_.refuse("'" + printable(token_.substr(0, 40)) + "'", "TITLE, VARIABLES or ZONE");
      }
    }
    return meshes_of(std::move(content_), words_.file(), budget_);
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
    if (!content_.variables.empty() && found != content_.variables)
      words_.refuse("other VARIABLES than before", "the same for all zones");
    content_.variables = std::move(found);
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
      if (*n > content_.variables.size())
        words_.refuse("variable " + std::to_string(*n), "one that there is");
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

  void set_type(TecplotZone& zone, std::string type) {
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
    if (content_.variables.empty()) words_.refuse("a zone", "VARIABLES before it");
    TecplotZone zone;
    zone.name = "zone " + std::to_string(content_.zones.size() + 1);
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
              from.empty() ? content_.zones.size() : static_cast<std::size_t>(whole(from, "a zone", 1));
          if (other == 0 || other > content_.zones.size())
            words_.refuse("variables of zone " + std::to_string(other), "a zone before this");
          zone.shared[variable] = other - 1;
        }
      }
      if (key == "CONNECTIVITYSHAREZONE") {
        const auto other = static_cast<std::size_t>(whole(value, "a zone", 1));
        if (other > content_.zones.size())
          words_.refuse("the elements of zone " + std::to_string(other), "a zone before this");
        zone.cells_of = other - 1;
      }
      next();
    }
    read_numbers(zone);
    content_.zones.push_back(std::move(zone));
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

  void read_numbers(TecplotZone& zone) {
    constexpr std::int64_t kMostPoints = std::int64_t{1} << 36U;
    if (zone.i > kMostPoints / zone.j || zone.i * zone.j > kMostPoints / zone.k)
      words_.refuse("a zone of more points than 2^36", "one that can be");
    const std::size_t nodes = zone.node_count(), cells = zone.cell_count(),
                      variables = content_.variables.size();
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
      if (content_.zones[from].values[variable].size() != (zone.of_cells.count(variable) > 0 ? cells : nodes))
        words_.refuse("a variable of a zone of another size", "one of the same");
      spend(content_.zones[from].values[variable].size(), "many values of other zones");
      zone.values[variable] = content_.zones[from].values[variable];
    }
    if (zone.elements) read_elements(zone, nodes, cells);
    if (!token_.empty() && !quoted_ && looks_like_number(token_))
      words_.refuse("'" + printable(token_.substr(0, 40)) + "' behind the last value of a zone",
                    "as many values as it says");
  }

  void read_elements(TecplotZone& zone, std::size_t nodes, std::size_t cells) {
    if (zone.cells_of) {
      const TecplotZone& other = content_.zones[*zone.cells_of];
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

  MeshWords words_;
  std::size_t budget_;  ///< of spend()
  std::string token_, pending_;
  bool quoted_ = false;
  std::size_t repeats_ = 0;
  double repeated_ = 0.0;
  TecplotContent content_;
};

}  // namespace

MeshFile read_tecplot(std::string_view text, const std::string& file) {
  return TecplotReader(text, file).read();
}

}  // namespace palpate
