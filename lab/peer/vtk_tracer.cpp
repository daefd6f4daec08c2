#include "lab/peer/vtk_tracer.h"

#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>
#include <variant>

#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/json.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/load/helper/helper_process.h"
#include "common/load/helper/protocol.h"

namespace palpate {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::uint64_t append(MemoryFile& memory, const std::vector<T>& values) {
  return memory.append(std::as_bytes(std::span(values)));
}

/// What the answer says lies at `offset`. @throws ProtocolError.
template <class T>
std::vector<T> array_at(std::span<const std::byte> memory, std::uint64_t offset, std::uint64_t count) {
  if (offset > memory.size() || count > (memory.size() - offset) / sizeof(T))
    throw ProtocolError("an array lies beyond the memory");
  std::vector<T> values(count);
  if (count > 0) std::memcpy(values.data(), memory.data() + offset, count * sizeof(T));
  return values;
}

/// vtkStreamTracer::ReasonForTermination.
End end_of(std::int64_t reason) {
  switch (reason) {
    case 1:
      return End::kLeftDomain;
    case 4:
      return End::kMaxLength;
    case 5:
      return End::kMaxSteps;
    case 6:
      return End::kStagnation;
    default:
      return End::kBadData;
  }
}

/// One piece: cubic, with tangents of its own length.
struct Piece {
  Vec3 x0, x1, t0, t1;  ///< unit tangents
  double length = 0.0;

  [[nodiscard]] Vec3 at(double u) const {
    const double v = 1.0 - u;
    return (v * v * (1.0 + 2.0 * u)) * x0 + (u * u * (3.0 - 2.0 * u)) * x1 +
           (length * u * v) * (v * t0 - u * t1);
  }
  [[nodiscard]] Vec3 slope(double u) const {
    return (6.0 * u * (1.0 - u)) * (x1 - x0) + (length * (1.0 - u) * (1.0 - 3.0 * u)) * t0 +
           (length * u * (3.0 * u - 2.0)) * t1;
  }
  /// From its beginning on.
  [[nodiscard]] double arc(double u) const {
    constexpr double kNode = 0.7745966692414834;  // sqrt(3 / 5)
    constexpr std::array kNodes{-kNode, 0.0, kNode};
    constexpr std::array kWeights{5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};
    double sum = 0.0;
    for (std::size_t i = 0; i < kNodes.size(); ++i)
      sum += kWeights[i] * glm::length(slope(0.5 * u * (1.0 + kNodes[i])));
    return u * sum;
  }
};

Vec3 unit(const Vec3& v, const Vec3& otherwise) {
  const double length = glm::length(v);
  return length > 0.0 ? v / length : otherwise;
}

}  // namespace

std::vector<LinePoint> at_equal_arcs(std::span<const Vec3> points, std::span<const Vec3> tangents,
                                     double spacing) {
  std::vector<LinePoint> line;
  if (points.empty()) return line;
  line.push_back({.position = points[0], .speed = glm::length(tangents[0]), .error = kNaN});
  double before = 0.0, next = spacing;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double chord = glm::distance(points[i - 1], points[i]);
    if (!(chord > 0.0)) continue;
    const Vec3 along = (points[i] - points[i - 1]) / chord;
    Piece piece{points[i - 1], points[i], unit(tangents[i - 1], along), unit(tangents[i], along), chord};
    constexpr int kRounds = 4;
    for (int round = 0; round < kRounds; ++round) piece.length = piece.arc(1.0);
    const double whole = piece.arc(1.0);
    for (; next <= before + whole; next += spacing) {
      double u = (next - before) / whole;
      for (int round = 0; round < kRounds; ++round)
        u -= (piece.arc(u) - (next - before)) / glm::length(piece.slope(u));
      const double speed = (1.0 - u) * glm::length(tangents[i - 1]) + u * glm::length(tangents[i]);
      line.push_back({.position = piece.at(u), .arc = next, .speed = speed, .error = kNaN});
    }
    before += whole;
  }
  if (line.back().arc < before) {
    line.push_back(
        {.position = points.back(), .arc = before, .speed = glm::length(tangents.back()), .error = kNaN});
  }
  return line;
}

struct VtkTracer::Helper {
  HelperProcess process;

  Json ask(MemoryFile& memory, const Json& request, Progress* progress,
           std::shared_ptr<const MappedMemory>& answer) {
    const auto reply = process.ask(memory, request.dump(), progress, "lines of VTK");
    if (!reply)
      throw work_error(std::string("the helper ") + kVtkTracerProgram + " " + process.failure().what);
    answer = reply->memory;
    Json json = parse_json(reply->json);
    if (json.is_discarded()) throw ProtocolError("no JSON");
    if (json.contains("failed"))
      throw work_error(std::string(kVtkTracerProgram) + ": " + json.value("line", std::string()));
    return json;
  }
};

