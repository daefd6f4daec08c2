/// The file formats that are read: one row each in formats.def, from which everything about them follows.
///
/// A format is found by what is in a file; its ending only breaks ties. Pure: nothing here opens a file
/// (find_format.h does).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace palpate {

enum class Format : std::uint8_t {
#define PALPATE_FORMAT(id, ...) id,
#include "common/load/formats.def"
#undef PALPATE_FORMAT
};

/// What is known of a file before any loader sees it.
struct FileHead {
  std::span<const std::byte> bytes;  ///< the first kSniffBytes, or all
  std::span<const std::byte> tail;   ///< the last kPlot3dTailBytes, or all
  std::uint64_t file_size = 0;
  std::string_view ending;  ///< lower case with its dot: ".vtk", ".gz"
};
/// How many bytes from the start of a file sniff() looks at.
inline constexpr std::size_t kSniffBytes = std::size_t{64} << 10;

/// How sure a row is of a file that it recognises. All rows with a mark are asked before any other.
enum class Evidence : std::uint8_t {
  kMark,  ///< bytes at a fixed place, or words that no other kind of file has
  kWords  ///< words or numbers that files of other kinds might hold too
};

/// A format: all that the explorers know of it.
struct FormatRow {
  Format format{};
  std::string_view name;     ///< "legacy VTK", as `info` shows it
  std::string_view helper;   ///< the program that reads it: "palpate-load-vtk"
  std::string_view endings;  ///< customary ones, lower case, separated by blanks: ".nrrd .nhdr"
  /// What its files may hold, separated by blanks: `vectors`, `scalars`, `tensors` (or what tensors are fitted
  /// to), `tracts`, `hearts`. An explorer that READS one of them is built with the helper.
  std::string_view holds;

  std::string_view starts;  ///< every file begins so; empty: `recognise` says
  /// Whether a file is of this format; null: `starts` says. A row with neither is never found by content.
  bool (*recognise)(const FileHead& head, const FormatRow& row) = nullptr;
  Evidence evidence = Evidence::kMark;
  /// Whether a folder is of this format; null: none is.
  bool (*recognise_folder)(const std::filesystem::path& folder) = nullptr;
  std::string_view folder;  ///< what such a folder is of: "an OpenFOAM case"
  /// A file with one of the endings marks the folder around it, whatever it holds; this must stand there.
  std::string_view marks;

  bool gzip = false;    ///< its files may be gzipped
  bool beside = false;  ///< a file leads to others beside it, whose sizes count as its own
  bool curved = false;  ///< elements are sampled: the reader's needs grow with LoadRequest::refine
  bool sparse = false;  ///< the arrays may be far larger than the file
};

/// All formats, in the order in which they are tried.
[[nodiscard]] std::span<const FormatRow> format_rows() noexcept;
[[nodiscard]] const FormatRow& row_of(Format format) noexcept;

/// Whether `ending` (".nrrd") is one of the row's.
[[nodiscard]] bool names_ending(const FormatRow& row, std::string_view ending);
/// Whether the row recognises a file, other rows left aside.
[[nodiscard]] bool recognises(const FormatRow& row, const FileHead& head);

struct Sniffed {
  std::optional<Format> format;
  std::string found;   ///< where there is no format: what the file looks like ("a gzip file")
  std::string remedy;  ///< and what could be done
};
[[nodiscard]] Sniffed sniff(const FileHead& head);

}  // namespace palpate
