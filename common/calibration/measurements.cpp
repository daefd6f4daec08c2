#include "common/calibration/measurements.h"

#include <cmath>
#include <limits>
#include <span>
#include <string_view>

#include "common/base/files/csv_reader.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// A table's columns by name, each row's numbers checked.
class Rows {
 public:
  Rows(const std::string& file, const std::vector<std::string>& required,
       const std::vector<std::string>& optional, const std::string& what)
      : required_(required.begin(), required.end()),
        optional_(optional.begin(), optional.end()),
        reader_(file, required_, optional_, what),
        values_(required.size() + optional.size()) {}

  bool next() {
    at_ = 0;
    return reader_.next(values_);
  }
  [[nodiscard]] double any() { return values_[at_++]; }
  [[nodiscard]] double number() {
    const double value = any();
    if (!std::isfinite(value)) reader_.refuse("a value that is not finite", "numbers");
    require_plausible(value);
    return value;
  }
  /// Squares of larger ones would leave a fit without an answer; no workbench has such.
  void require_plausible(double value) const {
    constexpr double kMost = 1e3;  // [m], [rad]
    if (std::abs(value) > kMost)
      reader_.refuse("a value of " + short_number(value), "metres and radians, below 1000 in size");
  }
  [[nodiscard]] Vec3 vector() {
    const double x = number(), y = number(), z = number();
    return {x, y, z};
  }
  [[nodiscard]] Quat rotation() {
    const double w = number(), x = number(), y = number(), z = number();
    const Quat q{w, x, y, z};
    // A quaternion that a program printed with few digits is off by less; another one is no rotation.
    constexpr double kSlack = 0.05;
    const double length = glm::length(q);
    if (std::abs(length - 1.0) > kSlack)
      reader_.refuse("a quaternion of length " + short_number(length), "1");
    return q / length;
  }
  [[nodiscard]] TrackerPose pose() {
    const Vec3 position = vector();
    return {position, rotation()};
  }
  /// 0 or 1, 0 where the table has no such column.
  [[nodiscard]] bool flag() {
    const double value = any();
    if (std::isnan(value) || value == 0.0) return false;
    if (value != 1.0) reader_.refuse(short_number(value), "0 or 1");
    return true;
  }
  [[nodiscard]] CsvReader& reader() noexcept { return reader_; }

 private:
  std::vector<std::string_view> required_, optional_;
  CsvReader reader_;
  std::vector<double> values_;
  std::size_t at_ = 0;
};

const std::vector<std::string> kPose{"px", "py", "pz", "qw", "qx", "qy", "qz"};

void add(std::string& row, std::initializer_list<double> values) {
  for (const double value : values) row += (row.empty() ? "" : ",") + exact_number(value);
}
void add(std::string& row, const Vec3& x) { add(row, {x.x, x.y, x.z}); }
void add(std::string& row, const TrackerPose& pose) {
  const Quat& q = pose.orientation;
  add(row, pose.position);
  add(row, {q.w, q.x, q.y, q.z});
}

}  // namespace

MeasurementTable<TrackerMeasurement> read_tracker_measurements(const std::string& file) {
  Rows rows(file,
            {"tx", "ty", "tz", "tqw", "tqx", "tqy", "tqz", "mx", "my", "mz", "mqw", "mqx", "mqy", "mqz"},
            {"validation"},
            "a CSV file with the header tx,ty,tz,tqw,tqx,tqy,tqz,mx,my,mz,mqw,mqx,mqy,mqz[,validation]");
  MeasurementTable<TrackerMeasurement> out{file, {}};
  while (rows.next()) {
    const TrackerPose reported = rows.pose(), actual = rows.pose();
    out.rows.push_back({reported, actual, rows.flag()});
  }
  return out;
}

MeasurementTable<MarkerMeasurement> read_marker_measurements(const std::string& file) {
  std::vector<std::string> required = kPose, optional;
  for (std::size_t m = 1; m <= kMaxMarkers; ++m) {
    for (const char axis : {'x', 'y', 'z'})
      (m == 1 ? required : optional).push_back("v" + std::to_string(m) + axis);
  }
  Rows rows(file, required, optional, "a CSV file with the header px,py,pz,qw,qx,qy,qz,v1x,v1y,v1z[,…,v6z]");
  MeasurementTable<MarkerMeasurement> out{file, {}};
  while (rows.next()) {
    MarkerMeasurement measurement{.pose = rows.pose(), .markers = {}};
    for (auto& marker : measurement.markers) {
      const double x = rows.any(), y = rows.any(), z = rows.any();
      if (!is_finite({x, y, z})) continue;
      for (const double value : {x, y, z}) rows.require_plausible(value);
      marker = Vec3{x, y, z};
    }
    out.rows.push_back(measurement);
  }
  return out;
}

