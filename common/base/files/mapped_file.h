/// A whole file as read-only memory, for checks that walk through it.
#pragma once

#include <string>
#include <string_view>

namespace palpate {

class MappedFile {
 public:
  /// @throws Error (bad input).
  explicit MappedFile(const std::string& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  [[nodiscard]] std::string_view text() const noexcept { return {data_, size_}; }

 private:
  const char* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace palpate
