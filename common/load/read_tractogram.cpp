#include "common/load/read_tractogram.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include "common/base/error.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// Cell types of the VTK file format that make a line, of one point or of several.
bool is_line(std::uint8_t type) noexcept {
  constexpr std::uint8_t kVertex = 1, kLine = 3, kPolyLine = 4;
  return type == kVertex || type == kLine || type == kPolyLine;
}

using Columns = std::vector<Tractogram::Column>;

/// The columns that `array` fills, found by name or added with NaN for the `before` tuples of other blocks.
std::vector<std::size_t> columns_of(const DataArray& array, std::size_t before, Columns& columns) {
  std::vector<std::size_t> places;
  for (int component = 0; component < array.components; ++component) {
    const std::string name =
        array.components > 1 ? array.name + " " + std::to_string(component + 1) : array.name;
    const auto found = std::find_if(columns.begin(), columns.end(),
                                    [&name](const auto& column) { return column.name == name; });
    places.push_back(as_size(found - columns.begin()));
    if (found == columns.end()) columns.push_back({.name = name, .values = {}});
    columns[places.back()].values.resize(before, std::numeric_limits<float>::quiet_NaN());
  }
  return places;
}

void append_lines(const DataSet& block, const UnstructuredTopology& cells, Tractogram& lines) {
  const std::size_t points_before = lines.points.size(), lines_before = lines.line_count();
  std::vector<std::size_t> of_points;  ///< which point of the block each point of the lines is
  std::vector<std::size_t> of_lines;
  for (std::size_t cell = 0; cell < cells.types.size(); ++cell) {
    if (!is_line(cells.types[cell])) continue;
    for (std::int64_t c = cells.offsets[cell]; c < cells.offsets[cell + 1]; ++c) {
      const auto point = as_size(cells.connectivity[as_size(c)]);
      of_points.push_back(point);
      lines.points.emplace_back(static_cast<float>(cells.positions.at(point, 0)),
                                static_cast<float>(cells.positions.at(point, 1)),
                                static_cast<float>(cells.positions.at(point, 2)));
    }
    of_lines.push_back(cell);
    lines.starts.push_back(lines.points.size());
  }
  for (const DataArray& array : block.arrays) {
    const bool points = array.association == Association::kPoint;
    Columns& columns = points ? lines.of_points : lines.of_lines;
    const auto places = columns_of(array, points ? points_before : lines_before, columns);
    for (const std::size_t tuple : points ? of_points : of_lines) {
      for (std::size_t c = 0; c < places.size(); ++c)
        columns[places[c]].values.push_back(static_cast<float>(array.at(tuple, static_cast<int>(c))));
    }
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (auto& column : lines.of_points) column.values.resize(lines.points.size(), nan);
  for (auto& column : lines.of_lines) column.values.resize(lines.line_count(), nan);
}

}  // namespace

bool may_hold_lines(const FileInfo& info) noexcept {
  return std::any_of(info.blocks.begin(), info.blocks.end(), [](const BlockInfo& block) {
    return !block.not_volume.empty() && (block.grid == "lines" || block.grid == "polygonal");
  });
}

Tractogram pack_lines(std::span<const DataSet> blocks) {
  Tractogram lines;
  for (const DataSet& block : blocks) {
    if (const auto* cells = std::get_if<UnstructuredTopology>(&block.topology))
      append_lines(block, *cells, lines);
    else if (const auto* image = std::get_if<UniformTopology>(&block.topology))
      lines.image = TractogramImage{image->points, image->axes, image->origin};
  }
  return lines;
}

TractogramFile read_tractogram(const std::filesystem::path& file, Progress* progress) {
  LoadRequest request;
  request.files = {file};
  if (progress != nullptr) progress->begin("reading " + file.filename().string(), 0);
  Source source = Source::open(request, {}, progress);
  TractogramFile read;
  read.info = source.info();
  const auto refuse = [&file](const std::string& found) {
    throw input_error({file.string(), "", found, "lines (.tck, .trk, .trx or .vtp)", ""});
  };
  if (!may_hold_lines(read.info)) refuse("is " + read.info.format + ", and holds no lines");
  std::vector<std::string> names;
  for (const ArrayInfo& array : source.arrays()) names.push_back(array.name);
  const std::vector<DataSet> blocks = source.read(names, 0, progress);
  read.lines = pack_lines(blocks);
  const bool stated = read.info.blocks.front().grid == "lines";
  if (read.lines.line_count() == 0 && !stated) refuse("holds no lines");
  for (const Vec3f& x : read.lines.points) {
    if (!std::isfinite(x.x) || !std::isfinite(x.y) || !std::isfinite(x.z))
      refuse("holds a point that is not finite");
  }
  return read;
}

}  // namespace palpate