MeasurementTable<ArmMeasurement> read_arm_measurements(const std::string& file, int joints) {
  std::vector<std::string> required{"x", "y", "z"};
  for (int j = 1; j <= joints; ++j) required.push_back("j" + std::to_string(j));
  Rows rows(file, required, {"grid"},
            "a CSV file with the header x,y,z,j1,…,j" + std::to_string(joints) + "[,grid]");
  MeasurementTable<ArmMeasurement> out{file, {}};
  while (rows.next()) {
    ArmMeasurement measurement{.point = rows.vector(), .readings = {}, .grid = 0};
    for (int j = 0; j < joints; ++j) measurement.readings.push_back(rows.number());
    const double grid = rows.any();
    constexpr double kMaxGrids = 16.0;  // each has six unknowns of its own
    if (!std::isnan(grid)) {
      if (!(grid >= 0.0 && grid < kMaxGrids && grid == std::floor(grid)))
        rows.reader().refuse("grid " + short_number(grid), "a number from 0 to 15");
      measurement.grid = static_cast<int>(grid);
    }
    out.rows.push_back(std::move(measurement));
  }
  return out;
}

MeasurementTable<PivotMeasurement> read_pivot_measurements(const std::string& file) {
  Rows rows(file, kPose, {}, "a CSV file with the header px,py,pz,qw,qx,qy,qz");
  MeasurementTable<PivotMeasurement> out{file, {}};
  while (rows.next()) out.rows.push_back(rows.pose());
  return out;
}

MeasurementTable<SightingMeasurement> read_sightings(const std::string& file) {
  std::vector<std::string> required = kPose;
  for (const char* name : {"eye", "ax", "ay", "az", "bx", "by", "bz"}) required.emplace_back(name);
  Rows rows(file, required, {}, "a CSV file with the header px,py,pz,qw,qx,qy,qz,eye,ax,ay,az,bx,by,bz");
  MeasurementTable<SightingMeasurement> out{file, {}};
  while (rows.next()) {
    const TrackerPose head = rows.pose();
    const bool right = rows.flag();
    const Vec3 near = rows.vector(), far = rows.vector();
    // Two points a millimetre apart give no direction.
    constexpr double kApart = 1e-3;
    if (glm::distance(near, far) < kApart)
      rows.reader().refuse("two points at the same place", "a near and a far one");
    out.rows.push_back({head, right, near, far});
  }
  return out;
}

std::string csv(const std::vector<TrackerMeasurement>& rows) {
  std::string out = "tx,ty,tz,tqw,tqx,tqy,tqz,mx,my,mz,mqw,mqx,mqy,mqz,validation\n";
  for (const TrackerMeasurement& row : rows) {
    std::string line;
    add(line, row.reported);
    add(line, row.actual);
    out += line + (row.validation ? ",1\n" : ",0\n");
  }
  return out;
}

std::string csv(const std::vector<MarkerMeasurement>& rows) {
  std::size_t markers = 1;
  for (const MarkerMeasurement& row : rows) {
    for (std::size_t m = 0; m < kMaxMarkers; ++m) {
      if (row.markers[m]) markers = std::max(markers, m + 1);
    }
  }
  std::string out = "px,py,pz,qw,qx,qy,qz";
  for (std::size_t m = 1; m <= markers; ++m) {
    for (const char axis : {'x', 'y', 'z'}) out += ",v" + std::to_string(m) + axis;
  }
  out += "\n";
  for (const MarkerMeasurement& row : rows) {
    std::string line;
    add(line, row.pose);
    for (std::size_t m = 0; m < markers; ++m) add(line, row.markers[m].value_or(Vec3{kNaN}));
    out += line + "\n";
  }
  return out;
}

std::string csv(const std::vector<ArmMeasurement>& rows) {
  std::string out = "x,y,z";
  for (std::size_t j = 1; !rows.empty() && j <= rows[0].readings.size(); ++j) out += ",j" + std::to_string(j);
  out += ",grid\n";
  for (const ArmMeasurement& row : rows) {
    std::string line;
    add(line, row.point);
    for (const double reading : row.readings) add(line, {reading});
    out += line + "," + std::to_string(row.grid) + "\n";
  }
  return out;
}

std::string csv(const std::vector<PivotMeasurement>& rows) {
  std::string out = "px,py,pz,qw,qx,qy,qz\n";
  for (const PivotMeasurement& row : rows) {
    std::string line;
    add(line, row);
    out += line + "\n";
  }
  return out;
}

std::string csv(const std::vector<SightingMeasurement>& rows) {
  std::string out = "px,py,pz,qw,qx,qy,qz,eye,ax,ay,az,bx,by,bz\n";
  for (const SightingMeasurement& row : rows) {
    std::string line;
    add(line, row.head);
    line += row.right ? ",1" : ",0";
    add(line, row.near);
    add(line, row.far);
    out += line + "\n";
  }
  return out;
}

}  // namespace palpate
