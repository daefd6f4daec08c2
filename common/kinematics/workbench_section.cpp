#include "common/kinematics/workbench_section.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {

std::string line_of(const toml::node& node) { return "line " + std::to_string(node.source().begin.line); }

void refuse(const std::filesystem::path& path, const std::string& place, const std::string& found,
            const std::string& expected) {
  throw input_error({path.string(), place, found, expected, ""});
}

toml::table parsed_workbench(const std::string& text, const std::filesystem::path& path) {
  try {
    return toml::parse(text, path.string());
  } catch (const toml::parse_error& error) {
    refuse(path, "line " + std::to_string(error.source().begin.line), std::string(error.description()),
           "TOML");
  }
}

std::string workbench_text(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  if (in.is_open()) text << in.rdbuf();
  if (!in.is_open() || in.bad()) {
    throw input_error({path.string(), "", "cannot be read", "a workbench.toml",
                       "the verb `calibrate` makes one with --out workbench.toml"});
  }
  return text.str();
}

WorkbenchSection::WorkbenchSection(const toml::table& table, std::string name,
                                   const std::filesystem::path& path,
                                   std::initializer_list<const char*> known)
    : table_(table), name_(std::move(name)), path_(path) {
  if (known.size() == 0) return;
  for (const auto& [key, node] : table) {
    const std::string word(key.str());
    if (std::find(known.begin(), known.end(), word) != known.end()) continue;
    std::string words;
    for (const char* k : known) words += (words.empty() ? "" : ", ") + std::string(k);
    refuse(path, line_of(node), "unknown key '" + word + "' in [" + name_ + "]", words);
  }
}

const toml::node& WorkbenchSection::at(const char* key) const {
  const toml::node* node = table_.get(key);
  if (!node) refuse(path_, line_of(table_), "[" + name_ + "] has no '" + key + "'", key);
  return *node;
}

std::vector<double> WorkbenchSection::numbers(const toml::node& node, std::size_t count,
                                              bool may_be_nan) const {
  std::vector<double> out;
  const toml::array* array = node.as_array();
  for (std::size_t i = 0; array && i < array->size(); ++i) {
    const auto value = (*array)[i].value<double>();
    if (value && (std::isfinite(*value) || (may_be_nan && std::isnan(*value)))) out.push_back(*value);
  }
  if (!array || out.size() != count || array->size() != count)
    refuse(path_, line_of(node), "not " + std::to_string(count) + " numbers in [" + name_ + "]",
           std::to_string(count) + " finite numbers in brackets");
  return out;
}

Vec3 WorkbenchSection::vector(const toml::node& node, bool may_be_nan) const {
  const auto x = numbers(node, 3, may_be_nan);
  return {x[0], x[1], x[2]};
}

double WorkbenchSection::number(const char* key) const {
  const auto value = at(key).value<double>();
  if (!value || !std::isfinite(*value)) refuse(path_, line_of(at(key)), "no number", "a finite number");
  return *value;
}

const toml::array& WorkbenchSection::array(const char* key) const {
  const toml::array* array = at(key).as_array();
  if (!array) refuse(path_, line_of(at(key)), "no list", "a list in brackets");
  return *array;
}

std::vector<Vec3> WorkbenchSection::vectors(const char* key, std::size_t count) const {
  const toml::array& list = array(key);
  if (list.size() != count)
    refuse(path_, line_of(list), std::to_string(list.size()) + " entries in '" + key + "'",
           std::to_string(count));
  return all_vectors(key);
}

std::vector<Vec3> WorkbenchSection::all_vectors(const char* key, bool may_be_nan) const {
  std::vector<Vec3> out;
  for (const toml::node& node : array(key)) out.push_back(vector(node, may_be_nan));
  return out;
}

Quat WorkbenchSection::rotation(const char* key) const {
  const auto q = numbers(at(key), 4);
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  constexpr double kSlack = 1e-3;
  if (std::abs(length - 1.0) > kSlack)
    refuse(path_, line_of(at(key)), "a quaternion of length " + short_number(length), "1");
  return Quat{q[0], q[1], q[2], q[3]} / length;
}

void WorkbenchSection::refuse_at(const char* key, const std::string& found,
                                 const std::string& expected) const {
  refuse(path_, line_of(at(key)), found, expected);
}

}  // namespace palpate
