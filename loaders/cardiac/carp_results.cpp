#include "loaders/cardiac/carp_results.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <span>
#include <sstream>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/cardiac/mesh_text.h"
#include "loaders/cardiac/packed_file.h"
#include "loaders/cardiac/text_lines.h"

namespace palpate {
namespace {

constexpr std::size_t kHeaderBytes = 1024;
constexpr std::size_t kMostSteps = 10'000'000;

struct IgbType {
  std::string_view word;
  ScalarType type;
  int components;
};
constexpr std::array<IgbType, 16> kTypes{{{"byte", ScalarType::kUint8, 1},
                                          {"char", ScalarType::kInt8, 1},
                                          {"short", ScalarType::kInt16, 1},
                                          {"ushort", ScalarType::kUint16, 1},
                                          {"int", ScalarType::kInt32, 1},
                                          {"uint", ScalarType::kUint32, 1},
                                          {"long", ScalarType::kInt64, 1},
                                          {"float", ScalarType::kFloat32, 1},
                                          {"double", ScalarType::kFloat64, 1},
                                          {"complex", ScalarType::kFloat32, 2},
                                          {"double_complex", ScalarType::kFloat64, 2},
                                          {"rgba", ScalarType::kUint8, 4},
                                          {"vec3f", ScalarType::kFloat32, 3},
                                          {"vec3d", ScalarType::kFloat64, 3},
                                          {"vec4f", ScalarType::kFloat32, 4},
                                          {"vec4d", ScalarType::kFloat64, 4}}};

std::string array_name(const std::string& file) {
  return std::filesystem::path(stem_of(file)).filename().string();
}

/// The words "key:value" of a header, keys in lower case; lines that begin with '#' are remarks. Between words
/// stand blanks, commas or semicolons.
std::map<std::string, std::string> words_of(const std::string& header) {
  std::map<std::string, std::string> words;
  std::istringstream lines(header.substr(0, header.find_first_of(std::string("\0\f", 2))));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    std::replace_if(
        line.begin(), line.end(), [](char c) { return c == ',' || c == ';'; }, ' ');
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      const std::size_t colon = word.find(':');
      if (colon != std::string::npos) words[lowered(word.substr(0, colon))] = word.substr(colon + 1);
    }
  }
  return words;
}

/// A header is text of as many times 1024 bytes as it takes to its form feed; of 1024 where none ends it so.
std::size_t header_bytes(std::string_view start) {
  for (std::size_t i = 0; i < start.size(); ++i) {
    const auto c = static_cast<unsigned char>(start[i]);
    if (c == '\f' && (i + 1) % kHeaderBytes == 0) return i + 1;
    if (std::isprint(c) == 0 && std::isspace(c) == 0) break;
  }
  return kHeaderBytes;
}

}  // namespace

