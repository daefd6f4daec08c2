#include "common/geometry/annotation.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/base/text.h"

namespace palpate {

PointsNeeded points_needed(AnnotationKind kind) noexcept {
  switch (kind) {
    case AnnotationKind::kPoint:
      return {1, 1};
    case AnnotationKind::kLength:
      return {2, 2};
    case AnnotationKind::kAngle:
      return {3, 3};
    case AnnotationKind::kCurve:
      return {2, 0};
    case AnnotationKind::kArea:
      return {3, 0};
  }
  return {};
}

double measure_of(const Annotation& annotation) noexcept {
  const std::vector<Vec3>& x = annotation.points;
  const PointsNeeded needed = points_needed(annotation.kind);
  if (x.size() < needed.least) return std::numeric_limits<double>::quiet_NaN();
  switch (annotation.kind) {
    case AnnotationKind::kPoint:
      return 0.0;
    case AnnotationKind::kLength:
    case AnnotationKind::kCurve: {
      double length = 0.0;
      for (std::size_t i = 1; i < x.size(); ++i) length += glm::distance(x[i - 1], x[i]);
      return length;
    }
    case AnnotationKind::kAngle: {
      const Vec3 a = x[0] - x[1], b = x[2] - x[1];
      if (a == Vec3{0.0} || b == Vec3{0.0}) return std::numeric_limits<double>::quiet_NaN();
      constexpr double kHalfTurn = 180.0;
      return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * kHalfTurn / std::numbers::pi;
    }
    case AnnotationKind::kArea: {
      // From the first point: far from the origin the products would cancel.
      Vec3 sum{0.0};
      for (std::size_t i = 2; i < x.size(); ++i) sum += glm::cross(x[i - 1] - x[0], x[i] - x[0]);
      return 0.5 * glm::length(sum);
    }
  }
  return 0.0;
}

std::string measure_text(const Annotation& annotation, const std::string& unit) {
  const std::string number = short_number(measure_of(annotation));
  switch (annotation.kind) {
    case AnnotationKind::kPoint:
      return {};
    case AnnotationKind::kAngle:
      return number + " degrees";
    case AnnotationKind::kArea:
      return number + (unit.empty() ? " square units" : " " + unit + "^2");
    default:
      return number + " " + (unit.empty() ? "units" : unit);
  }
}

std::vector<Vec3> outline_of(const Annotation& annotation) {
  std::vector<Vec3> points = annotation.points;
  if (annotation.kind == AnnotationKind::kArea && !points.empty()) points.push_back(points.front());
  return points;
}

std::string text_of(const Annotation& annotation) {
  std::string text(name_of(annotation.kind));
  for (std::size_t i = 0; i < annotation.points.size(); ++i) {
    for (int a = 0; a < 3; ++a)
      (text += i == 0 && a == 0 ? ':' : ',') += exact_number(annotation.points[i][a]);
  }
  if (!annotation.label.empty()) text += "=" + annotation.label;
  return text;
}

std::optional<std::string> read_text(std::string_view text, Annotation& annotation) {
  annotation = {};
  const std::string found = "; found '" + std::string(text) + "'";
  const std::size_t colon = text.find(':'), equals = text.find('=');
  bool known = false;
  for (int i = 0; i < kAnnotationKindCount && !known; ++i) {
    annotation.kind = static_cast<AnnotationKind>(i);
    known = text.substr(0, colon) == name_of(annotation.kind);
  }
  if (!known || colon == std::string_view::npos)
    return "point, length, angle, curve or area, ':' and places are expected" + found;
  if (equals != std::string_view::npos) annotation.label = trimmed(text.substr(equals + 1));
  // Sessions part annotations by ';'.
  if (annotation.label.find_first_of(";\n\r\"") != std::string::npos)
    return "a label has no ';', no quotes and no line ends" + found;
  std::vector<double> numbers;
  for (const std::string_view word : split(text.substr(colon + 1, equals - colon - 1), ',')) {
    const std::optional<double> value = number(word);
    if (!value || !std::isfinite(*value)) return "x,y,z of each place is expected" + found;
    numbers.push_back(*value);
  }
  const PointsNeeded needed = points_needed(annotation.kind);
  const std::size_t count = numbers.size() / 3;
  if (numbers.size() % 3 != 0 || count < needed.least || (needed.most > 0 && count > needed.most)) {
    return std::string(name_of(annotation.kind)) + " takes " + (needed.most == 0 ? "at least " : "") +
           counted(needed.least, "place") + " of three numbers" + found;
  }
  for (std::size_t i = 0; i < count; ++i)
    annotation.points.emplace_back(numbers[3 * i], numbers[3 * i + 1], numbers[3 * i + 2]);
  return std::nullopt;
}

}  // namespace palpate
