#include "common/cli/json/json_output.h"

#include <algorithm>
#include <string_view>

#include "common/base/text.h"
#include "common/base/version.h"
#include "common/cli/json/json_parts.h"

namespace palpate {
namespace {

Json value_json(const Setting& row, const Document& document) {
  const std::string text = value_text(row, document);
  const bool is_switch = std::holds_alternative<ValueAt<bool>>(row.place) ||
                         std::holds_alternative<ValueAt<std::optional<bool>>>(row.place);
  if (is_switch && !text.empty()) return text == "on";
  if (row.several()) {
    Json list = Json::array();
    for (const std::string_view part : split(text, ';')) list.push_back(std::string(part));
    return list;
  }
  const bool words = std::holds_alternative<ValueAt<std::string>>(row.place) ||
                     std::holds_alternative<ValueAt<std::filesystem::path>>(row.place) ||
                     std::holds_alternative<ValueAt<std::optional<std::filesystem::path>>>(row.place);
  if (words || text.empty()) return text;
  return parse_json(text);
}

}  // namespace

std::string settings_json(const Document& document, Groups groups) {
  Json settings_of = Json::object();
  for (const Setting& row : settings()) {
    const bool of_output = row.spelling == Spelling::kPositional ||
                           (row.groups.has(Group::kCommon) && row.spelling == Spelling::kFlag);
    const bool given = std::ranges::find(document.given, row.name) != document.given.end();
    if (of_output || !row.belongs(document.input.kind, groups) || (!given && is_default(row, document)))
      continue;
    settings_of[std::string(row.name)] = value_json(row, document);
  }
  return json_text(settings_of);
}

std::string with_member(const std::string& object, const char* name, const std::string& value) {
  Json json = parse_json(object);
  json[name] = parse_json(value);
  return json_text(json);
}

std::string ledger_json(const std::vector<LedgerEntry>& entries) {
  Json list = Json::array();
  for (const LedgerEntry& entry : entries) {
    list.push_back({{"what", entry.what},
                    {"why", entry.why},
                    {"times", entry.times},
                    {"milliseconds", entry.milliseconds},
                    {"bytes", entry.bytes}});
  }
  return json_text(list);
}

std::string error_json(const std::string& line, int exit_code) {
  return json_text({{"error", line}, {"exit", exit_code}});
}

}  // namespace palpate
