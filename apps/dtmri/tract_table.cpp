#include "apps/dtmri/tract_table.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "apps/dtmri/csv_row.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"

namespace palpate {
namespace {

/// Lengths along the line from its seed, below zero before it.
std::vector<double> lengths_from(const Vec3f& seed, std::span<const Vec3f> line) {
  const auto found = std::find(line.begin(), line.end(), seed);
  const std::size_t start = found == line.end() ? 0 : as_size(found - line.begin());
  std::vector<double> lengths(line.size(), 0.0);
  const auto apart = [&line](std::size_t p) { return glm::distance(Vec3{line[p]}, Vec3{line[p + 1]}); };
  for (std::size_t p = start; p + 1 < line.size(); ++p) lengths[p + 1] = lengths[p] + apart(p);
  for (std::size_t p = start; p-- > 0;) lengths[p] = lengths[p + 1] - apart(p);
  return lengths;
}

}  // namespace

void write_tract_table(const std::filesystem::path& path, const TractResult& result,
                       std::span<const Vec3> seeds, bool overwrite) {
  OutputFile file(path, overwrite);
  file.write("line,seed,point,x,y,z,time,arc,speed,error,termination\n");
  const Tractogram& lines = result.lines;
  std::string row;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const std::span<const Vec3f> line = lines.line(l);
    const std::vector<double> lengths = lengths_from(Vec3f{seeds[result.seeds[l]]}, line);
    for (std::size_t p = 0; p < line.size(); ++p) {
      row = std::to_string(l);
      add_number(row, result.seeds[l]);
      add_number(row, p);
      for (int axis = 0; axis < 3; ++axis) add_number(row, line[p][axis]);
      add_number(row, lengths[p]);
      add_number(row, std::abs(lengths[p]));
      row += ",1";
      add_number(row, lines.of_points.front().values[lines.starts[l] + p]);
      (row += ',') += name_of(result.ends[l][lengths[p] < 0.0 ? 0 : 1]);
      file.write(row += '\n');
    }
  }
  file.finish();
}

}  // namespace palpate
