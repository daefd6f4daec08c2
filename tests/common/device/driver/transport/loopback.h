/// A socket that listens at this machine alone, at a port of the system's choice.
#pragma once

#include <cstdint>

namespace palpate::test {

/// @param port is given it. @return the socket, which the caller closes.
int listen_on_loopback(std::uint16_t& port);

}  // namespace palpate::test
