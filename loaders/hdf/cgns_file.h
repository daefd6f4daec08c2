/// The nodes of a CGNS file in HDF5, for what looks at it before VTK's reader does.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

class CgnsFile {
 public:
  explicit CgnsFile(const std::string& file);
  ~CgnsFile();
  CgnsFile(const CgnsFile&) = delete;
  CgnsFile& operator=(const CgnsFile&) = delete;

  /// HDF5's number of the file; negative where it could not be opened.
  [[nodiscard]] std::int64_t id() const noexcept { return file_; }
  [[nodiscard]] bool has(const std::string& node) const;
  /// Whether a node lies in another place, or another file.
  [[nodiscard]] bool is_link(const std::string& node) const { return has(node + "/ link"); }
  [[nodiscard]] std::string label(const std::string& node) const;
  /// How many numbers a node holds.
  [[nodiscard]] std::uint64_t count(const std::string& node) const;
  /// Along how many axes they stand; 0 where there are none.
  [[nodiscard]] int axes(const std::string& node) const;
  /// The whole numbers of a node; empty where there are more than `most`.
  [[nodiscard]] std::vector<std::int64_t> numbers(const std::string& node, std::uint64_t most = 512) const;
  /// The names below a node, in alphabetical order.
  [[nodiscard]] std::vector<std::string> children(const std::string& node) const;
  /// The characters of a node: few of them.
  [[nodiscard]] std::string word(const std::string& node) const;

 private:
  std::int64_t file_;
};

}  // namespace palpate
