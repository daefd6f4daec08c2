#include "common/window/immersive/space_menu.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/base/check.h"
#include "common/base/text.h"
#include "common/haptics/constraint/detent_marks.h"

namespace palpate {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
// Of a column, in heights of an entry.
constexpr double kMargin = 0.4, kText = 0.62, kGap = 0.25;
constexpr double kTrackLeft = 0.6, kTrackRight = SpaceMenu::kColumn - 0.6, kTrackDown = 1.05;
constexpr double kKnobRadius = 0.9, kKnobLeft = 1.5, kKnobDown = 1.5;
constexpr double kSliderReach = 0.45;  // by which the hand may miss a slider's way

// sRGB.
const Vec3f kPanel{0.10F, 0.12F, 0.15F}, kPointed{0.13F, 0.42F, 0.46F}, kTrack{0.35F, 0.39F, 0.44F},
    kHandle{0.93F, 0.95F, 0.97F}, kActive{0.98F, 0.80F, 0.30F}, kWords{0.92F, 0.94F, 0.96F};

double height_of(const SpaceItem& item) {
  switch (item.kind) {
    case SpaceItem::Kind::kSlider:
      return 1.5;
    case SpaceItem::Kind::kKnob:
      return 3.0;
    case SpaceItem::Kind::kEntry:
      break;
  }
  return 1.0;
}

double height_of(const std::vector<SpaceItem>& items) {
  double height = 0.0;
  for (const SpaceItem& item : items) height += height_of(item);
  return height;
}

/// The slider or knob of an id; null where there is none.
template <class Items>
auto dial_of(Items& items, int id) -> decltype(items.data()) {
  for (auto& item : items) {
    if (item.kind != SpaceItem::Kind::kEntry && item.id == id) return &item;
    if (auto* found = dial_of(item.behind, id)) return found;
  }
  return nullptr;
}

/// Of menu places, with v down; the label's y is up.
LabelShape box(double u, double v, double width, double height, const Vec3f& color, float opacity) {
  return {{{u, -v - height}, {u + width, -v - height}, {u + width, -v}, {u, -v}}, color, opacity};
}

LabelShape disc(const Vec2& middle, double radius, const Vec3f& color) {
  constexpr int kCorners = 32;
  LabelShape shape{.corners = {}, .color = color, .opacity = 1.0F};
  for (int i = 0; i < kCorners; ++i) {
    const double angle = kTurn * i / kCorners;
    shape.corners.push_back({middle.x + radius * std::cos(angle), -middle.y + radius * std::sin(angle)});
  }
  return shape;
}

/// A bar from a to b.
LabelShape bar(const Vec2& a, const Vec2& b, double width, const Vec3f& color) {
  const Vec2 from{a.x, -a.y}, to{b.x, -b.y}, along = glm::normalize(to - from);
  const Vec2 side = 0.5 * width * Vec2{-along.y, along.x};
  return {{from - side, to - side, to + side, from + side}, color, 1.0F};
}

/// Where on a knob a part of its turn is: from the bottom, clockwise as seen.
Vec2 knob_way(const Vec2& middle, double radius, double part) {
  const double angle = kTurn * part;
  return middle + radius * Vec2{-std::sin(angle), std::cos(angle)};
}

std::string value_text(double value) {
  constexpr double kDigits = 1e3;
  return short_number(std::round(kDigits * value) / kDigits);
}

/// Detents are drawn where they are not too many to be told apart.
int detents_of(const DialRange& range) {
  constexpr double kMost = 40.0;
  if (!(range.step > 0.0)) return 0;
  const double count = (range.upper - range.lower) / range.step;
  return count <= kMost ? static_cast<int>(std::round(count)) + 1 : 0;
}

void draw_slider(const SpaceItem& item, double u, double v, bool active, LabelView& label) {
  const double y = v + kTrackDown, length = kTrackRight - kTrackLeft;
  label.shapes.push_back(box(u + kTrackLeft, y - 0.06, length, 0.12, kTrack, 1.0F));
  const int detents = detents_of(item.range);
  for (int i = 0; i < detents; ++i) {
    const double at = u + kTrackLeft + length * i / std::max(detents - 1, 1);
    label.shapes.push_back(box(at - 0.03, y - 0.18, 0.06, 0.36, kTrack, 1.0F));
  }
  const double handle = u + kTrackLeft + length * item.range.part(item.value);
  label.shapes.push_back(disc({handle, y}, 0.26, active ? kActive : kHandle));
}

void draw_knob(const SpaceItem& item, double u, double v, bool active, LabelView& label) {
  const Vec2 middle{u + kKnobLeft, v + kKnobDown};
  const int detents = detents_of(item.range);
  for (int i = 0; i + 1 < detents; ++i) {
    const double part = static_cast<double>(i) / (detents - 1);
    label.shapes.push_back(
        bar(knob_way(middle, kKnobRadius, part), knob_way(middle, 1.2 * kKnobRadius, part), 0.06, kTrack));
  }
  label.shapes.push_back(disc(middle, kKnobRadius, active ? kActive : kTrack));
  const double part = item.range.part(item.value);
  label.shapes.push_back(bar(knob_way(middle, 0.3 * kKnobRadius, part),
                             knob_way(middle, 0.95 * kKnobRadius, part), 0.14, kHandle));
}

}  // namespace

