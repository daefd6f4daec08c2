#include "common/device/driver/serial_options.h"

#include "common/base/error.h"

namespace palpate {

int baud_of(std::string_view driver, const std::string& value) {
  std::string known;
  for (const int rate : serial_rates()) {
    if (value == std::to_string(rate)) return rate;
    (known += known.empty() ? "" : ", ") += std::to_string(rate);
  }
  throw usage_error(std::string(driver) + ": baud takes one of " + known + ", found '" + value + "'");
}

}  // namespace palpate
