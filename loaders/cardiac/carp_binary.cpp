#include "loaders/cardiac/carp_binary.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "loaders/cardiac/packed_file.h"

namespace palpate {
namespace {

constexpr std::size_t kHeader = 1024, kWord = 4;  // [bytes]

/// The numbers of a file behind its header.
class Numbers {
 public:
  /// @param counts the words of the header before that of the byte order.
  Numbers(std::string file, std::size_t counts) : file_(std::move(file)), in_(file_) {
    std::string header(kHeader, '\0');
    header.resize(in_.read(header.data(), header.size()));
    if (header.size() < kHeader) refuse("header", "is cut off after " + counted(header.size(), "byte"));
    const std::string text = header.substr(0, header.find_first_of(std::string_view("\0\n\r", 3)));
    const std::vector<std::string_view> found = words(text);
    for (std::size_t i = 0; i <= counts; ++i) {
      const auto value = i < found.size() ? parsed<std::uint64_t>(found[i]) : std::nullopt;
      if (!value) refuse("header", "begins with \"" + text.substr(0, 40) + "\"");
      counts_.push_back(*value);
    }
    if (counts_.back() > 1)
      refuse("header", "states the byte order " + std::to_string(counts_.back()), "0 (lowest first) or 1");
    big_endian_ = counts_.back() == 1;
    const std::uint64_t all = unpacked_bytes(file_);
    bytes_ = all > kHeader ? all - kHeader : 0;
  }

  [[nodiscard]] std::uint64_t count(std::size_t word) const { return counts_[word]; }
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Reads all that is there. @pre its size is believed.
  void read() {
    body_.resize(bytes_);
    if (in_.read(body_.data(), body_.size()) < body_.size()) refuse("", "cannot be read to its end");
  }
  template <typename T>
  [[nodiscard]] T at(std::uint64_t number) const {
    return number_at<T>(body_, number * kWord, big_endian_);
  }

  /// @throws Error (bad input) unless the file holds `count` things of `size` bytes. @param what "point".
  void expect(std::uint64_t count, std::uint64_t size, const std::string& what) const {
    const std::string promised = counted(count, what) + " as its header says";
    if (count > bytes_ / size) refuse("", "is cut off after " + counted(bytes_ / size, what), promised);
    if (bytes_ > count * size)
      refuse("", "goes on for " + counted(bytes_ - count * size, "byte") + " after " + counted(count, what),
             promised);
  }

  [[noreturn]] void refuse(const std::string& place, const std::string& found,
                           const std::string& expected =
                               "a binary file of openCARP: counts, byte order, "
                               "checksum in 1024 bytes of text") const {
    throw input_error({file_, place, found, expected});
  }

 private:
  std::string file_;
  PackedFile in_;
  std::vector<std::uint64_t> counts_;
  bool big_endian_ = false;
  std::uint64_t bytes_ = 0;  ///< behind the header
  std::string body_;
};

/// Fewest numbers that an element takes: a line with its kind and region.
constexpr std::uint64_t kLeastNumbers = 4;

/// @throws Error (bad input) where the file cannot hold them.
std::size_t believed_elements(const Numbers& file) {
  const std::uint64_t count = file.count(0);
  if (count > file.bytes() / (kLeastNumbers * kWord))
    file.refuse("header", "promises " + counted(count, "element"),
                "as many as its " + counted(file.bytes(), "byte") + " can hold: is it cut off?");
  return count;
}

}  // namespace

bool is_binary_carp(const std::string& file) {
  const std::string ending = ending_of(file);
  return ending == ".bpts" || ending == ".belem" || ending == ".blon";
}

std::vector<double> read_binary_points(const std::string& file) {
  Numbers in(file, 1);
  const std::uint64_t count = in.count(0);
  in.expect(count, 3 * kWord, "point");
  in.read();
  std::vector<double> positions(3 * count);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    positions[i] = static_cast<double>(in.at<float>(i));
    if (!std::isfinite(positions[i]))
      in.refuse("point " + std::to_string(i / 3), "has a coordinate that is not finite", "numbers");
  }
  return positions;
}

std::size_t count_binary_elements(const std::string& file) { return believed_elements(Numbers(file, 1)); }

CarpElements read_binary_elements(const std::string& file, std::size_t points) {
  Numbers in(file, 1);
  const std::size_t count = believed_elements(in);
  in.read();
  const std::uint64_t numbers = in.bytes() / kWord;
  const auto last = static_cast<std::int64_t>(points) - 1;
  CarpElements elements;
  elements.topology.offsets.push_back(0);
  std::uint64_t at = 0;
  for (std::size_t e = 0; e < count; ++e) {
    const std::string place = "element " + std::to_string(e);
    const auto cut = [&] {
      in.refuse("", "is cut off after " + counted(e, "element"),
                counted(count, "element") + " as its header says");
    };
    if (at >= numbers) cut();
    const auto kind = in.at<std::int32_t>(at++);
    const bool known =
        kind >= 0 && as_size(kind) < kCarpCells.size() && kCarpCells.at(as_size(kind)).vtk != 0;
    if (!known)
      in.refuse(
          place, "is of kind " + std::to_string(kind),
          "0 (Tt), 1 (Hx), 3 (Py), 4 (Pr), 5 (Qd), 6 (Tr) or 7 (Ln): is the byte order of the header right?");
    const CarpCell& cell = kCarpCells.at(as_size(kind));
    if (numbers - at < cell.corners + 1) cut();
    for (std::size_t n = 0; n < cell.corners; ++n) {
      const std::int64_t point = in.at<std::int32_t>(at++);
      elements.lowest = std::min(elements.lowest, point);
      elements.highest = std::max(elements.highest, point);
      const std::int64_t from_one = elements.lowest > 0 ? 1 : 0;
      if (point < 0 || elements.highest > last + from_one)
        in.refuse(place, "names point " + std::to_string(point < 0 ? point : elements.highest),
                  "points from 0 to " + std::to_string(last) + ", or from 1");
      elements.topology.connectivity.push_back(point);
    }
    elements.regions.push_back(static_cast<double>(in.at<std::int32_t>(at++)));
    elements.topology.types.push_back(cell.vtk);
    elements.topology.offsets.push_back(static_cast<std::int64_t>(elements.topology.connectivity.size()));
  }
  if (at * kWord != in.bytes())
    in.refuse(
        "", "goes on for " + counted(in.bytes() - at * kWord, "byte") + " after " + counted(count, "element"),
        counted(count, "element") + " as its header says");
  return elements;
}

Directions read_binary_directions(const std::string& file, std::size_t elements) {
  Numbers in(file, 2);
  const std::uint64_t vectors = in.count(0);
  if (vectors != 1 && vectors != 2)
    in.refuse("header", "speaks of " + counted(vectors, "direction") + " an element", "1 or 2");
  if (in.count(1) != elements)
    in.refuse("header", "speaks of " + counted(in.count(1), "element"),
              std::to_string(elements) + " as the mesh has");
  in.expect(elements, 3 * vectors * kWord, "element");
  in.read();
  Directions directions;
  for (std::uint64_t e = 0; e < elements; ++e) {
    Vec3 row[2] = {Vec3{0.0}, Vec3{0.0}};
    for (std::uint64_t n = 0; n < 3 * vectors; ++n)
      row[n / 3][static_cast<int>(n % 3)] = static_cast<double>(in.at<float>(3 * vectors * e + n));
    append_directions(std::span<const Vec3>(row, vectors), directions);
  }
  return directions;
}

}  // namespace palpate
