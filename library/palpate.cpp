#include "library/palpate/palpate.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/version.h"
#include "common/field/analytic/examples.h"
#include "common/field/scalar_choice.h"
#include "common/load/write/write_lines.h"
#include "common/scene/seeds.h"
#include "common/trace/trace.h"
#include "library/access.h"

namespace palpate::api {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Status status_of(SampleStatus status) {
  return status == SampleStatus::kOk        ? Status::kOk
         : status == SampleStatus::kOutside ? Status::kOutside
                                            : Status::kBadData;
}

void check_sizes(std::size_t points, std::size_t values, std::size_t status) {
  if (values != points || status != points)
    throw Error(Error::Kind::kUsage, "as many values and states as points are expected");
}

/// `sample(i, x, hint)` at every point. On a face the value's last bit is that of the cell where the one before was
/// found: runs of a fixed length make it the same for any number of threads.
template <class Sample>
void sample_all(std::span<const Point> x, std::span<Status> status, const Sample& sample) {
  constexpr std::size_t kRun = 256;
  parallel_for((x.size() + kRun - 1) / kRun, 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t run = first; run < last; ++run) {
      CellHint hint;
      for (std::size_t i = run * kRun; i < std::min(x.size(), (run + 1) * kRun); ++i)
        status[i] = status_of(sample(i, vec_of(x[i]), hint));
    }
  });
}

}  // namespace

struct LineData {
  std::vector<std::int64_t> offsets{0};
  std::vector<std::uint32_t> seed;
  std::vector<std::uint8_t> end, backward;
  std::vector<Point> points;
  std::vector<double> time, arc, speed, error;
  std::vector<std::uint32_t> outside;
  std::string method;
};

std::string version() { return palpate::version(); }

const std::string& Scalar::name() const noexcept { return data_->field->name(); }
Point Scalar::lower() const noexcept { return point_of(data_->field->bounds().lower); }
Point Scalar::upper() const noexcept { return point_of(data_->field->bounds().upper); }
double Scalar::lowest() const noexcept { return data_->field->lowest(); }
double Scalar::highest() const noexcept { return data_->field->highest(); }
const std::vector<std::string>& Scalar::notes() const noexcept { return data_->field->notes().lines; }

void Scalar::sample(std::span<const Point> x, std::span<double> values, std::span<Status> status) const {
  check_sizes(x.size(), values.size(), status.size());
  sample_all(x, status, [&](std::size_t i, const Vec3& at, CellHint& hint) {
    const ScalarSample found = data_->field->sample(at, hint);
    values[i] = found.status == SampleStatus::kOk ? found.value : kNaN;
    return found.status;
  });
}

void Scalar::gradient(std::span<const Point> x, std::span<Point> gradients, std::span<Status> status) const {
  check_sizes(x.size(), gradients.size(), status.size());
  sample_all(x, status, [&](std::size_t i, const Vec3& at, CellHint& hint) {
    const VectorSample found = data_->field->gradient(at, hint);
    gradients[i] = found.status == SampleStatus::kOk ? point_of(found.value) : Point{kNaN, kNaN, kNaN};
    return found.status;
  });
}

Field Field::example(const std::string& name) {
  return guarded([&] { return Access::field(make_vector_field(palpate::example(name))); });
}

const std::string& Field::name() const noexcept { return data_->field->name(); }
Point Field::lower() const noexcept { return point_of(data_->field->bounds().lower); }
Point Field::upper() const noexcept { return point_of(data_->field->bounds().upper); }
double Field::diagonal() const noexcept { return data_->field->diagonal(); }
double Field::max_speed() const noexcept { return data_->field->max_speed(); }
const std::vector<std::string>& Field::notes() const noexcept { return data_->field->notes().lines; }

void Field::sample(std::span<const Point> x, std::span<Point> values, std::span<Status> status) const {
  check_sizes(x.size(), values.size(), status.size());
  sample_all(x, status, [&](std::size_t i, const Vec3& at, CellHint& hint) {
    const VectorSample found = data_->field->sample(at, hint);
    values[i] = found.status == SampleStatus::kOk ? point_of(found.value) : Point{kNaN, kNaN, kNaN};
    return found.status;
  });
}

void Field::jacobian(std::span<const Point> x, std::span<std::array<Point, 3>> jacobians,
                     std::span<Status> status) const {
  check_sizes(x.size(), jacobians.size(), status.size());
  sample_all(x, status, [&](std::size_t n, const Vec3& at, CellHint& hint) {
    Mat3 m(0.0);
    const SampleStatus found = data_->field->jacobian(at, hint, m);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j)
        jacobians[n][as_size(i)][as_size(j)] = found == SampleStatus::kOk ? m[j][i] : kNaN;
    }
    return found;
  });
}

std::vector<Point> Field::seeds(const std::string& text, std::uint64_t random_seed) const {
  return guarded([&] {
    std::vector<Point> points;
    for (const Vec3& x : make_seeds(parse_seeds(text), *data_->field, random_seed))
      points.push_back(point_of(x));
    return points;
  });
}

Data Data::open(const std::vector<std::string>& files, const OpenOptions& options, const Watcher& watch) {
  InputOptions input;
  input.files.assign(files.begin(), files.end());
  if (!options.solution.empty()) input.solution = options.solution;
  if (options.cell_values != "recovered" && options.cell_values != "constant")
    throw Error(Error::Kind::kUsage,
                "cell values are \"recovered\" or \"constant\", not \"" + options.cell_values + "\"");
  input.cell_values = options.cell_values;
  if (files.empty()) throw Error(Error::Kind::kUsage, "there is no file to open");
  return watched(watch, [&](Progress& progress) { return Access::data(Input::open(input, &progress)); });
}

