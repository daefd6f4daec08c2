#include "common/study/data_column.h"

#include "common/base/json.h"

namespace palpate {

std::string data_dictionary(const std::vector<DataColumn>& columns) {
  Json json = Json::object();
  for (const DataColumn& column : columns) {
    json[column.name] = {{"Description", column.description}};
    if (!column.units.empty()) json[column.name]["Units"] = column.units;
  }
  return json_text(json) + "\n";
}

std::string table_header(const std::vector<DataColumn>& columns, char separator) {
  std::string line;
  for (const DataColumn& column : columns)
    line += (line.empty() ? "" : std::string(1, separator)) + column.name;
  return line + "\n";
}

std::vector<DataColumn> vector_columns(std::string_view name, const std::string& what,
                                       const std::string& units) {
  std::vector<DataColumn> out;
  for (const char* axis : {"x", "y", "z"})
    out.push_back({std::string(name) + "_" + axis, what + ", " + axis, units});
  return out;
}

}  // namespace palpate
