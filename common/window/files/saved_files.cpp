#include "common/window/files/saved_files.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/field/grid/image_resample.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/load/write/write_annotations.h"
#include "common/load/write/write_image.h"

namespace palpate {
namespace {

/// The numbers in `Number`.
template <typename Number>
DataArray in_type(const std::vector<double>& values, ScalarType type) {
  auto numbers = std::make_shared<std::vector<Number>>();
  numbers->reserve(values.size());
  for (const double value : values) numbers->push_back(static_cast<Number>(value));
  DataArray array{.name = "scalars", .type = type, .tuples = values.size()};
  array.bytes = std::as_bytes(std::span<const Number>(*numbers));
  array.owner = std::move(numbers);
  return array;
}

/// The values in the type of the data as far as the single precision of `image` holds them, else in doubles.
DataArray as_stored(const std::vector<double>& values, const VolumeImage& image, bool& exact) {
  constexpr double kWhole = 0x1p24;  // whole numbers up to this are exact in single precision
  const bool floating = image.stored == ScalarType::kFloat32 || image.stored == ScalarType::kFloat64;
  const bool whole = !floating && std::max(-image.lowest, image.highest) < kWhole;
  exact = whole || image.stored == ScalarType::kFloat32;
  // Points without a value have no whole number.
  if (!exact || (whole && !image.all_finite)) return in_type<double>(values, ScalarType::kFloat64);
  switch (image.stored) {
    case ScalarType::kInt8:
      return in_type<std::int8_t>(values, image.stored);
    case ScalarType::kUint8:
      return in_type<std::uint8_t>(values, image.stored);
    case ScalarType::kInt16:
      return in_type<std::int16_t>(values, image.stored);
    case ScalarType::kUint16:
      return in_type<std::uint16_t>(values, image.stored);
    case ScalarType::kInt32:
      return in_type<std::int32_t>(values, image.stored);
    case ScalarType::kUint32:
      return in_type<std::uint32_t>(values, image.stored);
    case ScalarType::kInt64:
      return in_type<std::int64_t>(values, image.stored);
    case ScalarType::kUint64:
      return in_type<std::uint64_t>(values, image.stored);
    case ScalarType::kFloat32:
      return in_type<float>(values, image.stored);
    case ScalarType::kFloat64:
      break;
  }
  return in_type<double>(values, ScalarType::kFloat64);
}

}  // namespace

SavedFiles::SavedFiles(const std::filesystem::path& folder, std::string program)
    : folder_(std::filesystem::absolute(folder)), program_(std::move(program)) {}

std::filesystem::path free_place(const std::filesystem::path& folder, const std::string& stem,
                                 const std::string& ending) {
  std::filesystem::path path = folder / (stem + ending);
  for (int number = 2; std::filesystem::exists(path); ++number)
    path = folder / std::string(stem).append("-").append(std::to_string(number)).append(ending);
  return path;
}

std::filesystem::path SavedFiles::save_lines(const DrawnLines& lines, std::string& name) {
  Lines kept;
  for (const DrawnLines::Entry& entry : lines.entries()) kept.insert(entry.line);
  const bool again = std::ranges::includes(kept, in_own_file_);
  std::filesystem::path path = (folder_ / name).lexically_normal();
  if (path != own_lines_) asked_lines_ = path;
  if (!again) path = asked_lines_;
  const std::filesystem::path stem = path.stem(), ending = path.extension();
  for (int number = 2; !(again && path == own_lines_) && std::filesystem::exists(path); ++number) {
    path.replace_filename(stem.string() + "-" + std::to_string(number) + ending.string());
  }
  lines.save(path, path == own_lines_);
  own_lines_ = path;
  saved_.insert(kept.begin(), kept.end());
  in_own_file_ = std::move(kept);
  name = path.lexically_proximate(folder_).string();
  return path;
}

void SavedFiles::note_saved(const DrawnLines& lines) {
  for (const DrawnLines::Entry& entry : lines.entries()) saved_.insert(entry.line);
}

std::size_t SavedFiles::unsaved(const DrawnLines& lines) const {
  return as_size(std::ranges::count_if(
      lines.entries(), [this](const DrawnLines::Entry& entry) { return !saved_.contains(entry.line); }));
}

std::filesystem::path SavedFiles::save_transfer(const std::string& name, const Lens& appearance) const {
  std::filesystem::path path = folder_ / name;
  OutputFile file(path, false);
  file.write(appearance.regions ? regions_text(*appearance.regions)
                                : color_transfer_text(appearance.transfer.value_or(ColorTransfer())));
  file.finish();
  return path;
}

std::filesystem::path SavedFiles::save_annotations(std::span<const Annotation> annotations,
                                                   const std::string& ending) const {
  std::filesystem::path path = free_name("annotations", ending);
  write_annotations(path, annotations, false);
  return path;
}

SavedFiles::SavedRegion SavedFiles::save_region(const VolumeImage& image, const Box& region,
                                                const std::string& ending, const ImageOrigin& origin) const {
  const UniformTopology grid{.points = image.points, .origin = image.origin, .axes = image.axes};
  const auto part = points_in(grid, region);
  PALPATE_CHECK(part.has_value());
  std::vector<double> values;
  values.reserve(count_of(part->points()));
  for (int k = part->first.z; k <= part->last.z; ++k) {
    for (int j = part->first.y; j <= part->last.y; ++j) {
      for (int i = part->first.x; i <= part->last.x; ++i)
        values.push_back(image.value(index_in(grid.points, {i, j, k})));
    }
  }
  SavedRegion saved{.file = free_name("crop", ending)};
  saved.lost =
      write_image(saved.file, part_of(grid, *part), as_stored(values, image, saved.exact), false, origin);
  return saved;
}

std::filesystem::path SavedFiles::free_name(const std::string& stem, const std::string& ending) const {
  return free_place(folder_, stem, ending);
}

std::filesystem::path SavedFiles::save_picture(const Image& image, const std::vector<PngText>& texts) const {
  constexpr int kMostPictures = 10'000;
  for (int number = 1; number < kMostPictures; ++number) {
    const std::string digits = std::to_string(number);
    std::filesystem::path path =
        folder_ /
        (program_ + "-" + std::string(3 - std::min<std::size_t>(3, digits.size()), '0') + digits + ".png");
    if (std::filesystem::exists(path)) continue;
    write_png(path, image, texts);
    return path;
  }
  throw work_error(folder_.string() + ": too many pictures");
}

}  // namespace palpate
