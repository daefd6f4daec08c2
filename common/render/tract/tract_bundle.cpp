#include "common/render/tract/tract_bundle.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <utility>

#include "common/render/line/line_geometry.h"

namespace palpate {
namespace {

/// Fisher and Yates with a generator whose numbers the standard fixes; std::shuffle's use of it is not.
void shuffle(std::vector<std::uint32_t>& order) {
  std::mt19937_64 random{7};
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random() % i]);
}

/// One number in [0, 1] a colour, by which two that follow each other on a scale differ.
std::vector<float> brightness(std::span<const std::uint32_t> colors) {
  constexpr float kWhite = 255.0F * 7.0F;
  std::vector<float> shades;
  shades.reserve(colors.size());
  for (const std::uint32_t color : colors) {
    const std::uint32_t red = color & 255U, green = color >> 8U & 255U, blue = color >> 16U & 255U;
    shades.push_back(static_cast<float>(2 * red + 4 * green + blue) / kWhite);
  }
  return shades;
}

}  // namespace

std::uint32_t packed_tangent(const Vec3f& tangent) noexcept {
  constexpr float kMost = 511.0F;
  constexpr std::uint32_t kTenBits = 1023;
  const auto bits = [&](float x) { return static_cast<std::uint32_t>(std::lround(kMost * x)) & kTenBits; };
  return bits(tangent.x) | bits(tangent.y) << 10U | bits(tangent.z) << 20U;
}

std::uint32_t packed_color(const Vec3f& srgb) noexcept {
  const auto bits = [](float x) {
    return static_cast<std::uint32_t>(std::lround(255.0F * std::clamp(x, 0.0F, 1.0F)));
  };
  return bits(srgb.x) | bits(srgb.y) << 8U | bits(srgb.z) << 16U;
}

std::vector<TractPoint> piece_points(const TractBundle& bundle, std::size_t piece, const SceneFrame& frame,
                                     double tolerance, std::vector<std::uint32_t>* colors) {
  const auto [first, last] = bundle.pieces[piece];
  std::vector<std::span<const Vec3f>> lines;
  std::vector<std::uint32_t> color_of;  // of the vertices
  lines.reserve(last - first);
  for (std::size_t i = first; i < last; ++i) {
    const std::size_t line = bundle.order[i];
    lines.push_back(bundle.lines->line(line));
    if (colors == nullptr) continue;
    color_of.insert(color_of.end(),
                    bundle.colors.begin() + static_cast<std::ptrdiff_t>(bundle.lines->starts[line]),
                    bundle.colors.begin() + static_cast<std::ptrdiff_t>(bundle.lines->starts[line + 1]));
  }
  const LineGeometry whole = make_line_geometry(lines, frame);
  const std::vector<LineSegment> segments = simplify(whole, brightness(color_of), tolerance);

  std::vector<TractPoint> points;
  points.reserve(segments.size() + 2 * lines.size());
  const auto add = [&](std::uint32_t number) {
    const LineVertex& vertex = whole.vertices[number];
    points.push_back({vertex.position, packed_tangent(vertex.tangent)});
    if (colors != nullptr) colors->push_back(color_of[number]);
  };
  if (colors != nullptr) colors->clear();
  std::uint32_t end = 0;
  for (const LineSegment& segment : segments) {
    if (points.empty() || segment.first != end) {
      if (!points.empty()) {
        points.push_back({.tangent = TractPoint::kBetweenLines});
        if (colors != nullptr) colors->push_back(TractBundle::kByDirection);
      }
      add(segment.first);
    }
    add(segment.last);
    end = segment.last;
  }
  return points;
}

namespace {

/// Parts of what is in order.
void part(TractBundle& bundle) {
  bundle.pieces.clear();
  std::size_t first = 0, points = 0;
  for (std::size_t i = 0; i < bundle.order.size(); ++i) {
    points += bundle.lines->line(bundle.order[i]).size();
    if (points < TractBundle::kPiecePoints && i + 1 < bundle.order.size()) continue;
    bundle.pieces.emplace_back(first, i + 1);
    first = i + 1;
    points = 0;
  }
}

}  // namespace

const std::shared_ptr<const TractBundle>& LengthFilter::of(const std::shared_ptr<const TractBundle>& whole,
                                                           double least, double most) {
  if (whole_ != whole) {
    whole_ = whole;
    part_.reset();
    lengths_.clear();
    longest_ = 0.0;
    for (const std::uint32_t number : whole->order) {
      const auto line = whole->lines->line(number);
      double length = 0.0;
      for (std::size_t p = 1; p < line.size(); ++p) length += glm::distance(Vec3(line[p - 1]), Vec3(line[p]));
      lengths_.push_back(length);
      if (std::isfinite(length)) longest_ = std::max(longest_, length);
    }
  }
  if (least <= 0.0 && most >= longest_) return whole_;
  if (part_ && least_ == least && most_ == most) return part_;
  least_ = least;
  most_ = most;
  auto shown = std::make_shared<TractBundle>(TractBundle{
      .lines = whole->lines, .order = {}, .pieces = {}, .bounds = whole->bounds, .colors = whole->colors});
  for (std::size_t i = 0; i < lengths_.size(); ++i) {
    if (lengths_[i] >= least && lengths_[i] <= most) shown->order.push_back(whole->order[i]);
  }
  part(*shown);
  part_ = shown;
  return part_;
}

std::shared_ptr<const TractBundle> make_tract_bundle(std::shared_ptr<const Tractogram> lines,
                                                     std::vector<std::uint32_t> colors) {
  auto bundle = std::make_shared<TractBundle>();
  for (std::size_t i = 0; i < lines->line_count(); ++i) {
    if (lines->line(i).size() > 1) bundle->order.push_back(static_cast<std::uint32_t>(i));
  }
  shuffle(bundle->order);
  for (const Vec3f& point : lines->points) {
    if (is_finite(Vec3(point))) bundle->bounds.include(Vec3(point));
  }
  bundle->lines = std::move(lines);
  bundle->colors = std::move(colors);
  part(*bundle);
  return bundle;
}

std::size_t pieces_with_room(const TractBundle& bundle, std::size_t room) noexcept {
  return std::min(bundle.pieces.size(), room);
}

std::string tracts_left_out(const TractBundle& bundle, std::size_t room) {
  const std::size_t pieces = pieces_with_room(bundle, room);
  if (pieces == bundle.pieces.size()) return {};
  const std::size_t drawn = pieces > 0 ? bundle.pieces[pieces - 1].second : 0;
  return std::to_string(drawn) + " of " + std::to_string(bundle.order.size()) +
         " tracts are drawn, an even sample: all have " + std::to_string(bundle.lines->points.size()) +
         " points, and a picture has room for about " + std::to_string(room * TractBundle::kPiecePoints) +
         "; trace with a longer --step to see more of them";
}

}  // namespace palpate