IgbFile::IgbFile(std::string file, std::size_t points, std::size_t cells) : file_(std::move(file)) {
  const auto refuse = [this](const std::string& found, const std::string& expected = "") {
    throw input_error({file_, "header", found, expected});
  };
  constexpr std::size_t kLongestHeader = 64 * kHeaderBytes;
  std::string header(kLongestHeader, '\0');
  header.resize(PackedFile(file_).read(header.data(), header.size()));
  if (header.size() < kHeaderBytes) refuse("is shorter than 1024 bytes", "an openCARP .igb file");
  header_ = header_bytes(header);
  header.resize(header_);
  const auto words = words_of(header);
  const auto value = [&](const char* key, double otherwise) {
    const auto word = words.find(key);
    if (word == words.end()) return otherwise;
    const auto parsed = number(word->second);
    if (!parsed || !std::isfinite(*parsed))
      refuse(std::string(key) + ":" + word->second.substr(0, 20), "a number");
    return *parsed;
  };
  const auto count = [&](const char* key, double otherwise) {
    const double n = value(key, otherwise);
    constexpr double kMost = 1e12;
    if (!(n >= 1.0 && n <= kMost) || n != std::floor(n))
      refuse(std::string(key) + ":" + short_number(n), "a count");
    return static_cast<std::uint64_t>(n);
  };
  const auto word = [&](const char* key) {
    const auto found = words.find(key);
    return found == words.end() ? std::string() : found->second;
  };

  if (words.count("x") == 0 || words.count("type") == 0)
    refuse("has no x: and type:", "an openCARP .igb file");
  const double numbers = static_cast<double>(count("x", 1)) * static_cast<double>(count("y", 1)) *
                         static_cast<double>(count("z", 1));
  const bool of_points = numbers == static_cast<double>(points);
  if (!of_points && numbers != static_cast<double>(cells))
    refuse("speaks of " + short_number(numbers) + " places",
           std::to_string(points) + " points or " + std::to_string(cells) + " elements as the mesh has");
  const std::size_t tuples = of_points ? points : cells;
  const std::uint64_t promised = count("t", 1);
  const std::string type = lowered(word("type"));
  const auto* const known =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const IgbType& t) { return t.word == type; });
  if (known == kTypes.end()) refuse("type:" + type.substr(0, 20), "float, double, short, long, vec3f, …");
  stored_ = known->type;
  const std::string order = lowered(word("systeme"));
  if (order != "little_endian" && order != "big_endian")
    refuse(order.empty() ? "has no systeme:" : "systeme:" + order.substr(0, 20),
           "little_endian or big_endian");
  swapped_ = (order == "little_endian") != (std::endian::native == std::endian::little);
  factor_ = value("facteur", 1.0);
  zero_ = value("zero", 0.0);
  unit_ = word("unites");
  time_unit_ = word("units_t").empty() ? word("unites_t") : word("units_t");

  const std::uint64_t steps =
      whole_steps(promised, static_cast<std::uint64_t>(tuples) *
                                static_cast<std::uint64_t>(known->components) * byte_size(stored_));
  const double first = value("org_t", 0.0);
  const double intervals = static_cast<double>(promised) - 1.0;
  const bool stated = words.count("inc_t") + words.count("dim_t") + words.count("fac_t") > 0;
  const double between =
      value("inc_t", promised > 1 && words.count("dim_t") > 0 ? value("dim_t", intervals) / intervals
                                                              : value("fac_t", 1.0));
  if (!stated && steps > 1)
    notes_.push_back(file_ + ": the header states no times (inc_t, dim_t): steps are one apart");
  // All that state the times should state the same.
  constexpr double kSame = 0.01;  // dim_t counts steps or the intervals between, by who wrote it
  const auto disagrees = [&](const char* key, double per_step) {
    if (words.count(key) == 0 || !(std::abs(per_step - between) > kSame * between)) return;
    notes_.push_back("WARNING: " + file_ + ": the header states steps " + short_number(between) +
                     " apart, and by " + key + ":" + words.at(key) + " they are " + short_number(per_step) +
                     ": taken as " + (words.count("inc_t") > 0 ? "inc_t" : "dim_t") + " says");
  };
  disagrees("fac_t", value("fac_t", between));
  const double whole = value("dim_t", between * intervals);
  if (promised > 1 && std::abs(whole - between * (intervals + 1.0)) > kSame * between)
    disagrees("dim_t", whole / intervals);
  if (!(between > 0.0)) refuse("has steps " + short_number(between) + " apart", "times that rise");
  for (std::uint64_t i = 0; i < steps; ++i) times_.push_back(first + static_cast<double>(i) * between);
  info_ = {array_name(file_), of_points ? Association::kPoint : Association::kCell, known->components,
           ScalarType::kFloat64, tuples};
  doubt_byte_order(order);
}

bool IgbFile::state_times_in(const std::string& unit) {
  constexpr std::array<std::pair<std::string_view, double>, 4> kSeconds{
      {{"s", 1.0}, {"ms", 1e-3}, {"us", 1e-6}, {"µs", 1e-6}}};
  const auto seconds = [&kSeconds](const std::string& word) {
    const auto* const found =
        std::ranges::find(kSeconds, std::string_view(word), &std::pair<std::string_view, double>::first);
    return found == kSeconds.end() ? 0.0 : found->second;
  };
  const double own = seconds(time_unit_), other = seconds(unit);
  if (!(own > 0.0 && other > 0.0)) return false;
  for (double& time : times_) time *= own / other;
  time_unit_ = unit;
  return true;
}

void IgbFile::doubt_byte_order(const std::string& stated) {
  if (stored_ != ScalarType::kFloat32 && stored_ != ScalarType::kFloat64) return;
  const DataArray as_stated = read_stored(0, swapped_), turned = read_stored(0, !swapped_);
  // Of the bytes in the wrong order most have exponents that no potential has.
  const auto usual = [](const DataArray& values) {
    constexpr double kLeast = 1e-12, kMost = 1e12;
    std::size_t count = 0;
    for (std::size_t i = 0; i < values.tuples; ++i) {
      const double size = std::abs(values.at(i));
      count += size == 0.0 || std::isnan(size) || (size > kLeast && size < kMost) ? 1 : 0;
    }
    return static_cast<double>(count) / static_cast<double>(std::max<std::size_t>(1, values.tuples));
  };
  constexpr double kFew = 0.5, kNearlyAll = 0.95;
  if (usual(as_stated) < kFew && usual(turned) > kNearlyAll)
    notes_.push_back(
        "WARNING: " + file_ + ": numbers of the first step make no sense as " + stated +
        ", which the header states, and do in the other byte order: is it wrong? Read as stated");
}

