// What is asked of studies arrives as it was asked.
#include "common/scene/report_request.h"

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/load/helper/protocol.h"

namespace palpate::test {
namespace {

TEST(ReportRequest, CarriesTheWholeDocument) {
  ReportRequest request{.subject = "scalar", .program = "grid", .command_line = "grid report 'a;b.nhdr'"};
  Document& document = request.document;
  document.input.kind = FieldKind::kScalar;
  document.input.files = {"a;b.nhdr", "c d.nhdr"};
  document.volume.lenses = {"sphere:1,2,3,4", "box:0,0,0,1,1,1"};
  document.volume.samples = 0.1;
  document.common.seed = 77;
  document.common.force = true;
  document.output.file = "re\xffport";  // a name that is no UTF-8
  document.output.effort = "quick";
  document.given = {"lens", "samples"};
  const ReportRequest read = decode_report_request(encode(request));
  EXPECT_EQ(read.subject, "scalar");
  EXPECT_EQ(read.program, "grid");
  EXPECT_EQ(read.command_line, request.command_line);
  EXPECT_TRUE(read.document == document);
  EXPECT_EQ(read.document.input.kind, FieldKind::kScalar);
  EXPECT_EQ(read.document.input.files, document.input.files);
  EXPECT_EQ(read.document.output.file, document.output.file);
  EXPECT_EQ(read.document.given, document.given);
}

TEST(ReportRequest, RefusesWhatIsNone) {
  EXPECT_THROW((void)decode_report_request("{}"), ProtocolError);
  std::string other_row = encode(ReportRequest{.subject = "scalar", .program = "grid", .command_line = {}});
  const std::string none = "\"settings\":[]";
  ASSERT_NE(other_row.find(none), std::string::npos);
  other_row.replace(other_row.find(none), none.size(), "\"settings\":[{\"row\":100000,\"text\":[\"1\"]}]");
  EXPECT_THROW((void)decode_report_request(other_row), ProtocolError);
}

TEST(ReportRequest, AnswersComeBackAndFailuresKeepTheirCode) {
  const ReportAnswer answer = decode_report_answer(encode(ReportAnswer{.text = "a\nb\n", .json = "{}"}));
  EXPECT_EQ(answer.text, "a\nb\n");
  EXPECT_EQ(answer.json, "{}");
  const ReportNews news = decode_report_news(encode(ReportNews{.note = "field velocity", .text = {}}));
  EXPECT_EQ(news.note, "field velocity");
  EXPECT_EQ(news.text, "");
}

TEST(ReportRequest, UnfinishedOutputsAreNamedByTheirWriter) {
  EXPECT_EQ(unfinished_output("a/report/", 12), "a/.report.12.part");
  EXPECT_EQ(unfinished_output("report", 7), ".report.7.part");
}

}  // namespace
}  // namespace palpate::test
