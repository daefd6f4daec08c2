#include "common/base/files/csv_reader.h"

#include <algorithm>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// A name of a header: lower case, without quotes.
std::string plain_name(std::string_view name) {
  name = trimmed(name);
  if (name.size() >= 2 && name.front() == '"' && name.back() == '"') name = name.substr(1, name.size() - 2);
  return lowered(name);
}

}  // namespace

CsvReader::CsvReader(const std::string& file, std::span<const std::string_view> required,
                     std::span<const std::string_view> optional, const std::string& what)
    : lines_(file, what) {
  if (!next_line()) throw input_error({file, "", "is empty", what, ""});
  header_ = trimmed(lines_.line());
  for (const auto field : split(header_, ',')) header_names_.push_back(plain_name(field));
  const auto find = [&](std::string_view name) {
    const auto place = std::ranges::find(header_names_, name);
    names_.emplace_back(name);
    columns_.push_back(place == header_names_.end() ? kMissing : as_size(place - header_names_.begin()));
    return place != header_names_.end();
  };
  for (const auto name : required) {
    if (!find(name)) refuse("has no column " + std::string(name), what);
  }
  for (const auto name : optional) (void)find(name);
}

bool CsvReader::next_line() {
  while (lines_.next()) {
    const auto line = trimmed(lines_.line());
    if (!line.empty() && line.front() != '#') return true;
  }
  return false;
}

bool CsvReader::next(std::span<double> values) {
  PALPATE_CHECK(values.size() == columns_.size());
  if (!next_line()) return false;
  const auto fields = split(lines_.line(), ',');
  if (fields.size() != header_names_.size()) {
    refuse("has " + counted(fields.size(), "field"),
           std::to_string(header_names_.size()) + " as in the header " + header_);
  }
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    values[i] = std::numeric_limits<double>::quiet_NaN();
    if (columns_[i] == kMissing) continue;
    const auto value = number(fields[columns_[i]]);
    if (!value) refuse("no number in column " + names_[i], "a number");
    values[i] = *value;
  }
  return true;
}

std::string_view CsvReader::text(std::string_view column) const {
  const auto place = std::ranges::find(header_names_, column);
  if (place == header_names_.end()) return {};
  return trimmed(split(lines_.line(), ',')[as_size(place - header_names_.begin())]);
}

}  // namespace palpate