std::uint64_t IgbFile::whole_steps(std::uint64_t promised, std::uint64_t step_bytes) {
  const std::uint64_t bytes = unpacked_bytes(file_);
  const std::uint64_t body = bytes > header_ ? bytes - header_ : 0;
  const std::uint64_t whole = step_bytes == 0 ? 0 : body / step_bytes;
  const std::uint64_t rest = step_bytes == 0 ? 0 : body % step_bytes;
  if (whole == 0)
    throw input_error({file_, "header",
                       "promises " + counted(promised, "time step") + " of " + counted(step_bytes, "byte"),
                       "one that is whole: the file holds " + counted(body, "byte") + " behind its header",
                       "was the run cut off, or is it another type?"});
  if (std::min(whole, promised) > kMostSteps)
    throw input_error(
        {file_, "header", "has " + counted(whole, "time step"), "at most " + std::to_string(kMostSteps)});
  if (whole < promised) {
    notes_.push_back(file_ + ": promises " + counted(promised, "time step") + " and holds " +
                     std::to_string(whole) + " whole " + (whole == 1 ? "one" : "ones") +
                     (rest > 0 ? " and " + counted(rest, "byte") + " of another" : "") +
                     ": was the run cut off? The whole ones are taken");
  } else if (body > promised * step_bytes) {
    notes_.push_back(file_ + ": holds " + counted(body - promised * step_bytes, "byte") + " more than its " +
                     counted(promised, "time step") + " of the header: left out");
  }
  return std::min(whole, promised);
}

DataArray IgbFile::read_stored(std::size_t step, bool swapped) const {
  const std::size_t numbers = info_.tuples * as_size(info_.components);
  const std::size_t size = byte_size(stored_);
  auto bytes = std::make_shared<std::vector<std::byte>>(numbers * size);
  PackedFile in(file_);
  // A file that is not packed is known as such once a byte was read, and then gone through without reading.
  std::byte first{};
  if (in.read(&first, 1) != 1 || !in.go_to(header_ + step * bytes->size()) ||
      in.read(bytes->data(), bytes->size()) != bytes->size())
    throw input_error({file_, "time step " + std::to_string(step + 1), "cannot be read"});
  if (swapped)
    for (std::size_t n = 0; n < numbers; ++n)
      std::reverse(bytes->begin() + static_cast<std::ptrdiff_t>(n * size),
                   bytes->begin() + static_cast<std::ptrdiff_t>((n + 1) * size));
  return {.name = info_.name,
          .association = info_.association,
          .components = 1,
          .type = stored_,
          .tuples = numbers,
          .bytes = *bytes,
          .owner = bytes};
}

DataArray IgbFile::read(std::size_t step) const {
  const DataArray stored = read_stored(step, swapped_);
  std::vector<double> values(stored.tuples);
  for (std::size_t n = 0; n < values.size(); ++n) values[n] = stored.at(n) * factor_ + zero_;
  return make_array(info_.name, info_.association, info_.components, std::span<const double>(values));
}

SharedTimes shared_times(const std::vector<IgbFile>& results) {
  constexpr double kSame = 1e-6;  // of the shortest interval
  SharedTimes shared;
  std::vector<double> all;
  double shortest = std::numeric_limits<double>::infinity();
  const bool several = std::any_of(results.begin(), results.end(),
                                   [](const IgbFile& result) { return result.times().size() > 1; });
  for (const IgbFile& result : results) {
    if (several && result.times().size() == 1) continue;
    all.insert(all.end(), result.times().begin(), result.times().end());
    for (std::size_t t = 1; t < result.times().size(); ++t)
      shortest = std::min(shortest, result.times()[t] - result.times()[t - 1]);
  }
  std::sort(all.begin(), all.end());
  const double apart = std::isfinite(shortest) ? kSame * shortest : 0.0;
  for (const double time : all)
    if (shared.times.empty() || time - shared.times.back() > apart) shared.times.push_back(time);
  for (const IgbFile& result : results) {
    const std::vector<double>& own = result.times();
    std::vector<std::size_t> steps(shared.times.size(), own.size() == 1 ? 0 : SharedTimes::kNone);
    for (std::size_t t = 0, step = 0; own.size() > 1 && t < steps.size(); ++t) {
      while (step < own.size() && own[step] < shared.times[t] - apart) ++step;
      if (step < own.size() && own[step] <= shared.times[t] + apart) steps[t] = step;
    }
    shared.steps.push_back(std::move(steps));
  }
  return shared;
}

