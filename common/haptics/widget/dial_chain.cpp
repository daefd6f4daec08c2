#include "common/haptics/widget/dial_chain.h"

#include <cmath>
#include <initializer_list>
#include <numbers>
#include <utility>
#include <vector>

#include "common/base/text.h"
#include "common/haptics/constraint/detent_marks.h"
#include "common/haptics/constraint/shape.h"

namespace palpate {
namespace {

constexpr std::string_view kSliderWord = "slider:", kKnobWord = "knob:";

std::string with_commas(std::initializer_list<Vec3> places, int count) {
  std::string text;
  for (const Vec3& x : places) {
    for (int axis = 0; axis < 3; ++axis) text += exact_number(x[axis]) + ",";
  }
  return text + std::to_string(count);
}

/// Numbers with commas between, as many as asked for; none where one is no finite number.
std::vector<double> finite_numbers(std::string_view text, std::size_t count) {
  std::vector<double> values;
  for (const std::string_view word : split(text, ',')) {
    const std::optional<double> value = number(word);
    if (!value || !std::isfinite(*value)) return {};
    values.push_back(*value);
  }
  return values.size() == count ? values : std::vector<double>();
}

std::vector<Vec3> marks_of(const Dial& dial) {
  std::vector<Vec3> marks;
  if (dial.detents < 2) return marks;
  if (dial.kind == Dial::Kind::kSlider) {
    for (int i = 0; i < dial.detents; ++i)
      marks.push_back(glm::mix(dial.start, dial.end, static_cast<double>(i) / (dial.detents - 1)));
    return marks;
  }
  const Vec3 n = glm::normalize(dial.normal), away = dial.start - dial.end;
  const Vec3 u = away - glm::dot(away, n) * n, t = glm::cross(n, u);
  for (int i = 0; i < dial.detents; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / dial.detents;
    marks.push_back(dial.end + std::cos(angle) * u + std::sin(angle) * t);
  }
  return marks;
}

std::unique_ptr<Constraint> way_of(const Dial& dial) {
  if (dial.kind == Dial::Kind::kSlider) return std::make_unique<PolylineConstraint>(dial.start, dial.end);
  const Vec3 n = glm::normalize(dial.normal), away = dial.start - dial.end;
  const double radius = glm::length(away - glm::dot(away, n) * n);
  return std::make_unique<CircleConstraint>(dial.end, n, radius);
}

}  // namespace

std::unique_ptr<ProxyChain> make_dial_chain(const Dial& dial, const ChainSettings& settings) {
  std::vector<std::unique_ptr<Constraint>> links;
  links.push_back(way_of(dial));
  if (const std::vector<Vec3> marks = marks_of(dial); marks.size() > 1) {
    constexpr double kPart = 0.5;  // of the distance between neighbours: one ends where the next begins
    links.push_back(std::make_unique<DetentMarks>(marks, kPart * glm::distance(marks[0], marks[1])));
  }
  return std::make_unique<ProxyChain>(std::move(links), settings);
}

std::string text_of(const Dial& dial) {
  if (dial.kind == Dial::Kind::kSlider)
    return std::string(kSliderWord) + with_commas({dial.start, dial.end}, dial.detents);
  return std::string(kKnobWord) + with_commas({dial.end, dial.normal, dial.start}, dial.detents);
}

bool names_dial(std::string_view text) noexcept {
  return text.starts_with(kSliderWord) || text.starts_with(kKnobWord);
}

std::optional<std::string> read_text(std::string_view text, Dial& dial) {
  dial = {};
  const bool knob = text.starts_with(kKnobWord);
  const std::string_view word = knob ? kKnobWord : kSliderWord;
  const auto v = text.starts_with(word) ? finite_numbers(text.substr(word.size()), knob ? 10 : 7)
                                        : std::vector<double>();
  const auto most = static_cast<double>(DetentMarks::kMost);
  if (v.empty() || !(v.back() >= 0.0 && v.back() <= most) || v.back() != std::floor(v.back()))
    return "slider:ax,ay,az,bx,by,bz,N or knob:cx,cy,cz,nx,ny,nz,sx,sy,sz,N is expected, with N of 0 to 128";
  const auto place = [&v](std::size_t first) { return Vec3{v[first], v[first + 1], v[first + 2]}; };
  dial.detents = static_cast<int>(v.back());
  dial.kind = knob ? Dial::Kind::kKnob : Dial::Kind::kSlider;
  dial.start = place(knob ? 6 : 0);
  dial.end = place(knob ? 0 : 3);
  if (knob) dial.normal = place(3);
  const Vec3 away = dial.start - dial.end;
  const bool sound = knob ? glm::length(glm::cross(away, dial.normal)) > 0.0 : glm::length(away) > 0.0;
  if (!sound) return "a slider or knob of no size";
  return std::nullopt;
}

}  // namespace palpate
