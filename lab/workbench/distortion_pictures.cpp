#include "lab/workbench/distortion_pictures.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <system_error>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/field/analytic/analytic_field.h"
#include "common/field/vector_field.h"
#include "common/geometry/box_edges.h"
#include "common/haptics/frame_along.h"
#include "common/kinematics/tracker_correction.h"
#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/trace/trace.h"

namespace palpate {
namespace {

constexpr int kWidth = 1000, kHeight = 800;  // pixels
constexpr double kTransmitter = 0.1;         // [m] side of the box that stands for it

Box measured_box(const std::vector<TrackerMeasurement>& rows) {
  Box box;
  for (const TrackerMeasurement& row : rows) box.include(row.reported.position);
  return box;
}

/// The polynomial of the error as a field to trace in.
class ErrorField final : public AnalyticField {
 public:
  ErrorField(VectorPolynomial error, const Box& box) : error_(std::move(error)), box_(box) {}

  [[nodiscard]] Vec3 velocity(const Vec3& x) const noexcept override { return error_.at(x); }
  [[nodiscard]] Mat3 jacobian(const Vec3& x) const noexcept override {
    // Central differences: of a polynomial in variables near one they are good to eight digits.
    Mat3 out{0.0};
    const double h = 1e-5 * error_.scale;
    for (int j = 0; j < 3; ++j) {
      Vec3 step{0.0};
      step[j] = h;
      out[j] = (error_.at(x + step) - error_.at(x - step)) / (2.0 * h);
    }
    return out;
  }
  [[nodiscard]] Box bounds() const noexcept override { return box_; }
  [[nodiscard]] std::string name() const override { return "position error"; }
  [[nodiscard]] std::string description() const override { return "the polynomial of a tracker's error"; }