SpaceMenu::SpaceMenu(std::vector<SpaceItem> items) : items_(std::move(items)) {}

void SpaceMenu::put(const Vec3& corner, const Mat3& axes, double entry) noexcept {
  corner_ = corner;
  axes_ = axes;
  entry_ = entry;
}

std::vector<SpaceMenu::Placed> SpaceMenu::placed() const {
  std::vector<Placed> out;
  const std::vector<SpaceItem>* column = &items_;
  Path path;
  double u = 0.0, top = 0.0;
  for (std::size_t depth = 0; column != nullptr; ++depth) {
    const std::vector<SpaceItem>* next = nullptr;
    double v = top, next_top = 0.0;
    for (std::size_t i = 0; i < column->size(); ++i) {
      const SpaceItem& item = (*column)[i];
      Placed placed{path, &item, u, v, height_of(item)};
      placed.path.push_back(i);
      if (depth < open_.size() && open_[depth] == i) {
        next = &item.behind;
        next_top = v;
      }
      v += placed.height;
      out.push_back(std::move(placed));
    }
    if (next == nullptr) break;
    path.push_back(open_[depth]);
    column = next;
    u += kColumn + kGap;
    top = next_top;
  }
  return out;
}

std::optional<Vec2> SpaceMenu::met(const Ray& ray) const {
  // A ray along the menu meets it nowhere.
  constexpr double kLeastSlope = 1e-6;
  const double slope = glm::dot(ray.direction, axes_[2]);
  if (!(std::abs(slope) > kLeastSlope)) return std::nullopt;
  const double along = glm::dot(corner_ - ray.origin, axes_[2]) / slope;
  if (!(along > 0.0)) return std::nullopt;
  const Vec3 at = (ray.origin + along * ray.direction - corner_) / entry_;
  return Vec2{glm::dot(at, axes_[0]), -glm::dot(at, axes_[1])};
}

bool SpaceMenu::meets(const Ray& ray) const {
  if (held_) return true;
  const auto at = met(ray);
  if (!at) return false;
  for (const Placed& p : placed()) {
    if (at->x >= p.u && at->x < p.u + kColumn && at->y >= p.v && at->y < p.v + p.height) return true;
  }
  return false;
}

const SpaceItem& SpaceMenu::item_at(const Path& path) const {
  const std::vector<SpaceItem>* column = &items_;
  for (std::size_t i = 0; i + 1 < path.size(); ++i) column = &(*column)[path[i]].behind;
  return (*column)[path.back()];
}

SpaceItem& SpaceMenu::item_at(const Path& path) {
  return const_cast<SpaceItem&>(std::as_const(*this).item_at(path));  // NOLINT(*-const-cast)
}

std::optional<Dial> SpaceMenu::held_way() const {
  if (!held_) return std::nullopt;
  const SpaceItem& item = item_at(held_->path);
  const auto in_space = [this](const Vec2& at) {
    return corner_ + entry_ * (at.x * axes_[0] - at.y * axes_[1]);
  };
  const auto steps =
      item.range.step > 0.0
          ? static_cast<int>(std::lround((item.range.upper - item.range.lower) / item.range.step))
          : 0;
  Dial dial{.normal = axes_[2]};
  if (item.kind == SpaceItem::Kind::kSlider) {
    dial.start = in_space(held_->middle);
    dial.end = in_space(held_->middle + Vec2{kTrackRight - kTrackLeft, 0.0});
    dial.detents = steps + 1;
  } else {
    dial.kind = Dial::Kind::kKnob;
    dial.start = in_space(held_->middle + kKnobRadius * Vec2{std::cos(held_->least), std::sin(held_->least)});
    dial.end = in_space(held_->middle);
    dial.detents = steps;
  }
  if (dial.detents > static_cast<int>(DetentMarks::kMost)) dial.detents = 0;
  return dial;
}

double SpaceMenu::value(int id) const {
  const auto* item = dial_of(items_, id);
  PALPATE_CHECK(item != nullptr);
  return item->value;
}

void SpaceMenu::set(int id, double value) {
  auto* item = dial_of(items_, id);
  PALPATE_CHECK(item != nullptr);
  if (!held_) item->value = value;
}

void SpaceMenu::leave() noexcept {
  held_.reset();
  pointed_.reset();
  button_ = false;
}

