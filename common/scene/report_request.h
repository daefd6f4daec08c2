/// What the program of studies is asked for and what it answers: the messages between it and the program that
/// starts it (load/helper_process.h).
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <sys/types.h>

#include "common/base/ledger.h"
#include "common/scene/document/document.h"

namespace palpate {

/// The helper program.
inline constexpr const char* kStudyProgram = "palpate-lab";

struct ReportRequest {
  std::string subject;       ///< what is studied: name_of(FieldKind), or what a verb of devices calls it
  std::string program;       ///< that was called: of the page's title
  std::string command_line;  ///< as typed
  Document document;
};

/// What its user sees in the end.
struct ReportAnswer {
  std::string text;                 ///< for people
  std::string json;                 ///< one object
  std::vector<LedgerEntry> ledger;  ///< what the program of studies did
};

/// What its user sees before: one of the two.
struct ReportNews {
  std::string note;  ///< a remark
  std::string text;  ///< a result
};

/// @name Messages. Documents travel as the rows of their tables: both ends are of one build.
/// @throws ProtocolError where a message is none; decode_report_answer() an Error that the answer is.
/// @{
[[nodiscard]] std::string encode(const ReportRequest& request);
[[nodiscard]] ReportRequest decode_report_request(std::string_view text);
[[nodiscard]] std::string encode(const ReportAnswer& answer);
[[nodiscard]] ReportAnswer decode_report_answer(std::string_view text);
[[nodiscard]] std::string encode(const ReportNews& news);
[[nodiscard]] ReportNews decode_report_news(std::string_view text);
/// @}

/// The name under which process `pid` writes an output until it is complete: that of OutputFile.
[[nodiscard]] std::filesystem::path unfinished_output(const std::filesystem::path& output, pid_t pid);

}  // namespace palpate