namespace {

/// Rows "node time" of openCARP's activations: a node may be activated again, or never.
DataArray read_node_times(const std::string& file, std::size_t points, std::vector<std::string>& notes) {
  TextLines lines(file, '#');
  // One place more than there are points, for rows that count them from 1.
  std::vector<double> times(points + 1, std::numeric_limits<double>::quiet_NaN());
  std::size_t again = 0, behind = 0;
  while (lines.next()) {
    if (lines.line().empty()) continue;
    const auto node = number(lines.word_here());
    const auto time = number(lines.word_here());
    if (!node || !time || !lines.word_here().empty())
      lines.refuse("is no node with a time", "two numbers a row");
    if (!(*node >= 0.0 && *node <= static_cast<double>(points)) || *node != std::floor(*node))
      lines.refuse("names node " + short_number(*node), "0 to " + std::to_string(points) + " less one");
    if (*node == static_cast<double>(points)) behind = lines.line_number();
    double& first = times[floor_size(*node)];
    again += std::isnan(first) ? 0 : 1;
    if (std::isnan(first) || *time < first) first = *time;
  }
  const bool from_one = behind > 0 && std::isnan(times.front());
  if (behind > 0 && !from_one)
    throw input_error({file, "line " + std::to_string(behind), "names node " + std::to_string(points),
                       "0 to " + std::to_string(points) + " less one, as another row names node 0"});
  times.erase(from_one ? times.begin() : times.end() - 1);
  const auto without = std::count_if(times.begin(), times.end(), [](double t) { return std::isnan(t); });
  notes.push_back(
      file + ": a table of nodes and times" +
      (from_one
           ? "; nodes count from 1, as one is " + std::to_string(points) + " of " + std::to_string(points)
           : "") +
      (again > 0 ? "; of nodes with several times the first is taken, " + std::to_string(again) + " left out"
                 : "") +
      (without > 0 ? "; " + counted(static_cast<std::uint64_t>(without), "point") + " without a time" : ""));
  return make_array(array_name(file), Association::kPoint, 1, std::span<const double>(times));
}

/// openCARP writes -1 for the activation of a place that never was: none, where all other numbers are times.
void drop_never_activated(const std::string& file, std::vector<double>& values,
                          std::vector<std::string>& notes) {
  std::size_t never = 0;
  for (const double value : values) {
    never += value == -1.0 ? 1 : 0;
    if (value < 0.0 && value != -1.0) return;
  }
  if (never == 0 || never == values.size()) return;
  std::replace(values.begin(), values.end(), -1.0, std::numeric_limits<double>::quiet_NaN());
  notes.push_back(file + ": " + counted(never, "place") + " of -1, and no other number below 0: taken for " +
                  "never activated, as openCARP writes it: no data there");
}

}  // namespace

DataArray read_dat(const std::string& file, std::size_t points, std::size_t cells,
                   std::vector<std::string>& notes) {
  TextLines lines(file, '#');
  std::size_t words = 0;
  while (words == 0 && lines.next())
    while (!lines.word_here().empty()) ++words;
  if (words == 2) return read_node_times(file, points, notes);
  lines.give_back();
  std::vector<double> values;
  while (true) {
    const std::string_view word = lines.word();
    if (word.empty()) break;
    if (word == "nan" || word == "NaN" || word == "NAN") {
      values.push_back(std::numeric_limits<double>::quiet_NaN());
    } else {
      const auto value = number(word);
      if (!value) lines.refuse("has \"" + std::string(word.substr(0, 20)) + "\"", "a number a line");
      values.push_back(*value);
    }
    if (values.size() > std::max(points, cells))
      lines.refuse("goes on after " + std::to_string(values.size() - 1) + " numbers",
                   std::to_string(points) + " points or " + std::to_string(cells) + " elements");
  }
  if (values.size() != points && values.size() != cells)
    lines.refuse("ends after " + std::to_string(values.size()) + " numbers",
                 std::to_string(points) + " points or " + std::to_string(cells) + " elements");
  drop_never_activated(file, values, notes);
  return make_array(array_name(file), values.size() == points ? Association::kPoint : Association::kCell, 1,
                    std::span<const double>(values));
}

}  // namespace palpate
