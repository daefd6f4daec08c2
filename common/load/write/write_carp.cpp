#include "common/load/write/write_carp.h"

#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/base/output_file.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::size_t kIgbHeader = 1024;
constexpr double kUneven = 1e-3;

std::string triple(const Vec3& v) {
  return exact_number(v.x) + " " + exact_number(v.y) + " " + exact_number(v.z);
}

/// Of length one, or zeros.
Vec3 direction(const Vec3& v) {
  const double length = glm::length(v);
  return length > 0.0 && std::isfinite(length) ? v / length : Vec3{0.0};
}

}  // namespace

IgbTimes igb_times(const std::vector<double>& times, const std::string& file) {
  if (times.size() < 2) return {times.empty() ? 0.0 : times.front(), 1.0, 1};
  const IgbTimes even{times.front(), (times.back() - times.front()) / static_cast<double>(times.size() - 1),
                      times.size()};
  for (std::size_t t = 1; t < times.size(); ++t)
    if (!(std::abs(times[t] - times[t - 1] - even.apart) <= kUneven * even.apart))
      throw input_error(
          {file, "times",
           "are not evenly apart (" + short_number(times[t - 1]) + ", then " + short_number(times[t]) + ")",
           "even ones, which are all that .igb can state", "write it as .pvd"});
  return even;
}

/// The files at work.
class CarpOutput::Files {
 public:
  explicit Files(bool overwrite) : overwrite_(overwrite) {}
  OutputFile& open(const std::filesystem::path& path) {
    return *files_.emplace_back(std::make_unique<OutputFile>(path, overwrite_));
  }
  OutputFile& at(std::size_t file) { return *files_[file]; }
  void finish() {
    for (const auto& file : files_) file->finish();
  }
  std::size_t count() const { return files_.size(); }

 private:
  bool overwrite_;
  std::vector<std::unique_ptr<OutputFile>> files_;
};

CarpOutput::CarpOutput(std::filesystem::path pts, bool overwrite)
    : pts_(std::move(pts)), files_(std::make_unique<Files>(overwrite)) {
  for (const char* ending : {".pts", ".elem", ".lon"}) {
    names_.push_back(std::filesystem::path(pts_).replace_extension(ending));
    (void)files_->open(names_.back());
  }
}

CarpOutput::~CarpOutput() = default;

void CarpOutput::write_mesh(std::span<const Vec3> points, double micrometres,
                            std::span<const TetMesh::Tet> cells, std::span<const int> regions) {
  OutputFile& pts = files_->at(0);
  pts.write(std::to_string(points.size()) + "\n");
  for (const Vec3& x : points) pts.write(triple(micrometres * x) + "\n");
  OutputFile& elem = files_->at(1);
  elem.write(std::to_string(cells.size()) + "\n");
  for (std::size_t c = 0; c < cells.size(); ++c) {
    std::string row = "Tt";
    for (const std::uint32_t p : cells[c]) row += " " + std::to_string(p);
    elem.write(row + " " + std::to_string(regions.empty() ? 1 : regions[c]) + "\n");
  }
}

void CarpOutput::write_directions(std::span<const Vec3> fibres, std::span<const Vec3> sheets) {
  OutputFile& lon = files_->at(2);
  lon.write(sheets.empty() ? "1\n" : "2\n");
  for (std::size_t c = 0; c < fibres.size(); ++c)
    lon.write(triple(direction(fibres[c])) + (sheets.empty() ? "" : " " + triple(direction(sheets[c]))) +
              "\n");
}

void CarpOutput::write_values(const std::string& name, std::span<const double> values) {
  names_.push_back(pts_.parent_path() / (name + ".dat"));
  OutputFile& file = files_->open(names_.back());
  for (const double value : values) file.write((std::isnan(value) ? "nan" : exact_number(value)) + "\n");
}

std::size_t CarpOutput::begin_series(const std::string& name, std::size_t points, const IgbTimes& times) {
  names_.push_back(pts_.parent_path() / (name + ".igb"));
  OutputFile& file = files_->open(names_.back());
  const auto steps = static_cast<double>(times.count);
  std::string header = "x:" + std::to_string(points) + " y:1 z:1 t:" + std::to_string(times.count) +
                       " type:float systeme:little_endian org_t:" + exact_number(times.first) +
                       " dim_t:" + exact_number((steps - 1.0) * times.apart) +
                       " inc_t:" + exact_number(times.apart) + " facteur:1 zero:0\r\n";
  header.resize(kIgbHeader - 1, ' ');
  file.write(header + "\f");
  return files_->count() - 1;
}

void CarpOutput::write_step(std::size_t series, std::span<const double> values) {
  for (const double value : values) files_->at(series).write_number(static_cast<float>(value));
}

void CarpOutput::finish() { files_->finish(); }

}  // namespace palpate
