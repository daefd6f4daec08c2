/// Options that drivers at serial lines share.
#pragma once

#include <string>
#include <string_view>

#include "common/device/driver/serial_line.h"

namespace palpate {

/// The value of `baud=`, for `driver`. @throws Error (usage), which names the rates that there are.
[[nodiscard]] int baud_of(std::string_view driver, const std::string& value);

}  // namespace palpate
