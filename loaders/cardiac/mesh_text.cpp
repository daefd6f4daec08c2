#include "loaders/cardiac/mesh_text.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <span>
#include <system_error>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/heart/tissue.h"
#include "common/load/gzip_head.h"
#include "common/math/vec.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vec3 unit_or_nan(const Vec3& v) {
  // Scaled first, so that neither tiny nor huge numbers are lost in squares.
  const double largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (!(largest > 0.0) || !std::isfinite(largest)) return Vec3{kNaN};
  return glm::normalize(v / largest);
}

void append(std::vector<double>& to, const Vec3& v) { to.insert(to.end(), {v[0], v[1], v[2]}); }

}  // namespace

std::size_t believed_count(TextLines& lines, const char* what, std::size_t least_bytes) {
  std::error_code ignored;
  const std::uintmax_t bytes = std::filesystem::file_size(lines.file(), ignored);
  const bool packed = lowered(lines.file()).ends_with(".gz");
  const double room =
      static_cast<double>(ignored ? 0 : bytes) * (packed ? static_cast<double>(kGzipRatio) : 1.0);
  const double most = std::min(room / static_cast<double>(least_bytes), 2e9);
  return as_size(lines.integer(what, 0, static_cast<std::int64_t>(most)));
}

void append_directions(std::span<const Vec3> vectors, Directions& directions) {
  const Vec3 fibre = unit_or_nan(vectors[0]);
  if (std::isnan(fibre[0])) ++directions.missing;
  append(directions.fibre, fibre);
  directions.lengths.push_back(std::hypot(vectors[0].x, vectors[0].y, vectors[0].z));
  if (vectors.size() == 1) return;
  const Vec3 sheet = unit_or_nan(vectors[1]);
  append(directions.sheet, sheet);
  append(directions.normal, unit_or_nan(vectors.size() == 3 ? vectors[2] : glm::cross(fibre, sheet)));
}

Directions read_directions(TextLines& lines, std::size_t count, const DirectionRows& rows) {
  Directions directions;
  const int per_row = rows.numbers;
  std::int64_t first = 0;
  for (std::size_t row = 0; row < count; ++row) {
    if (rows.numbered) {
      const std::int64_t next = first + static_cast<std::int64_t>(row);
      const std::int64_t read = lines.integer("the next element's number", next, row == 0 ? 1 : next);
      if (row == 0) first = read;
    }
    Vec3 vectors[3] = {Vec3{0.0}, Vec3{0.0}, Vec3{0.0}};
    for (int n = 0; n < per_row * rows.places; ++n) {
      const std::string_view word = lines.word();
      if (word.empty())
        lines.refuse("ends after " + std::to_string(row) + " directions", std::to_string(count));
      const auto value = number(word);
      if (!value)
        lines.refuse("has \"" + std::string(word.substr(0, 40)) + "\"", "a component of a direction");
      if (n < per_row) {
        vectors[n / 3][n % 3] = *value;
      } else {
        directions.further.push_back(*value);
      }
    }
    append_directions(std::span<const Vec3>(vectors, as_size(per_row / 3)), directions);
  }
  return directions;
}

void leave_out_missing(Directions& directions, std::vector<std::string>& notes) {
  const double least = least_direction_length(directions.lengths);
  std::size_t tiny = 0;
  for (std::size_t i = 0; i < directions.lengths.size(); ++i) {
    if (!(directions.lengths[i] > 0.0) || !(directions.lengths[i] < least)) continue;
    std::fill_n(directions.fibre.begin() + static_cast<std::ptrdiff_t>(3 * i), 3, kNaN);
    ++tiny;
  }
  directions.missing += tiny;
  if (tiny > 0)
    notes.push_back(counted(tiny, "fibre") + " a million times shorter than the others: taken for none");
  if (directions.missing > 0)
    notes.push_back(counted(directions.missing, "element") + " without a fibre direction: zero or NaN");
}

void add_directions(const Directions& directions, DataSet& mesh) {
  const auto add = [&mesh](const char* name, const std::vector<double>& values) {
    if (!values.empty())
      mesh.arrays.push_back(make_array(name, Association::kCell, 3, std::span<const double>(values)));
  };
  add("fibre", directions.fibre);
  add("sheet", directions.sheet);
  add("normal", directions.normal);
}

std::string ending_of(const std::string& file) {
  std::filesystem::path path(file);
  std::string ending = lowered(path.extension().string());
  if (ending == ".gz") ending = lowered(path.stem().extension().string());
  return ending;
}

std::string stem_of(const std::string& file) {
  std::filesystem::path path(file);
  if (lowered(path.extension().string()) == ".gz") path.replace_extension();
  return path.replace_extension().string();
}

std::string sibling(const std::string& file, const std::string& ending) {
  const std::string stem = stem_of(file);
  std::error_code ignored;
  for (const std::string& candidate : {stem + ending, stem + ending + ".gz"})
    if (std::filesystem::is_regular_file(candidate, ignored)) return candidate;
  return {};
}

}  // namespace palpate
