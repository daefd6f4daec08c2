/// WebSocket and HTTP by Boost.Beast.
#pragma once

#include <memory>

#include "common/device/driver/transport/web_transport.h"

namespace palpate {

[[nodiscard]] std::unique_ptr<WebTransport> make_beast_transport();

}  // namespace palpate
