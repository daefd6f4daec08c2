/// The appended data of a VTK XML file: https://docs.vtk.org, "VTK XML formats". Raw bytes, each array behind
/// its size in 64 bits.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// Declares the arrays one after another, each of which says where its bytes begin.
class VtpAppendix {
 public:
  /// The element of an array. @param type "Float32". @param bytes that it will take.
  [[nodiscard]] std::string declare(const char* type, std::string_view name, int components,
                                    std::uint64_t bytes) {
    std::string text = std::string("<DataArray type=\"") + type + "\" Name=\"" + std::string(name) +
                       "\" NumberOfComponents=\"" + std::to_string(components) +
                       "\" format=\"appended\" offset=\"" + std::to_string(offset_) + "\"/>\n";
    offset_ += sizeof(std::uint64_t) + bytes;
    return text;
  }

 private:
  std::uint64_t offset_ = 0;
};

}  // namespace palpate