 private:
  VectorPolynomial error_;
  Box box_;
};

/// The measured volume and the transmitter, and how they are looked at.
SceneView scene_of(const Box& box, const CameraAngles& angles, const std::string& title,
                   const std::string& subtitle) {
  SceneView view;
  const Box transmitter{Vec3{-0.5 * kTransmitter}, Vec3{0.5 * kTransmitter}};
  Box all = box;
  all.include(transmitter.lower);
  all.include(transmitter.upper);
  view.bounds = all;
  view.outline = box_edges(box);
  for (auto& edge : box_edges(transmitter)) view.outline.push_back(std::move(edge));
  view.units.length = "m";
  view.title = title;
  view.subtitle = subtitle;
  view.camera = make_camera(all, angles, static_cast<double>(kWidth) / kHeight);
  return view;
}

struct Icon {
  Vec3 place{0.0};      ///< [m]
  Vec3 direction{0.0};  ///< unit
  double size = 0.0;    ///< of what it shows
};

/// Arrows of lines, centred on their places; the longest is `longest`, the others by the logarithm of their
/// size: log(1 + s / s_0) / log(1 + s_max / s_0).
void add_icons(const std::vector<Icon>& icons, double scale, double longest, const std::string& name,
               const std::string& unit, SceneView& view) {
  double most = 0.0;
  for (const Icon& icon : icons) most = std::max(most, icon.size);
  auto lines = std::make_shared<std::vector<Line>>();
  auto array = std::make_shared<LineArray>();
  array->name = name;
  array->unit = unit;
  const auto add = [&](const Vec3& a, const Vec3& b, double value) {
    Line line;
    line.points = {LinePoint{.position = a}, LinePoint{.position = b, .arc = glm::distance(a, b)}};
    lines->push_back(std::move(line));
    for (int end = 0; end < 2; ++end) array->values.push_back(static_cast<float>(value));
  };
  constexpr double kBarb = 0.3;  // of the shaft's length
  for (const Icon& icon : icons) {
    const double length = longest * std::log1p(icon.size / scale) / std::log1p(most / scale);
    if (!(length > 0.0)) continue;
    const Vec3 tip = icon.place + 0.5 * length * icon.direction;
    add(icon.place - 0.5 * length * icon.direction, tip, icon.size);
    const Mat3 frame = frame_along(icon.direction);
    for (const auto& [u, v] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
      const Vec3 aside = 0.5 * (u * frame[1] + v * frame[2]);
      add(tip, tip + kBarb * length * (aside - icon.direction), icon.size);
    }
  }
  view.lines = std::move(lines);
  view.style = {.color_by = ColorBy::kArray,
                .array = std::move(array),
                .range = ValueRange{0.0, most},
                .color_map = ColorMap::kHeat,
                .width = 4.0,
                .halo = false};
}

/// Rows of the layer across z that holds most of them, and where it is.
std::vector<const TrackerMeasurement*> slice_of(const std::vector<TrackerMeasurement>& rows, double& middle) {
  const Box box = measured_box(rows);
  // As many layers as measurements stand apart on average.
  const Vec3 size = box.upper - box.lower;
  const double apart = std::cbrt(size.x * size.y * size.z / static_cast<double>(rows.size()));
  const int layers = std::max(1, static_cast<int>(std::lround(size.z / apart)));
  std::vector<std::vector<const TrackerMeasurement*>> in(as_size(layers));
  for (const TrackerMeasurement& row : rows) {
    const double part = (row.reported.position.z - box.lower.z) / size.z;
    const int layer = std::clamp(static_cast<int>(part * layers), 0, layers - 1);
    in[as_size(layer)].push_back(&row);
  }
  const auto fullest = std::max_element(in.begin(), in.end(),
                                        [](const auto& a, const auto& b) { return a.size() < b.size(); });
  middle = 0.0;
  for (const TrackerMeasurement* row : *fullest)
    middle += row->reported.position.z / static_cast<double>(fullest->size());
  return *fullest;
}

constexpr CameraAngles kFromAbove{.azimuth = 0.0, .elevation = 65.0};

std::string slice_text(std::size_t count, double middle) {
  return counted(count, "measurement") + " about z = " + short_number(std::round(1e3 * middle) * 1e-3) +
         " m; lengths by the logarithm; the transmitter is the small box";
}

double longest_icon(const Box& box, std::size_t count) {
  const Vec3 size = box.upper - box.lower;
  return 1.1 * std::sqrt(size.x * size.y / static_cast<double>(std::max<std::size_t>(count, 1)));
}

/// M(p) of synthetic_tracker.h.
Mat3 dipole_matrix(const Vec3& p) {
  const double distance = glm::length(p);
  const Vec3 r = p / distance;
  return (3.0 * glm::outerProduct(r, r) - Mat3{1.0}) / (distance * distance * distance);
}

}  // namespace

DistortionPicture position_error_lines(const std::vector<TrackerMeasurement>& rows,
                                       const VectorPolynomial& error, std::uint64_t seed) {
  const Box box = measured_box(rows);
  const double z = std::clamp(0.0, box.lower.z, box.upper.z);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> part(0.02, 0.98);
  constexpr int kSeeds = 160;
  std::vector<Vec3> seeds;
  for (int i = 0; i < kSeeds; ++i) {
    const double x = part(random), y = part(random);
    seeds.emplace_back(box.lower.x + x * (box.upper.x - box.lower.x),
                       box.lower.y + y * (box.upper.y - box.lower.y), z);
  }
  const auto field = make_vector_field(std::make_shared<const ErrorField>(error, box));
  constexpr double kTolerance = 1e-4;  // of the diagonal: less than a pixel
  TraceResult traced = trace_lines(*field, seeds,
                                   {.backward = true,
                                    .tolerance = kTolerance,
                                    .step = 0.01 * box.diagonal(),
                                    .max_length = box.diagonal()});
  auto array = std::make_shared<LineArray>();
  array->name = "position error";
  array->unit = "mm";
  constexpr double kMillimetres = 1e3;
  for (const Line& line : traced.lines) {
    for (const LinePoint& point : line.points)
      array->values.push_back(static_cast<float>(kMillimetres * glm::length(error.at(point.position))));
  }
  DistortionPicture picture{
      "distortion_lines.png",
      scene_of(box, {.azimuth = 20.0, .elevation = 30.0}, "Position error",
               "streamlines of its polynomial of degree " + std::to_string(error.degree) +
                   " from seeds at z = " + short_number(std::round(kMillimetres * z) / kMillimetres) + " m")};
  picture.view.lines = std::make_shared<std::vector<Line>>(std::move(traced.lines));
  picture.view.style = {.color_by = ColorBy::kArray,
                        .array = std::move(array),
                        .color_map = ColorMap::kHeat,
                        .width = 3.5,
                        .clearing = 0.7};
  return picture;
}

DistortionPicture orientation_error_icons(const std::vector<TrackerMeasurement>& rows) {
  double middle = 0.0;
  const auto slice = slice_of(rows, middle);
  const Box box = measured_box(rows);
  DistortionPicture picture{"orientation_icons.png",
                            scene_of(box, kFromAbove, "Orientation error", slice_text(slice.size(), middle))};
  std::vector<Icon> icons;
  for (const TrackerMeasurement* row : slice) {
    const Vec3 part = pose_error(row->actual, row->reported).orientation;
    const double sine = glm::length(part);
    if (sine > 0.0)
      icons.push_back({row->reported.position, part / sine, 2.0 * std::asin(std::min(1.0, sine)) / kDegree});
  }
  constexpr double kScale = 0.3;  // [degrees] s_0: what such trackers repeat to
  add_icons(icons, kScale, longest_icon(box, slice.size()), "orientation error", "deg", picture.view);
  return picture;
}

DistortionPicture field_distortion_icons(const std::vector<TrackerMeasurement>& rows) {
  double middle = 0.0;
  const auto slice = slice_of(rows, middle);
  const Box box = measured_box(rows);
  DistortionPicture picture{"field_icons.png",
                            scene_of(box, kFromAbove, "Distortion of the field of the coil along x",
                                     slice_text(slice.size(), middle))};
  std::vector<Icon> icons;
  for (const TrackerMeasurement* row : slice) {
    const Vec3& p = row->actual.position;
    if (!(glm::length(p) > 0.0) || !(glm::length(row->reported.position) > 0.0)) continue;
    const Quat turn = row->actual.orientation * glm::conjugate(row->reported.orientation);
    const Vec3 ideal = dipole_matrix(p)[0];
    const Vec3 added = turn * dipole_matrix(row->reported.position)[0] - ideal;
    const double size = glm::length(added);
    constexpr double kPercent = 100.0;
    if (size > 0.0) icons.push_back({p, added / size, kPercent * size / glm::length(ideal)});
  }
  constexpr double kScale = 1.0;  // [%] s_0
  add_icons(icons, kScale, longest_icon(box, slice.size()), "added field", "% of the coil's", picture.view);
  return picture;
}

std::vector<ReportPlot> drawn_pictures(const std::vector<DistortionPicture>& pictures,
                                       const std::string& program, const std::string& command_line) {
  std::vector<ReportPlot> drawn;
  for (const DistortionPicture& picture : pictures) {
    const auto png = encode_png(render_image(picture.view, kWidth, kHeight).image,
                                {{"Software", version_text(program)}, {"Command", command_line}});
    drawn.push_back({picture.file, picture.view.title + ": " + picture.view.subtitle,
                     std::string(png.begin(), png.end())});
  }
  return drawn;
}

void write_pictures(const std::vector<ReportPlot>& drawn, const std::filesystem::path& folder, bool replace) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) throw work_error(folder.string() + ": cannot be made (" + error.message() + ")");
  for (const ReportPlot& picture : drawn) check_output(folder / picture.file, replace);
  for (const ReportPlot& picture : drawn) {
    OutputFile file(folder / picture.file, replace);
    file.write(picture.content);
    file.finish();
  }
}

ReportSection distortion_section(std::vector<ReportPlot> drawn, const std::string& trouble) {
  ReportSection out{.title = "The tracker's distortion in space", .plots = std::move(drawn)};
  if (!trouble.empty()) {
    out.paragraphs.push_back("Its pictures could not be drawn: " + trouble + ".");
    return out;
  }
  out.paragraphs.push_back(
      "Streamlines of the polynomial of the position error, fainter where it is small; the axes about which "
      "orientations are turned; and what metal adds to the field of the transmitter's coil along x, as the "
      "readings tell it: arrows like those of another dipole point at the metal (Ikits 2006, sec. 4.2.6).");
  return out;
}

}  // namespace palpate
