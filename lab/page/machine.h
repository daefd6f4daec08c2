/// The machine that a report was made on: times mean nothing without it.
#pragma once

#include <cstdint>
#include <string>

namespace palpate {

struct Machine {
  std::string processor;  ///< "unknown processor" where the system does not say
  int cores = 0;          ///< that this process may use
  std::uint64_t memory_bytes = 0;
  std::string system;   ///< distribution and kernel
  std::string build;    ///< compiler and build type
  std::string version;  ///< of this program
};

[[nodiscard]] Machine this_machine();

}  // namespace palpate