std::string VtkTracer::hindrance(const VectorField& field) {
  if (field.analytic() != nullptr) return "a formula has no mesh";
  if (field.box_grid() != nullptr && field.box_grid()->sheared())
    return "its images have axes at right angles";
  if (find_helper(kVtkTracerProgram).empty())
    return std::string("its helper program, ") + kVtkTracerProgram + ", is not installed";
  return "";
}

VtkTracer::VtkTracer(const VectorField& field, double spacing, Progress* progress)
    : field_(field),
      spacing_(spacing),
      progress_(progress),
      helper_(new Helper{HelperProcess(find_helper(kVtkTracerProgram), kUnlimited)}) {
  MemoryFile memory;
  Json request{{"request", "mesh"}};
  std::vector<double> values;
  std::visit([&](const auto& stored) { values.assign(stored.begin(), stored.end()); }, field.values().values);
  for (double& value : values) value *= field.values().scale;
  request["point_count"] = values.size() / 3;
  request["values"] = append(memory, values);
  if (const TetMesh* mesh = field.tet_mesh()) {
    std::vector<double> points;
    for (const Vec3& x : mesh->points()) points.insert(points.end(), {x.x, x.y, x.z});
    std::vector<std::int64_t> cells;
    for (CellIndex c = 0; c < static_cast<CellIndex>(mesh->cells().size()); ++c) {
      if (mesh->zero_volume(c)) continue;
      for (const std::uint32_t v : mesh->cells()[as_size(c)]) cells.push_back(v);
    }
    request["points"] = append(memory, points);
    request["cells"] = append(memory, cells);
    request["cell_count"] = cells.size() / 4;
  } else {
    const BoxGrid& grid = *field.box_grid();
    request["uniform"] = grid.uniform();
    request["axes"] = Json::array();
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> at;
      for (int i = 0; i < grid.points()[axis]; ++i) at.push_back(grid.coordinate(axis, i));
      request["axes"].push_back({{"offset", append(memory, at)}, {"count", at.size()}});
    }
  }
  std::shared_ptr<const MappedMemory> answer;
  (void)helper_->ask(memory, request, progress, answer);
}

VtkTracer::~VtkTracer() = default;

VtkLines VtkTracer::trace(std::span<const Vec3> seeds, TraceDirection direction, const VtkSetting& setting,
                          double length, std::int64_t steps) {
  const LocalFrame& frame = field_.frame();
  const double scale = frame.length_scale();
  std::vector<double> places;
  for (const Vec3& seed : seeds) {
    const Vec3 x = frame.local_from_data(seed);
    places.insert(places.end(), {x.x, x.y, x.z});
  }
  MemoryFile memory;
  const Json request{{"request", "trace"},
                     {"fifth", setting.fifth},
                     {"step", setting.step / scale},
                     {"backward", direction == TraceDirection::kBackward},
                     {"length", length / scale},
                     {"steps", steps},
                     {"seeds", append(memory, places)},
                     {"seed_count", seeds.size()}};
  std::shared_ptr<const MappedMemory> held;
  const Json answer = helper_->ask(memory, request, progress_, held);
  try {
    const auto bytes = held->bytes();
    const auto count = answer.at("lines").get<std::uint64_t>(),
               point_count = answer.at("point_count").get<std::uint64_t>();
    const auto array = [&]<class T>(const char* name, std::uint64_t numbers, T) {
      return array_at<T>(bytes, answer.at(name).get<std::uint64_t>(), numbers);
    };
    const auto first = array("first", count + 1, std::int64_t{}), seed = array("seed", count, std::int64_t{}),
               reason = array("reason", count, std::int64_t{});
    const auto points = array("points", 3 * point_count, 0.0),
               vectors = array("vectors", 3 * point_count, 0.0);
    VtkLines found{.lines = {}, .seconds = answer.at("seconds").get<double>()};
    for (std::size_t k = 0; k < count; ++k) {
      const std::int64_t begin = first[k], end = first[k + 1];
      if (begin < 0 || end < begin || static_cast<std::uint64_t>(end) > point_count || seed[k] < 0 ||
          as_size(seed[k]) >= seeds.size())
        throw ProtocolError("a line has points that there are none of");
      std::vector<Vec3> x, v;
      for (std::size_t i = as_size(begin); i < as_size(end); ++i) {
        x.push_back(frame.data_from_local({points[3 * i], points[3 * i + 1], points[3 * i + 2]}));
        v.push_back(frame.data_from_local_velocity({vectors[3 * i], vectors[3 * i + 1], vectors[3 * i + 2]}));
        if (direction == TraceDirection::kBackward) v.back() = -v.back();
      }
      found.lines.push_back({.points = at_equal_arcs(x, v, spacing_),
                             .end = end_of(reason[k]),
                             .direction = direction,
                             .seed = static_cast<std::uint32_t>(seed[k])});
    }
    return found;
  } catch (const Json::exception& error) {
    throw ProtocolError(error.what());
  }
}

}  // namespace palpate
