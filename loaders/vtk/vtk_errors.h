/// VTK's error messages, collected instead of printed: what a reader complains about makes the reading fail.
#pragma once

#include <string>

namespace palpate {

/// While it lives, VTK's messages go to it. One at a time in a process.
class VtkErrors {
 public:
  VtkErrors();
  ~VtkErrors();
  VtkErrors(const VtkErrors&) = delete;
  VtkErrors& operator=(const VtkErrors&) = delete;

  /// @throws Error (bad input) naming `file` with the first error since the last call, on one line.
  void check(const std::string& file);
};

}  // namespace palpate
