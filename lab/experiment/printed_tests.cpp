#include "lab/experiment/printed_tests.h"

#include <cmath>

#include "common/base/text.h"

namespace palpate {
namespace {

constexpr PrintedTests kPrinted[]{
    {"advection2d", "12.25, p < 0.001", "8.75, p < 0.001", "6.19, p < 0.001", "2.65, p < 0.016"},
    {"tracing2d", "11.14, p < 0.001", "3.17, p < 0.005", "6.93, p < 0.001", "0.127, p < 0.9"},
    {"advection3d", "8.12, p < 0.001", "9.77, p < 0.001", "3.76, p < 0.001", "2.5, p < 0.022"},
    {"tracing3d", "4.76, p < 0.001", "3.1, p < 0.006", "8.75, p < 0.001", "1.58, p < 0.13"}};

}  // namespace

std::string printed(const std::string& task, const char* const PrintedTests::*member) {
  for (const PrintedTests& row : kPrinted) {
    if (task == row.task) return row.*member;
  }
  return "-";
}

double printed_effect(const std::string& task, const char* const PrintedTests::*member) {
  const std::string text = printed(task, member);
  return number(text.substr(0, text.find(','))).value_or(NAN) / std::sqrt(20.0);
}

}  // namespace palpate
