#include "common/scene/report_request.h"

#include <type_traits>
#include <variant>
#include <vector>

#include "common/load/helper/message_json.h"
#include "common/scene/document/setting.h"

namespace palpate {
namespace {

using namespace message;

FieldKind kind_from_name(const std::string& name) {
  for (const FieldKind kind : kFieldKinds)
    if (name_of(kind) == name) return kind;
  malformed("'" + name + "' is no kind of field");
}

template <typename T>
constexpr bool kIsList = false;
template <typename T>
constexpr bool kIsList<std::vector<T>> = true;

/// The value as text, one for each value of a list, whatever characters they have.
Json parts_of(const Setting& setting, const Document& document) {
  Json parts = Json::array();
  std::visit(
      [&](const auto& place) {
        auto& value = place(const_cast<Document&>(document));
        if constexpr (kIsList<std::remove_reference_t<decltype(value)>>) {
          for (const auto& each : value)
            parts.push_back(text_from_bytes(std::filesystem::path(each).string()));
        } else {
          parts.push_back(text_from_bytes(value_text(setting, document)));
        }
      },
      setting.place);
  return parts;
}

void take_parts(const Setting& setting, const std::vector<std::string>& parts, Document& document) {
  std::visit(
      [&](const auto& place) {
        auto& value = place(document);
        if constexpr (kIsList<std::remove_reference_t<decltype(value)>>) {
          value.assign(parts.begin(), parts.end());
        } else {
          if (parts.size() != 1) malformed("a setting has " + std::to_string(parts.size()) + " values");
          set_value(setting, document, parts.front());
        }
      },
      setting.place);
}

}  // namespace

std::string encode(const ReportRequest& request) {
  Json values = Json::array();
  const std::vector<Setting>& rows = settings();
  for (std::size_t row = 0; row < rows.size(); ++row) {
    if (!is_default(rows[row], request.document))
      values.push_back({{"row", row}, {"text", parts_of(rows[row], request.document)}});
  }
  return Json{{"subject", request.subject},
              {"program", request.program},
              {"command_line", text_from_bytes(request.command_line)},
              {"kind", name_of(request.document.input.kind)},
              {"settings", values},
              {"given", request.document.given}}
      .dump();
}

ReportRequest decode_report_request(std::string_view text) {
  const Json message = parse(text);
  ReportRequest request{.subject = string_at(message, "subject"),
                        .program = string_at(message, "program"),
                        .command_line = string_at(message, "command_line"),
                        .document = {}};
  request.document.input.kind = kind_from_name(string_at(message, "kind"));
  const std::vector<Setting>& rows = settings();
  for (const Json& value : array_at(message, "settings")) {
    const std::uint64_t row = count_at(value, "row");
    if (row >= rows.size()) malformed("there is no such setting");
    take_parts(rows[row], strings_at(value, "text"), request.document);
  }
  request.document.given = strings_at(message, "given");
  return request;
}

std::string encode(const ReportAnswer& answer) {
  Json ledger = Json::array();
  for (const LedgerEntry& entry : answer.ledger) {
    ledger.push_back({{"what", text_from_bytes(entry.what)},
                      {"why", text_from_bytes(entry.why)},
                      {"times", entry.times},
                      {"milliseconds", entry.milliseconds},
                      {"bytes", entry.bytes}});
  }
  return Json{{"text", text_from_bytes(answer.text)},
              {"json", text_from_bytes(answer.json)},
              {"ledger", std::move(ledger)}}
      .dump();
}

ReportAnswer decode_report_answer(std::string_view text) {
  const Json message = parse(text);
  throw_failure(message);
  ReportAnswer answer{.text = string_at(message, "text"), .json = string_at(message, "json"), .ledger = {}};
  try {
    for (const Json& row : message.at("ledger")) {
      answer.ledger.push_back({.what = string_at(row, "what"),
                               .why = string_at(row, "why"),
                               .times = row.at("times"),
                               .milliseconds = row.at("milliseconds"),
                               .bytes = row.at("bytes")});
    }
  } catch (const Json::exception&) {
    malformed("no ledger");
  }
  return answer;
}

std::string encode(const ReportNews& news) {
  return Json{{"note", text_from_bytes(news.note)}, {"text", text_from_bytes(news.text)}}.dump();
}

ReportNews decode_report_news(std::string_view text) {
  const Json message = parse(text);
  return {.note = string_at(message, "note"), .text = string_at(message, "text")};
}

std::filesystem::path unfinished_output(const std::filesystem::path& output, pid_t pid) {
  const std::filesystem::path whole = output.has_filename() ? output : output.parent_path();
  return whole.parent_path() / ("." + whole.filename().string() + "." + std::to_string(pid) + ".part");
}

}  // namespace palpate
