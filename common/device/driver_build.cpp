#include "common/device/driver_link.h"

namespace palpate {

const char* driver_build() noexcept { return PALPATE_DRIVER_BUILD; }

}  // namespace palpate
