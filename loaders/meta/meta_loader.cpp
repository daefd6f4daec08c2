#include "loaders/meta/meta_loader.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <limits>
#include <optional>
#include <type_traits>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/array_type.h"
#include "common/load/find_format.h"
#include "common/load/gzip_head.h"
#include "common/load/image/length_unit.h"
#include "common/load/volume_block.h"
#include "common/load/voxel_bytes.h"
#include "loaders/meta/meta_header.h"

namespace palpate {
namespace {

constexpr std::size_t kMostHeaderBytes = std::size_t{4} << 20;  // with a long list of files

/// The number that a word of text is, as the type that the header names; none where that does not hold it.
template <typename T>
std::optional<T> text_number(std::string_view word) {
  if constexpr (std::is_integral_v<T>) {
    if (const auto whole = parsed<T>(word)) return whole;
  }
  const auto found = number(word);
  if (!found) return std::nullopt;
  if constexpr (std::is_integral_v<T>) {
    const bool held = *found == std::floor(*found) &&
                      *found >= static_cast<double>(std::numeric_limits<T>::lowest()) &&
                      *found < static_cast<double>(std::numeric_limits<T>::max());
    if (!held) return std::nullopt;
  }
  return static_cast<T>(*found);
}

class MetaLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    if (request.files.size() > 1)
      throw input_error({request.files[1].string(), "", "is a second MetaImage", "one file"});
    file_ = request.files.front().string();
    FileInfo info;
    read_header(info);
    place(info);
    describe(info);
    info.blocks.push_back(describe_image(topology_, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    return read_image(topology_, array_.name, names, [&] { return values(step); });
  }

 private:
  // Relative names start from the header's folder.
  [[nodiscard]] std::string beside(const std::string& name) const {
    return (std::filesystem::path(file_).parent_path() / name).string();
  }
  [[nodiscard]] std::uint64_t size_of(const std::string& name) const {
    try {
      return read_head(beside(name), 0).file_size;
    } catch (const Error& error) {
      throw input_error({file_, "ElementDataFile", error.what()});
    }
  }

  void read_header(FileInfo& info) {
    const HeadOfFile head = read_head(file_, kMostHeaderBytes);
    header_ = read_meta_header(head.bytes);
    std::error_code ignored;
    if (header_.piece_count > 0 && !header_.data_file.empty()) {
      const bool literal = std::filesystem::exists(beside(header_.data_file), ignored);
      if (literal) header_.pieces.clear(), header_.piece_count = 0;
    }
    if (!header_.problem.empty())
      throw input_error({file_, "header", header_.problem, "", "the file may be damaged"});
    if (header_.piece_count > 0) return check_pieces(info);
    const bool local = header_.data_file.empty();
    const std::uint64_t there = local ? head.file_size : size_of(header_.data_file);
    voxels_at_ = local ? header_.header_bytes : 0;
    if (header_.skip > 0) {
      voxels_at_ = static_cast<std::uint64_t>(header_.skip);  // from the start of the file, as MetaIO counts
      if (local && voxels_at_ < header_.header_bytes) {
        throw input_error({file_, "header",
                           "'HeaderSize' is " + std::to_string(header_.skip) + ", within the header itself",
                           "at least its " + std::to_string(header_.header_bytes) + " bytes",
                           "leave HeaderSize out where the voxels follow the header"});
      }
    }
    const std::uint64_t available = there - std::min(there, voxels_at_);
    take_long(available, info.notes);
    if (const std::string problem = meta_size_problem(header_, available); !problem.empty())
      throw input_error({file_, "", problem, "", "the file may be truncated"});
    if (!header_.binary) {
      const std::string note = text_end_note(local ? file_ : beside(header_.data_file));
      if (!note.empty()) info.notes.push_back(note);
      return;
    }
    if (header_.compressed) {
      const bool same = header_.compressed_bytes == 0 || header_.compressed_bytes == available;
      if (!same) {
        info.notes.push_back("CompressedDataSize is " + std::to_string(header_.compressed_bytes) +
                             ", and there are " + std::to_string(available) +
                             " bytes: the packed data say where they end");
      }
      return;
    }
    const std::uint64_t behind = available - header_.bytes();
    if (header_.skip < 0) {
      voxels_at_ = there - header_.bytes();
      if (behind > 0) info.notes.push_back(taken_from_end_note(behind));
    } else if (behind > 0) {
      info.notes.push_back(counted(behind, "byte") + " behind the voxels left unread");
    }
  }

  /// MET_LONG has four bytes in MetaIO; some programs write those of their machine.
  void take_long(std::uint64_t available, std::vector<std::string>& notes) {
    const bool plain = header_.is_long && header_.binary && !header_.compressed && header_.skip >= 0;
    if (!plain || !meta_size_problem(header_, available / 2).empty() || available != 2 * header_.bytes())
      return;
    header_.type = header_.type == ScalarType::kInt32 ? ScalarType::kInt64 : ScalarType::kUint64;
    notes.emplace_back(
        "WARNING: numbers of type MET_LONG have 4 bytes, and there are 8 for each: taken for 8 bytes");
  }

  [[nodiscard]] std::uint64_t piece_bytes() const { return header_.bytes() / header_.piece_count; }

  /// Each piece holds as many bytes as it has to, and no others but those that HeaderSize passes over.
  void check_pieces(FileInfo& info) const {
    std::uint64_t there = 0;
    std::vector<std::uint64_t> sizes;
    for (const std::string& name : header_.pieces) {
      sizes.push_back(size_of(name));
      there += sizes.back();
    }
    const std::string problem = meta_size_problem(header_, there);
    if (!problem.empty()) throw input_error({file_, "", problem, "", "the file may be truncated"});
    const std::uint64_t wanted = piece_bytes();
    for (std::size_t i = 0; i < sizes.size(); ++i) {
      const std::uint64_t skip = header_.skip > 0 ? static_cast<std::uint64_t>(header_.skip) : 0;
      const bool right = sizes[i] >= wanted && (header_.skip < 0 || sizes[i] - wanted == skip);
      if (right) continue;
      throw input_error(
          {file_, "ElementDataFile", header_.pieces[i] + " has " + std::to_string(sizes[i]) + " bytes",
           std::to_string(wanted) + " of voxels behind " + std::to_string(skip) + " of HeaderSize",
           "HeaderSize = -1 takes the last ones of each file"});
    }
    if (header_.skip < 0 && there > wanted * sizes.size())
      info.notes.push_back(taken_from_end_note(there - wanted * sizes.size()));
  }

  /// Numbers that the header states along the axes, or `otherwise`.
  [[nodiscard]] double stated(const std::vector<double>& numbers, int at, double otherwise) const {
    return numbers.empty() ? otherwise : numbers[as_size(at)];
  }

  void place(FileInfo& info) {
    if (header_.spaced_by_size) info.notes.emplace_back("no ElementSpacing: spacing taken from ElementSize");
    const int axes = std::min(3, header_.axes);
    topology_ = {};
    topology_.points = Index3{1};
    for (int axis = 0; axis < axes; ++axis) {
      topology_.points[axis] = static_cast<int>(header_.size[as_size(axis)]);
      topology_.origin[axis] = stated(header_.offset, axis, 0.0);
      Vec3 direction{0.0};
      for (int row = 0; row < axes; ++row)
        direction[row] = stated(header_.matrix, axis * header_.axes + row, axis == row ? 1.0 : 0.0);
      topology_.axes[axis] = stated(header_.spacing, axis, 1.0) * direction;
    }
    const double steps =
        glm::length(topology_.axes[0]) * glm::length(topology_.axes[1]) * glm::length(topology_.axes[2]);
    constexpr double kFlat = 1e-9;
    if (!(std::abs(glm::determinant(topology_.axes)) > kFlat * steps) || !std::isfinite(steps) ||
        !is_finite(topology_.origin)) {
      throw input_error({file_, "header", "its axes span no volume", "three independent, finite directions"});
    }
    info.anatomical = !header_.orientation.empty() && header_.orientation.find('?') == std::string::npos;
    if (info.anatomical) {
      const Vec3 ras_from_lps{-1.0, -1.0, 1.0};
      topology_.origin *= ras_from_lps;
      for (int axis = 0; axis < 3; ++axis) topology_.axes[axis] *= ras_from_lps;
      info.notes.emplace_back(
          "MetaImage for a patient: taken for LPS, as ITK writes it, and turned into RAS");
    } else {
      info.notes.emplace_back("no AnatomicalOrientation: coordinates as they are, no orientation known");
    }
    take_unit(info);
    if (header_.intensity_function)
      info.notes.emplace_back("values as stored: the header's intensity function is not applied");
    for (std::uint64_t t = 0; t < header_.size[3] && header_.size[3] > 1; ++t)
      info.times.push_back(stated(header_.offset, 3, 0.0) +
                           stated(header_.spacing, 3, 1.0) * static_cast<double>(t));
  }

  /// Places of a patient become millimetres; others stay in the unit that the header names.
  void take_unit(FileInfo& info) {
    if (header_.units.empty() || header_.units == "?") return;
    info.units = "coordinates in " + header_.units;
    if (!info.anatomical) return;
    const auto length = millimetres_in(header_.units);
    info.units = "coordinates in mm";
    if (!length) {
      info.notes.push_back("WARNING: the header's unit of length, '" +
                           printable(header_.units.substr(0, 40)) + "', is not known: taken for mm");
    } else if (*length != 1.0) {
      topology_.origin *= *length;
      topology_.axes *= *length;
      info.notes.push_back("coordinates turned from " + header_.units + " into mm");
    }
  }

  void describe(FileInfo& info) {
    array_.association = Association::kPoint;
    array_.type = header_.type;
    array_.components = header_.channels;
    array_.tuples = header_.voxels();
    const bool bytes = array_.type == ScalarType::kUint8;
    array_.name = "scalars";
    if (array_.components > 1) array_.name = array_.components == 3 ? "vectors" : "components";
    if (bytes && (array_.components == 3 || array_.components == 4)) {
      array_.name = kColorArray;
    } else if (array_.components == 3) {
      info.notes.emplace_back("vectors as stored: the header does not say along which axes");
    }
  }

  DataArray values(std::size_t step) const {
    VoxelMemory memory(header_.voxels() * header_.bytes_per_voxel());
    if (header_.piece_count > 0) {
      read_pieces(step, memory.bytes());
    } else {
      read_whole(step, memory.bytes());
    }
    if (header_.binary) to_native(memory.bytes(), byte_size(header_.type), header_.big_endian);
    return std::move(memory).finish(file_, array_.type, array_.components);
  }

  void read_pieces(std::size_t step, std::span<std::byte> out) const {
    const std::uint64_t bytes = piece_bytes();
    const std::uint64_t first = step * out.size(), last = first + out.size();
    for (std::uint64_t p = first / bytes; p * bytes < last; ++p) {
      const std::string name = beside(header_.pieces[p]);
      const MappedFile mapped(name);
      const std::string_view text = mapped.text();
      const std::uint64_t skip = header_.skip < 0 ? text.size() - std::min<std::uint64_t>(text.size(), bytes)
                                                  : static_cast<std::uint64_t>(header_.skip);
      const std::uint64_t there = text.size() - std::min<std::uint64_t>(text.size(), skip);
      check_voxel_counts(name, {.wanted = bytes, .found = there});
      const std::uint64_t from = std::max(first, p * bytes), to = std::min(last, (p + 1) * bytes);
      std::memcpy(out.data() + (from - first), text.data() + skip + (from - p * bytes), to - from);
    }
  }

  void read_whole(std::size_t step, std::span<std::byte> out) const {
    const std::string name = header_.data_file.empty() ? file_ : beside(header_.data_file);
    const MappedFile mapped(name);
    const std::string_view text =
        mapped.text().substr(std::min<std::size_t>(voxels_at_, mapped.text().size()));
    const std::uint64_t first = step * out.size();
    if (!header_.binary) return read_text(text, step, out);
    if (!header_.compressed) {
      check_voxel_counts(name, {.wanted = header_.bytes(), .found = text.size()});
      std::memcpy(out.data(), text.data() + first, out.size());
      return;
    }
    std::vector<std::byte> all;  // of all steps, where there are several
    if (header_.size[3] > 1) all.resize(header_.bytes());
    const Unpacked unpacked = unpack(text, all.empty() ? out : std::span(all));
    check_voxel_counts(name, {.wanted = header_.bytes(), .unpacked = unpacked.bytes});
    if (unpacked.more || !unpacked.ended) {
      throw input_error({name, "voxels",
                         unpacked.more ? "unpack to more bytes" : "are packed data without an end",
                         std::to_string(header_.bytes()) + " by the header", "the file may be damaged"});
    }
    if (!all.empty()) std::memcpy(out.data(), all.data() + first, out.size());
  }

  void read_text(std::string_view text, std::size_t step, std::span<std::byte> out) const {
    with_type(header_.type, [&]<typename T>(T) {
      const std::uint64_t count = header_.bytes() / sizeof(T), first = step * (out.size() / sizeof(T));
      std::uint64_t found = 0;
      constexpr std::string_view kBlanks = " \t\r\n";
      std::size_t at = text.find_first_not_of(kBlanks);
      for (; at != std::string_view::npos && found < count; ++found) {
        const std::size_t end = std::min(text.find_first_of(kBlanks, at), text.size());
        const auto value = text_number<T>(text.substr(at, end - at));
        if (!value)
          throw input_error({file_, "value " + std::to_string(found + 1),
                             "is '" + std::string(text.substr(at, std::min<std::size_t>(end - at, 40))) + "'",
                             std::string("a number of type ") + name_of(header_.type)});
        if (found >= first && (found - first + 1) * sizeof(T) <= out.size())
          std::memcpy(out.data() + (found - first) * sizeof(T), &*value, sizeof(T));
        at = text.find_first_not_of(kBlanks, end);
      }
      check_voxel_counts(file_, {.wanted = header_.bytes(), .found = found * sizeof(T)});
      // What stands behind the numbers is nobody's business, unless it is one more.
      const bool more =
          at != std::string_view::npos &&
          text_number<T>(text.substr(at, std::min(text.find_first_of(kBlanks, at), text.size()) - at));
      if (more) {
        throw input_error({file_, "",
                           "has more numbers as text than the " + std::to_string(count) + " of its header",
                           "", "one too many moves all behind it"});
      }
    });
  }

  std::string file_;
  MetaHeader header_;
  std::uint64_t voxels_at_ = 0;  ///< in their file
  UniformTopology topology_;
  ArrayInfo array_;
};

}  // namespace

std::unique_ptr<Loader> make_meta_loader() { return std::make_unique<MetaLoader>(); }

}  // namespace palpate
