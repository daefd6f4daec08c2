#include "common/window/saved_files.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/output_file.h"
#include "common/field/grid/image_resample.h"
#include "common/field/transfer/color_transfer.h"
#include "common/field/transfer/region_transfer.h"
#include "common/load/write/write_annotations.h"
#include "common/load/write/write_image.h"

namespace palpate {

SavedFiles::SavedFiles(const std::filesystem::path& folder, std::string program)
    : folder_(std::filesystem::absolute(folder)), program_(std::move(program)) {}

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
  return static_cast<std::size_t>(std::ranges::count_if(
      lines.entries(), [this](const DrawnLines::Entry& entry) { return !saved_.contains(entry.line); }));
}

std::filesystem::path SavedFiles::save_transfer(const std::string& name, const Lens& look) const {
  std::filesystem::path path = folder_ / name;
  OutputFile file(path, false);
  file.write(look.regions ? regions_text(*look.regions)
                          : color_transfer_text(look.transfer.value_or(ColorTransfer())));
  file.finish();
  return path;
}

std::filesystem::path SavedFiles::save_annotations(std::span<const Annotation> annotations,
                                                   const std::string& ending) const {
  std::filesystem::path path = free_name("annotations", ending);
  write_annotations(path, annotations, false);
  return path;
}

std::filesystem::path SavedFiles::save_region(const VolumeImage& image, const Box& region,
                                              const std::string& ending, ImageSpace space) const {
  const UniformTopology grid{.points = image.points, .origin = image.origin, .axes = image.axes};
  const auto part = points_in(grid, region);
  PALPATE_CHECK(part.has_value());
  const Index3 n = part->points();
  const std::size_t across = static_cast<std::size_t>(grid.points.x);
  const std::size_t layer = across * static_cast<std::size_t>(grid.points.y);
  std::vector<float> values;
  values.reserve(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) *
                 static_cast<std::size_t>(n.z));
  for (int k = part->first.z; k <= part->last.z; ++k) {
    for (int j = part->first.y; j <= part->last.y; ++j) {
      for (int i = part->first.x; i <= part->last.x; ++i) {
        const std::size_t at = static_cast<std::size_t>(i) + across * static_cast<std::size_t>(j) +
                               layer * static_cast<std::size_t>(k);
        values.push_back(static_cast<float>(image.value(at)));
      }
    }
  }
  std::filesystem::path path = free_name("crop", ending);
  write_image(path, part_of(grid, *part), make_array("scalars", Association::kPoint, 1, values), false,
              space);
  return path;
}

std::filesystem::path SavedFiles::free_name(const std::string& stem, const std::string& ending) const {
  std::filesystem::path path = folder_ / (stem + ending);
  for (int number = 2; std::filesystem::exists(path); ++number)
    path = folder_ / std::string(stem).append("-").append(std::to_string(number)).append(ending);
  return path;
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
