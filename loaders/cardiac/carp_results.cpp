#include "loaders/cardiac/carp_results.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <sstream>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/cardiac/mesh_text.h"
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
constexpr std::array<IgbType, 11> kTypes{{{"byte", ScalarType::kUint8, 1},
                                          {"char", ScalarType::kInt8, 1},
                                          {"short", ScalarType::kInt16, 1},
                                          {"ushort", ScalarType::kUint16, 1},
                                          {"int", ScalarType::kInt32, 1},
                                          {"uint", ScalarType::kUint32, 1},
                                          {"long", ScalarType::kInt32, 1},
                                          {"float", ScalarType::kFloat32, 1},
                                          {"double", ScalarType::kFloat64, 1},
                                          {"vec3f", ScalarType::kFloat32, 3},
                                          {"vec3d", ScalarType::kFloat64, 3}}};

std::string array_name(const std::string& file) {
  return std::filesystem::path(stem_of(file)).filename().string();
}

/// The words "key:value" of a header; lines that begin with '#' are remarks.
std::map<std::string, std::string> words_of(const std::string& header) {
  std::map<std::string, std::string> words;
  std::istringstream lines(header.substr(0, header.find_first_of(std::string("\0\f", 2))));
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("#")) continue;
    std::istringstream in(line);
    for (std::string word; in >> word;) {
      const std::size_t colon = word.find(':');
      if (colon != std::string::npos) words[word.substr(0, colon)] = word.substr(colon + 1);
    }
  }
  return words;
}

}  // namespace

IgbFile::IgbFile(std::string file, std::size_t points) : file_(std::move(file)) {
  const auto refuse = [this](const std::string& found, const std::string& expected = "") {
    throw input_error({file_, "header", found, expected});
  };
  std::ifstream in(file_, std::ios::binary);
  std::string header(kHeaderBytes, '\0');
  if (!in.read(header.data(), static_cast<std::streamsize>(header.size())))
    refuse("is shorter than 1024 bytes", "an openCARP .igb file");
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
  if (numbers != static_cast<double>(points))
    refuse("speaks of " + short_number(numbers) + " points", std::to_string(points) + " as the mesh has");
  const std::uint64_t steps = count("t", 1);
  const std::string type = word("type");
  const auto* const known =
      std::find_if(kTypes.begin(), kTypes.end(), [&](const IgbType& t) { return t.word == type; });
  if (known == kTypes.end()) refuse("type:" + type.substr(0, 20), "float, double, short, …");
  stored_ = known->type;
  const std::string order = word("systeme");
  if (order != "little_endian" && order != "big_endian")
    refuse(order.empty() ? "has no systeme:" : "systeme:" + order.substr(0, 20),
           "little_endian or big_endian");
  swapped_ = (order == "little_endian") != (std::endian::native == std::endian::little);
  factor_ = value("facteur", 1.0);
  zero_ = value("zero", 0.0);
  unit_ = word("unites");
  time_unit_ = word("units_t").empty() ? word("unites_t") : word("units_t");

  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file_, error);
  const std::uint64_t step_bytes =
      static_cast<std::uint64_t>(points) * static_cast<std::uint64_t>(known->components) * byte_size(stored_);
  if (steps > kMostSteps || error || steps > (bytes - kHeaderBytes) / step_bytes)
    refuse(
        "promises " + std::to_string(steps) + " time steps",
        std::to_string(step_bytes == 0 ? 0 : (bytes - kHeaderBytes) / step_bytes) + " that the file holds");
  const double first = value("org_t", 0.0);
  const double span = value("dim_t", static_cast<double>(steps) - 1.0);
  const double between = value("inc_t", steps > 1 ? span / (static_cast<double>(steps) - 1.0) : 1.0);
  if (!(between > 0.0)) refuse("has steps " + short_number(between) + " apart", "times that rise");
  for (std::uint64_t i = 0; i < steps; ++i) times_.push_back(first + static_cast<double>(i) * between);
  info_ = {array_name(file_), Association::kPoint, known->components, ScalarType::kFloat64, points};
}

DataArray IgbFile::read(std::size_t step) const {
  const std::size_t numbers = info_.tuples * static_cast<std::size_t>(info_.components);
  const std::size_t size = byte_size(stored_);
  std::vector<std::byte> bytes(numbers * size);
  std::ifstream in(file_, std::ios::binary);
  in.seekg(static_cast<std::streamoff>(kHeaderBytes + step * bytes.size()));
  if (!in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())))
    throw input_error({file_, "time step " + std::to_string(step + 1), "cannot be read"});
  if (swapped_)
    for (std::size_t n = 0; n < numbers; ++n)
      std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(n * size),
                   bytes.begin() + static_cast<std::ptrdiff_t>((n + 1) * size));
  const DataArray stored{.name = info_.name,
                         .association = info_.association,
                         .components = 1,
                         .type = stored_,
                         .tuples = numbers,
                         .bytes = bytes,
                         .owner = nullptr};
  std::vector<double> values(numbers);
  for (std::size_t n = 0; n < numbers; ++n) values[n] = stored.at(n) * factor_ + zero_;
  return make_array(info_.name, info_.association, info_.components, std::span<const double>(values));
}

DataArray read_dat(const std::string& file, std::size_t points, std::size_t cells) {
  TextLines lines(file, '#');
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
  return make_array(array_name(file), values.size() == points ? Association::kPoint : Association::kCell, 1,
                    std::span<const double>(values));
}

}  // namespace palpate
