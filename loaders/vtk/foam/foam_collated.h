/// Collated cases of OpenFOAM (fileHandler collated): in processors4, or processors8_0-3 and processors8_4-7, each file
/// holds what is in the files of all these processors. OpenFOAM, decomposedBlockData.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate {

/// The files of processors that a collated one holds, each with a header of its own; empty where the text is none.
/// The first has the header of all, or the file's own says what it would.
/// @throws FoamMalformed.
[[nodiscard]] std::vector<std::string> part_foam_blocks(std::string_view text);

/// The first processor of a folder and their number, "processors8_4-7": {4, 4}; {0, 0} for other names.
[[nodiscard]] std::pair<int, int> foam_processors_of(std::string_view folder);

/// Collated folders, parted into processor0, processor1, … in a folder of temporary files, which is removed with this, and
/// when the process ends otherwise: VTK's reader wants files. Left out are those that are of no mesh and no field (uniform, lagrangian, addressing).
class FoamCollated {
 public:
  /// @throws Error (bad input) for damaged files, and where there is more than kMostBytes.
  explicit FoamCollated(const std::vector<std::filesystem::path>& collated);
  ~FoamCollated();
  FoamCollated(const FoamCollated&) = delete;
  FoamCollated& operator=(const FoamCollated&) = delete;

  static constexpr std::uintmax_t kMostBytes = std::uintmax_t{4} << 30U;

  /// By their numbers.
  [[nodiscard]] const std::vector<std::filesystem::path>& folders() const noexcept { return folders_; }

 private:
  void part(const std::filesystem::path& from);

  std::filesystem::path home_;
  int alive_ = -1;  ///< closed when this process ends: then the folder is removed
  std::vector<std::filesystem::path> folders_;
  std::uintmax_t bytes_ = 0;
};

}  // namespace palpate