SpaceEvent SpaceMenu::drag(const Vec2& at) {
  SpaceItem& item = item_at(held_->path);
  if (item.kind == SpaceItem::Kind::kSlider) {
    held_->from = item.range.at_part((at.x - held_->middle.x) / (kTrackRight - kTrackLeft));
  } else {
    const Vec2 d = at - held_->middle;
    // In the middle a hand has no angle.
    if (!(glm::length(d) > 0.1 * kKnobRadius)) return {};
    const double angle = std::atan2(d.y, d.x);
    held_->from +=
        (item.range.upper - item.range.lower) * std::remainder(angle - held_->angle, kTurn) / kTurn;
    held_->angle = angle;
  }
  const double value = item.range.held(held_->from, item.value);
  if (value == item.value) return {};
  item.value = value;
  return {SpaceEvent::Kind::kSet, item.id, value};
}

SpaceEvent SpaceMenu::point(const Ray& ray, bool button) {
  const bool was_down = std::exchange(button_, button), pressed = button && !was_down;
  const auto at = met(ray);
  if (held_) {
    if (!button) held_.reset();
    if (held_ && at) return drag(*at);
    if (held_) return {};
  }
  pointed_.reset();
  if (!at) return {};
  // Columns further on lie over none of those before.
  std::optional<Placed> found;
  for (Placed& p : placed()) {
    if (at->x >= p.u && at->x < p.u + kColumn && at->y >= p.v && at->y < p.v + p.height) found = std::move(p);
  }
  if (!found) return {};
  pointed_ = found->path;
  const SpaceItem& item = *found->item;
  // Pointing opens what is behind an entry, and closes what is not on the way to it.
  Path open(found->path.begin(), found->path.end() - 1);
  if (!item.behind.empty()) open = found->path;
  open_ = std::move(open);
  if (!pressed) return {};
  SpaceItem& chosen = item_at(*pointed_);
  switch (chosen.kind) {
    case SpaceItem::Kind::kEntry:
      if (!chosen.behind.empty()) return {};
      return {SpaceEvent::Kind::kChosen, chosen.id, 0.0};
    case SpaceItem::Kind::kSlider: {
      const Vec2 left{found->u + kTrackLeft, found->v + kTrackDown};
      if (std::abs(at->y - left.y) > kSliderReach) return {};
      held_ = Held{*pointed_, left, chosen.value};
      return drag(*at);
    }
    case SpaceItem::Kind::kKnob: {
      const Vec2 middle{found->u + kKnobLeft, found->v + kKnobDown}, d = *at - middle;
      if (glm::length(d) > 1.3 * kKnobRadius) return {};
      const double angle = std::atan2(d.y, d.x);
      held_ = Held{*pointed_, middle, chosen.value, angle, angle - kTurn * chosen.range.part(chosen.value)};
      return {};
    }
  }
  return {};
}

std::string SpaceMenu::pointed_label() const {
  if (!pointed_) return {};
  const std::vector<SpaceItem>* column = &items_;
  for (std::size_t i = 0; i + 1 < pointed_->size(); ++i) column = &(*column)[(*pointed_)[i]].behind;
  return (*column)[pointed_->back()].label;
}

LabelView SpaceMenu::drawn() const {
  LabelView label{.origin = corner_, .axes = axes_, .unit = entry_};
  std::size_t depth = 0;
  for (const Placed& p : placed()) {
    // Each column has a background of its own.
    if (p.path.size() != depth) {
      depth = p.path.size();
      const std::vector<SpaceItem>* column = &items_;
      for (std::size_t i = 0; i + 1 < p.path.size(); ++i) column = &(*column)[p.path[i]].behind;
      label.shapes.push_back(box(p.u, p.v, kColumn, height_of(*column), kPanel, 0.85F));
    }
    const bool on_way = p.path.size() <= open_.size() && open_[p.path.size() - 1] == p.path.back();
    const bool pointed = pointed_ == p.path, active = held_ && held_->path == p.path;
    if (pointed || on_way || active) label.shapes.push_back(box(p.u, p.v, kColumn, p.height, kPointed, 0.9F));
    const SpaceItem& item = *p.item;
    std::string words = item.label;
    Vec2 place{p.u + kMargin, -p.v - 0.5};
    switch (item.kind) {
      case SpaceItem::Kind::kEntry:
        if (!item.behind.empty()) {
          const double right = p.u + kColumn - 0.6;
          label.shapes.push_back(
              {{{right, -p.v - 0.7}, {right + 0.3, -p.v - 0.5}, {right, -p.v - 0.3}}, kWords, 1.0F});
        }
        break;
      case SpaceItem::Kind::kSlider:
        words += "  " + value_text(item.value);
        place.y = -p.v - 0.42;
        draw_slider(item, p.u, p.v, active, label);
        break;
      case SpaceItem::Kind::kKnob:
        draw_knob(item, p.u, p.v, active, label);
        place = {p.u + kKnobLeft + 1.5 * kKnobRadius, -p.v - kKnobDown + 0.4};
        label.texts.push_back({{place.x, place.y - 0.8}, kText, value_text(item.value), kWords});
        break;
    }
    label.texts.push_back({place, kText, std::move(words), kWords});
  }
  return label;
}

}  // namespace palpate
