/// Appended data of a VTK XML file, packed by zlib in blocks (https://docs.vtk.org, "VTK XML formats"): before each array
/// stand the counts of blocks, of bytes in a block and in the last one where that is not full, and the packed bytes of each.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate {

class PackedAppendix {
 public:
  /// The element of an array, which is packed behind those before. @param type "Float64".
  [[nodiscard]] std::string declare(const char* type, std::string_view name, int components,
                                    std::span<const std::byte> array);
  template <typename T>
  [[nodiscard]] std::string declare(const char* type, std::string_view name, int components,
                                    const std::vector<T>& values) {
    return declare(type, name, components, std::as_bytes(std::span(values)));
  }
  [[nodiscard]] const std::string& bytes() const noexcept { return bytes_; }

 private:
  std::string bytes_;
};

}  // namespace palpate
