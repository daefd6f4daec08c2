/// What is thrown about a message that breaks the rules of protocol.h.
#pragma once

#include <stdexcept>

namespace palpate {

class ProtocolError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace palpate
