#include "common/haptics/widget/widget_text.h"

#include <array>
#include <cmath>
#include <vector>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

constexpr char kBetween = '/';

/// Numbers with commas between; none where a part is no finite number.
std::vector<double> numbers(std::string_view text) {
  std::vector<double> values;
  for (const std::string_view word : split(text, ',')) {
    const std::optional<double> value = number(word);
    if (!value || !std::isfinite(*value)) return {};
    values.push_back(*value);
  }
  return values;
}

/// What follows `word` and a colon.
std::optional<std::string_view> after(std::string_view text, std::string_view word) {
  if (!text.starts_with(word) || text.substr(word.size()).substr(0, 1) != ":") return std::nullopt;
  return text.substr(word.size() + 1);
}

}  // namespace

std::string text_of(const GridFrame& frame) {
  const Vec3 &a = frame.first, &b = frame.second;
  switch (frame.kind) {
    case GridFrame::Kind::kData:
      return "data";
    case GridFrame::Kind::kWorld:
      return "world";
    case GridFrame::Kind::kPlane:
      return "plane:" + exact_text({a.x, a.y, a.z, frame.offset});
    case GridFrame::Kind::kAxes:
      return "axes:" + exact_text({a.x, a.y, a.z, b.x, b.y, b.z});
  }
  return {};
}

std::optional<std::string> read_text(std::string_view text, GridFrame& frame) {
  frame = {};
  if (text == "data") return std::nullopt;
  frame.kind = GridFrame::Kind::kWorld;
  if (text == "world") return std::nullopt;
  if (const auto rest = after(text, "plane")) {
    const auto v = numbers(*rest);
    frame.kind = GridFrame::Kind::kPlane;
    if (v.size() == 4) frame.first = vec_at(v, 0), frame.offset = v[3];
    if (v.size() == 4 && frame.valid()) return std::nullopt;
  } else if (const auto axes = after(text, "axes")) {
    const auto v = numbers(*axes);
    frame.kind = GridFrame::Kind::kAxes;
    if (v.size() == 6) frame.first = vec_at(v, 0), frame.second = vec_at(v, 3);
    if (v.size() == 6 && frame.valid()) return std::nullopt;
  }
  return "data, world, plane:nx,ny,nz,d or axes:x,y,z,x,y,z is expected, with axes that differ; found '" +
         std::string(text) + "'";
}

std::string text_of(const GridMarks& marks) {
  std::string text;
  for (int i = 0; i < marks.count; ++i) {
    const GridMark& mark = marks.mark[as_size(i)];
    if (i > 0) text += kBetween;
    if (mark.axis < 3) {
      (text += "xyz"[mark.axis]) += ":" + exact_number(mark.at);
    } else {
      text += "plane:" + exact_text({mark.normal.x, mark.normal.y, mark.normal.z, mark.at});
    }
  }
  return text;
}

std::optional<std::string> read_text(std::string_view text, GridMarks& marks) {
  marks = {};
  if (text.empty()) return std::nullopt;
  for (const std::string_view word : split(text, kBetween)) {
    if (marks.count == GridMarks::kMax) return "at most " + std::to_string(GridMarks::kMax) + " are possible";
    GridMark mark{.axis = -1};
    if (const auto plane = after(word, "plane")) {
      const auto v = numbers(*plane);
      if (v.size() == 4) mark = {3, vec_at(v, 0), v[3]};
    } else {
      for (int a = 0; a < 3; ++a) {
        const auto along = after(word, std::string_view("xyz").substr(as_size(a), 1));
        const auto v = along ? numbers(*along) : std::vector<double>{};
        if (v.size() == 1) mark = {.axis = a, .at = v[0]};
      }
    }
    if (!mark.valid()) {
      return "x:AT, y:AT, z:AT or plane:nx,ny,nz,d is expected, with '/' between; found '" +
             std::string(word) + "'";
    }
    marks.mark[as_size(marks.count++)] = mark;
  }
  return std::nullopt;
}

std::string text_of(const PlanePoses& poses) {
  std::string text;
  for (int i = 0; i < poses.count; ++i) {
    const PlanePose& pose = poses.pose[as_size(i)];
    const Vec3& c = pose.center;
    const Vec4& q = pose.turn;
    if (i > 0) text += kBetween;
    text += exact_text({c.x, c.y, c.z, q.x, q.y, q.z, q.w});
  }
  return text;
}

std::optional<std::string> read_text(std::string_view text, PlanePoses& poses) {
  poses = {};
  if (text.empty()) return std::nullopt;
  for (const std::string_view word : split(text, kBetween)) {
    if (poses.count == PlanePoses::kMax)
      return "at most " + std::to_string(PlanePoses::kMax) + " planes are possible";
    const auto through = after(word, "through");
    const auto v = numbers(through.value_or(word));
    PlanePose pose{.turn = Vec4{0.0}};
    if (through && v.size() == 9) {
      const auto plane = pose_through({vec_at(v, 0), vec_at(v, 3), vec_at(v, 6)});
      if (plane) pose = *plane;
      if (!plane) return "three points on one line say no plane; found '" + std::string(word) + "'";
    }
    if (v.size() == 4 && glm::length(vec_at(v, 0)) > 0.0) pose = pose_of_plane(vec_at(v, 0), v[3], Vec3{0.0});
    if (v.size() == 7) pose = {vec_at(v, 0), {v[3], v[4], v[5], v[6]}};
    if (!pose.valid()) {
      return "nx,ny,nz,d, through:x,y,z,x,y,z,x,y,z or x,y,z and a unit quaternion is expected, with '/' "
             "between; found '" +
             std::string(word) + "'";
    }
    poses.pose[as_size(poses.count++)] = pose;
  }
  return std::nullopt;
}

PlanePose pose_of_plane(const Vec3& n, double d, const Vec3& near) {
  const double size = glm::length(n);
  const Vec3 unit = n / size;
  return turned_to({.center = near + (d / size - glm::dot(unit, near)) * unit}, unit);
}

std::optional<PlanePose> pose_through(const std::array<Vec3, 3>& points) {
  const Vec3 a = points[1] - points[0], b = points[2] - points[0], n = glm::cross(a, b);
  constexpr double kLeastSine = 1e-9;
  const double size = glm::length(n);
  if (!(size > kLeastSine * glm::length(a) * glm::length(b)) || !std::isfinite(size)) return std::nullopt;
  return turned_to({.center = (points[0] + points[1] + points[2]) / 3.0}, n / size);
}

Vec4 plane_of_pose(const PlanePose& pose) {
  Vec3 n = axes_of(pose)[2];
  // What a quaternion's rounding leaves beside an axis of the data is none of the user's doing.
  constexpr double kRounding = 1e-15;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(n[a]) < kRounding) n[a] = 0.0;
  }
  return {n, glm::dot(n, pose.center)};
}

}  // namespace palpate
