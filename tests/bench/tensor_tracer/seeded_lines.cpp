#include "tests/bench/tensor_tracer/seeded_lines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>

#include <sys/resource.h>

#include "common/base/error.h"

namespace palpate::bench {

double processor_seconds(int who) {
  rusage use{};
  getrusage(who, &use);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(use.ru_utime) + seconds(use.ru_stime);
}

void shell(const std::string& command) {
  if (std::system(command.c_str()) != 0) throw work_error("failed: " + command);
}

std::vector<std::vector<Vec3>> read_tck(const std::string& file) {
  const std::string bytes = read_bytes(file);
  const std::size_t mark = bytes.find("file: . ");
  std::size_t at = std::strtoul(bytes.c_str() + mark + 8, nullptr, 10);
  std::vector<std::vector<Vec3>> lines(1);
  for (; at + 12 <= bytes.size(); at += 12) {
    std::array<float, 3> x{};
    std::memcpy(x.data(), bytes.data() + at, 12);
    if (std::isinf(x[0])) break;
    if (std::isnan(x[0])) {
      lines.emplace_back();
    } else {
      lines.back().emplace_back(x[0], x[1], x[2]);
    }
  }
  lines.pop_back();
  return lines;
}

LinesBySeed by_seed(std::vector<std::vector<Vec3>> lines, const NiftiImage& image) {
  const Mat3 to_voxels = glm::inverse(image.axes);
  LinesBySeed result;
  for (std::vector<Vec3>& line : lines) {
    double least = HUGE_VAL;
    std::size_t point = 0, voxel = 0;
    for (std::size_t p = 0; p < line.size(); ++p) {
      const Vec3 u = to_voxels * (line[p] - image.origin), center = glm::round(u);
      if (glm::distance(u, center) >= least) continue;
      least = glm::distance(u, center);
      point = p;
      voxel = image.index(Index3(center));
    }
    if (least < 1e-3) result[voxel] = {std::move(line), point};
  }
  return result;
}

LinesBySeed by_seed(const TractResult& result, const NiftiImage& image) {
  std::vector<std::vector<Vec3>> lines;
  for (std::size_t l = 0; l < result.lines.line_count(); ++l) {
    const auto line = result.lines.line(l);
    lines.emplace_back(line.begin(), line.end());
  }
  return by_seed(std::move(lines), image);
}

void write_mask(const std::string& file, const NiftiImage& like, const std::vector<float>& values) {
  std::string head = like.bytes.substr(0, kNiftiData);
  const std::array<std::int16_t, 2> flat{3, 1};
  std::memcpy(head.data() + 40, &flat[0], 2);  // three dimensions, one volume
  std::memcpy(head.data() + 48, &flat[1], 2);
  std::ofstream out(file, std::ios::binary);
  out << head;
  out.write(reinterpret_cast<const char*>(values.data()), static_cast<std::streamsize>(4 * values.size()));
}

double tckgen_seconds(const TckgenRun& run) {
  std::ostringstream command;
  command << "tckgen -quiet -force -nthreads 0 -algorithm Tensor_Det " << run.dwi << " -grad "
          << run.gradients << " -seed_grid_per_voxel " << run.mask << " " << run.grid << " -select 0 -step "
          << run.step << " -angle " << run.angle << " -cutoff " << run.cutoff << " -minlength "
          << run.min_length << " -maxlength " << run.max_length << " " << run.out;
  const double before = processor_seconds(RUSAGE_CHILDREN);
  shell(command.str());
  return processor_seconds(RUSAGE_CHILDREN) - before;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace palpate::bench
