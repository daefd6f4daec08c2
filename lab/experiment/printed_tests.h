/// What Ikits 2006 prints of its four tasks, tables 7.1 and 7.2: the only numbers that there are of figures 7.4 and 7.5,
/// which are pictures.
#pragma once

#include <string>

namespace palpate {

/// t(19) of 20 participants, without signs, and p: "12.25, p < 0.001".
struct PrintedTests {
  const char* task;
  const char* error_mean;
  const char* error_deviation;
  const char* time_mean;
  const char* time_deviation;
};

/// "-" for a task that the reference does not have.
[[nodiscard]] std::string printed(const std::string& task, const char* const PrintedTests::*member);

/// d_z = t / sqrt(20); NaN for such a task.
[[nodiscard]] double printed_effect(const std::string& task, const char* const PrintedTests::*member);

}  // namespace palpate
