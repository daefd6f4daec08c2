#include "loaders/tract/trk_reader.h"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/file_numbers.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/trk_header.h"
#include "loaders/tract/tract_loader.h"

namespace palpate {
namespace {

/// Which axis of the head an axis of voxels runs along (0 right, 1 front, 2 up), and whether towards R, A, S.
struct AxisLetter {
  int world = 0;
  bool positive = true;
};
using Order = std::array<AxisLetter, 3>;

/// "LPS" -> the axes it names; none where it does not name three different ones.
std::optional<Order> order_of(std::string_view letters) {
  static constexpr std::string_view kUp = "RAS", kDown = "LPI";
  Order order;
  unsigned seen = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t up = kUp.find(letters[axis]), down = kDown.find(letters[axis]);
    if (up == std::string_view::npos && down == std::string_view::npos) return {};
    order[axis] = {static_cast<int>(up != std::string_view::npos ? up : down), up != std::string_view::npos};
    seen |= 1U << static_cast<unsigned>(order[axis].world);
  }
  if (seen != 7U) return {};
  return order;
}

/// The axes of the head that those of a matrix lie nearest to: of all ways to pair them, the one with the
/// largest sum of squared cosines.
Order nearest_order(const Mat3& axes) {
  static constexpr std::array<std::array<int, 3>, 6> kWays{
      {{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  double best = -1.0;
  Order order;
  for (const auto& way : kWays) {
    double sum = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double cosine = glm::normalize(axes[axis])[way[as_size(axis)]];
      sum += cosine * cosine;
    }
    if (sum <= best) continue;
    best = sum;
    for (std::size_t axis = 0; axis < 3; ++axis)
      order[axis] = {way[axis], axes[static_cast<int>(axis)][way[axis]] > 0.0};
  }
  return order;
}

class TrkReader {
 public:
  TrkReader(const std::string& file, std::string_view bytes, std::vector<std::string>& notes)
      : file_(file), bytes_(bytes), notes_(notes) {}

  Tractogram read() {
    read_header();
    read_lines();
    return std::move(lines_);
  }

 private:
  template <typename T>
  T field(std::size_t at) const {
    return number_at<T>(bytes_, at, big_endian_);
  }

  [[noreturn]] void refuse(const std::string& place, const std::string& found,
                           const std::string& expected = "",
                           const std::string& remedy = kDamagedTracts) const {
    throw input_error({file_, place, found, expected, remedy});
  }

  void read_header() {
    if (bytes_.size() < sizeof(TrkHeader)) {
      refuse("header", "has " + std::to_string(bytes_.size()) + " bytes", std::to_string(sizeof(TrkHeader)));
    }
    constexpr std::int32_t kSize = sizeof(TrkHeader);
    constexpr std::size_t kSizeAt = offsetof(TrkHeader, hdr_size);
    big_endian_ = number_at<std::int32_t>(bytes_, kSizeAt, true) == kSize;
    if (field<std::int32_t>(kSizeAt) != kSize)
      refuse("header", "does not state its size, 1000, in any byte order");
    read_columns(offsetof(TrkHeader, n_scalars), offsetof(TrkHeader, scalar_name), "scalar",
                 lines_.of_points);
    read_columns(offsetof(TrkHeader, n_properties), offsetof(TrkHeader, property_name), "property",
                 lines_.of_lines);
    place_voxels();
  }

  /// Names of 20 characters. nibabel writes a number of several components as "name", a zero byte and their
  /// count; the names that would follow are then empty.
  void read_columns(std::size_t count_at, std::size_t names_at, const std::string& what,
                    std::vector<Tractogram::Column>& columns) const {
    const int count = field<std::int16_t>(count_at);
    if (count < 0) refuse("header", "has " + std::to_string(count) + " numbers for each " + what);
    constexpr std::size_t kNames = 10, kLength = 20;
    const auto wanted = as_size(count);
    for (std::size_t n = 0; n < kNames && columns.size() < wanted; ++n) {
      const std::string_view entry = bytes_.substr(names_at + n * kLength, kLength);
      const std::string name(entry.substr(0, entry.find('\0')));
      if (name.empty()) continue;
      int components = 1;
      for (std::size_t c = name.size() + 1; c < kLength && entry[c] >= '0' && entry[c] <= '9'; ++c)
        components = (c == name.size() + 1 ? 0 : 10 * components) + (entry[c] - '0');
      for (int c = 1; c <= components && columns.size() < wanted; ++c) {
        columns.push_back({.name = components > 1 ? name + " " + std::to_string(c) : name, .values = {}});
      }
    }
    while (columns.size() < wanted)
      columns.push_back({.name = what + " " + std::to_string(columns.size() + 1), .values = {}});
  }

  /// Finds the matrix and shift that take stored positions to RAS+ millimetres.
  void place_voxels() {
    TractogramImage image;
    Vec3 size{0.0};
    Index3 count{0};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = as_size(axis);
      size[axis] = field<float>(offsetof(TrkHeader, voxel_size) + a * sizeof(float));
      count[axis] = field<std::int16_t>(offsetof(TrkHeader, dim) + a * sizeof(std::int16_t));
      if (!(size[axis] > 0.0) || !std::isfinite(size[axis]))
        refuse("header, voxel_size", "is " + short_number(size[axis]), "sizes above zero");
      if (count[axis] < 0) refuse("header, dim", "is negative");
    }
    std::string letters(bytes_.substr(offsetof(TrkHeader, voxel_order), 3));
    if (letters[0] == '\0') {
      letters = "LPS";  // TrackVis's own default
      notes_.emplace_back("the header states no voxel_order: LPS, TrackVis's own");
    }
    const auto order = order_of(letters);
    if (!order) refuse("header, voxel_order", "names no three axes of the head", "RAS, LPS, …");

    const auto entry = [this](std::size_t row, std::size_t column) {
      return static_cast<double>(
          field<float>(offsetof(TrkHeader, vox_to_ras) + (4 * row + column) * sizeof(float)));
    };
    const bool placed = entry(3, 3) != 0.0 && field<std::int32_t>(offsetof(TrkHeader, version)) >= 2;
    if (placed) {
      for (std::size_t row = 0; row < 3; ++row) {
        for (std::size_t column = 0; column < 3; ++column)
          image.axes[static_cast<int>(column)][static_cast<int>(row)] = entry(row, column);
        image.origin[static_cast<int>(row)] = entry(row, 3);
      }
    } else {
      image.axes = Mat3{0.0};
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const int a = static_cast<int>(axis);
        image.axes[a][(*order)[axis].world] = (*order)[axis].positive ? size[a] : -size[a];
      }
      notes_.push_back(
          "WARNING: the file does not say where its image lies (vox_to_ras): its first voxel is put at the "
          "origin, with axes to " +
          letters);
    }
    for (int axis = 0; axis < 3 && placed; ++axis) {
      constexpr double kRounding = 1e-2;
      const double step = glm::length(image.axes[axis]);
      if (std::abs(step - size[axis]) > kRounding * step && std::isfinite(step)) {
        notes_.push_back("WARNING: voxel_size is " + short_number(size[axis]) + " mm along axis " +
                         std::to_string(axis + 1) + ", but vox_to_ras has " + short_number(step) +
                         " mm: tracts may be " + short_number(step / size[axis]) + " times too long");
      }
    }
    check_axes(image);

    // Equation (2): row b of `turn` takes u to v_b.
    const Order own = nearest_order(image.axes);
    Mat3 turn{0.0};
    Vec3 shift{0.0};
    for (std::size_t b = 0; b < 3; ++b) {
      for (std::size_t a = 0; a < 3; ++a) {
        if ((*order)[a].world != own[b].world) continue;
        const int column = static_cast<int>(a), row = static_cast<int>(b);
        const bool same = (*order)[a].positive == own[b].positive;
        turn[column][row] = same ? 1.0 : -1.0;
        shift[row] = same ? 0.0 : count[column] - 1.0;
        image.voxels[row] = count[column];
      }
    }
    if (turn != Mat3{1.0}) {
      const bool exchanged = turn[0][0] == 0.0 || turn[1][1] == 0.0 || turn[2][2] == 0.0;
      notes_.push_back(
          "positions are stored along " + letters +
          ", other axes than those of the file's image: turned to them" +
          (exchanged ? " (the header contradicts itself; nibabel lays such tracts elsewhere)" : ""));
    }
    const Mat3 by_size{Vec3{1.0 / size.x, 0.0, 0.0}, Vec3{0.0, 1.0 / size.y, 0.0},
                       Vec3{0.0, 0.0, 1.0 / size.z}};
    world_from_stored_ = image.axes * turn * by_size;
    origin_ = image.origin + image.axes * (shift - turn * Vec3{0.5});
    lines_.image = image;
  }

  void check_axes(const TractogramImage& image) const {
    double scale = 0.0;
    bool finite = true;
    for (int axis = 0; axis < 3; ++axis) {
      const double length = glm::length(image.axes[axis]);
      scale = axis == 0 ? length : scale * length;
      finite = finite && std::isfinite(length) && std::isfinite(image.origin[axis]);
    }
    constexpr double kFlat = 1e-6;  // of the volume that axes at right angles would span
    if (!finite || !(std::abs(glm::determinant(image.axes)) > kFlat * scale))
      refuse("header, vox_to_ras", "does not span space", "three axes");
  }

  void read_lines() {
    const std::int32_t claimed = field<std::int32_t>(offsetof(TrkHeader, n_count));
    if (claimed < 0) refuse("header, n_count", "is " + std::to_string(claimed));
    const std::size_t row = sizeof(float) * (3 + lines_.of_points.size());
    const std::size_t properties = sizeof(float) * lines_.of_lines.size();
    at_ = sizeof(TrkHeader);
    lines_.points.reserve((bytes_.size() - at_) / row);
    // A count of zero means that it was not known when the header was written.
    while (claimed > 0 ? lines_.line_count() < as_size(claimed) : at_ < bytes_.size()) {
      const std::string place = "line " + std::to_string(lines_.line_count() + 1);
      const std::size_t start = at_;
      const bool counted_points = bytes_.size() - at_ >= sizeof(std::int32_t);
      const std::int32_t points = counted_points ? field<std::int32_t>(at_) : 0;
      if (counted_points) at_ += sizeof(std::int32_t);
      const std::size_t left = bytes_.size() - at_;
      const bool whole =
          counted_points && left >= properties && as_size(std::max(0, points)) <= (left - properties) / row;
      if (points < 0 || (!whole && lines_.line_count() == 0)) {
        refuse(place, "claims " + std::to_string(points) + " points",
               "at most " + std::to_string(left < properties ? 0 : (left - properties) / row));
      }
      if (!whole) {
        at_ = bytes_.size();
        notes_.push_back("WARNING: the file is cut off: it ends " +
                         (start == at_ ? "after line " + std::to_string(lines_.line_count())
                                       : "within line " + std::to_string(lines_.line_count() + 1) +
                                             ", which is left out") +
                         (claimed > 0 ? "; its header counts " + std::to_string(claimed) : ""));
        return;
      }
      for (std::int32_t p = 0; p < points; ++p) read_point(place);
      for (auto& column : lines_.of_lines) column.values.push_back(next_number());
      lines_.starts.push_back(lines_.points.size());
    }
    if (at_ < bytes_.size())
      notes_.push_back(counted(bytes_.size() - at_, "byte") + " behind the last line left unread");
  }

  void read_point(const std::string& place) {
    Vec3 p{0.0};
    for (int axis = 0; axis < 3; ++axis) p[axis] = next_number();
    const Vec3f x{world_from_stored_ * p + origin_};
    if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z))
      refuse(place, "has a point that is not finite");
    lines_.points.push_back(x);
    for (auto& column : lines_.of_points) column.values.push_back(next_number());
  }

  float next_number() {
    const float value = field<float>(at_);
    at_ += sizeof(float);
    return value;
  }

  const std::string& file_;
  std::string_view bytes_;
  std::vector<std::string>& notes_;
  Tractogram lines_;
  Mat3 world_from_stored_{1.0};
  Vec3 origin_{0.0};
  std::size_t at_ = 0;  ///< the next byte
  bool big_endian_ = false;
};

}  // namespace

Tractogram read_trk(const std::string& file, std::string_view bytes, std::vector<std::string>& notes) {
  return TrkReader(file, bytes, notes).read();
}

}  // namespace palpate
