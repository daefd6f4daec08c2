#include "common/cli/json/json_output.h"

#include "common/base/version.h"
#include "common/cli/json/json_parts.h"

namespace palpate {

std::string error_json(const std::string& line, int exit_code) {
  return json_text({{"error", line}, {"exit", exit_code}});
}

std::string report_summary_json(const std::string& folder, std::size_t rows, std::size_t failed_cases,
                                double seconds) {
  return json_text({{"out", folder},
                    {"work_precision_rows", rows},
                    {"stability_cases_failed", failed_cases},
                    {"seconds", seconds},
                    {"version", version()}});
}

}  // namespace palpate
