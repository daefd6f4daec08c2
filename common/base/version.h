/// The program's version and how it was built.
#pragma once

#include <string>

namespace palpate {

[[nodiscard]] std::string version();  ///< "0.1.0"
/// "PROGRAM (Palpate) 0.1.0"
[[nodiscard]] std::string version_text(const std::string& program);
/// Compiler, build type and sanitizers: "GCC 12.2.0, Release".
[[nodiscard]] std::string build_text();

}  // namespace palpate