std::string Data::format() const {
  const std::lock_guard lock(data_->mutex);
  return data_->input.file()->format;
}

std::vector<ArrayInfo> Data::arrays() const {
  const std::lock_guard lock(data_->mutex);
  std::vector<ArrayInfo> found;
  for (const palpate::ArrayInfo& array : data_->input.arrays()) {
    found.push_back({.name = array.name,
                     .type = name_of(array.type),
                     .components = array.components,
                     .tuples = array.tuples,
                     .on_points = array.association == Association::kPoint});
  }
  return found;
}

std::vector<double> Data::times() const {
  const std::lock_guard lock(data_->mutex);
  return data_->input.times();
}

std::vector<std::string> Data::notes() const {
  const std::lock_guard lock(data_->mutex);
  return data_->input.notes();
}

std::vector<std::string> Data::vectors() const {
  const std::lock_guard lock(data_->mutex);
  return data_->input.fields();
}

Field Data::vector(const std::string& name, const std::string& time, int threads,
                   const Watcher& watch) const {
  return watched(watch, [&](Progress& progress) {
    const std::lock_guard lock(data_->mutex);
    Input& input = data_->input;
    input.set_field(name);
    if (!input.times().empty()) input.set_time_step(choose_time(input.times(), time).step);
    return Access::field(input.load_field(threads, &progress));
  });
}

Scalar Data::scalar(const std::string& name, const std::string& time, int threads,
                    const Watcher& watch) const {
  return watched(watch, [&](Progress& progress) {
    const std::lock_guard lock(data_->mutex);
    Input& input = data_->input;
    const ScalarChoice choice = choose_scalar(input.arrays(), name, input.title());
    if (!input.times().empty()) input.set_time_step(choose_time(input.times(), time).step);
    return Access::scalar(
        make_scalar_field(input.read({choice.array}, &progress), choice, input.title(), threads));
  });
}

std::size_t Lines::count() const noexcept { return data_->seed.size(); }
std::span<const std::int64_t> Lines::offsets() const noexcept { return data_->offsets; }
std::span<const std::uint32_t> Lines::seed() const noexcept { return data_->seed; }
std::span<const std::uint8_t> Lines::end() const noexcept { return data_->end; }
std::span<const std::uint8_t> Lines::backward() const noexcept { return data_->backward; }
std::span<const Point> Lines::points() const noexcept { return data_->points; }
std::span<const double> Lines::time() const noexcept { return data_->time; }
std::span<const double> Lines::arc() const noexcept { return data_->arc; }
std::span<const double> Lines::speed() const noexcept { return data_->speed; }
std::span<const double> Lines::error() const noexcept { return data_->error; }
const std::vector<std::uint32_t>& Lines::outside_seeds() const noexcept { return data_->outside; }
const std::string& Lines::method() const noexcept { return data_->method; }

std::vector<Line> Access::lines(const Lines& handle) {
  const LineData& data = *handle.data_;
  std::vector<Line> lines(data.seed.size());
  for (std::size_t l = 0; l < lines.size(); ++l) {
    lines[l].end = static_cast<End>(data.end[l]);
    lines[l].seed = data.seed[l];
    lines[l].direction = data.backward[l] != 0 ? TraceDirection::kBackward : TraceDirection::kForward;
    for (auto i = as_size(data.offsets[l]); i < as_size(data.offsets[l + 1]); ++i) {
      lines[l].points.push_back(
          {vec_of(data.points[i]), data.time[i], data.arc[i], data.speed[i], data.error[i]});
    }
  }
  return lines;
}

void Lines::save(const std::string& path, bool overwrite) const {
  guarded([&] {
    check_line_output(path, overwrite);
    write_lines(path, Access::lines(*this), overwrite);
  });
}

const std::vector<std::string>& end_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (int i = 0; i < kEndCount; ++i) all.emplace_back(name_of(static_cast<End>(i)));
    return all;
  }();
  return names;
}

Lines trace(const Field& field, std::span<const Point> seeds, const TraceOptions& options,
            const Watcher& watch) {
  return watched(watch, [&](Progress& progress) {
    palpate::TraceOptions asked;
    if (!options.method.empty()) asked.integrator = integrator_from_name(options.method);
    asked.forward = options.direction != Direction::kBackward;
    asked.backward = options.direction != Direction::kForward;
    asked.tolerance = options.tolerance;
    asked.step = options.step;
    asked.max_length = options.max_length;
    asked.max_time = options.max_time;
    asked.max_steps = options.max_steps;
    asked.threads = options.threads;
    std::vector<Vec3> from;
    for (const Point& x : seeds) from.push_back(vec_of(x));
    TraceResult result = trace_lines(*Access::of(field), from, asked, &progress);

    LineData data;
    data.method = name_of(result.integrator);
    data.outside = std::move(result.outside_seeds);
    data.points.reserve(result.points);
    for (std::vector<double>* column : {&data.time, &data.arc, &data.speed, &data.error})
      column->reserve(result.points);
    for (Line& line : result.lines) {
      for (const LinePoint& point : line.points) {
        data.points.push_back(point_of(point.position));
        data.time.push_back(point.time);
        data.arc.push_back(point.arc);
        data.speed.push_back(point.speed);
        data.error.push_back(point.error);
      }
      data.offsets.push_back(static_cast<std::int64_t>(data.points.size()));
      data.seed.push_back(line.seed);
      data.end.push_back(static_cast<std::uint8_t>(line.end));
      data.backward.push_back(line.direction == TraceDirection::kBackward ? 1 : 0);
      line = {};  // the memory is needed for the next
    }
    Lines lines;
    Access::set(lines, std::make_shared<LineData>(std::move(data)));
    return lines;
  });
}

}  // namespace palpate::api
