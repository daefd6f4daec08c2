#include "common/render/overlay/overlay_colors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "common/base/index.h"
#include "common/render/ticks.h"

namespace palpate {
namespace {

// Colour patches with words, from `top` down, right-aligned to `right`.
struct LegendEntry {
  Rgb color;
  std::string text;
};

void draw_legend(const OverlayPen& pen, const std::string& label, const std::vector<LegendEntry>& entries,
                 float right, float middle) {
  const float em = pen.text_height(), line = 1.45F * em;
  float widest = 0.0F;
  for (const LegendEntry& entry : entries) widest = std::max(widest, pen.size_of(entry.text).x);
  const float left = right - widest - 1.5F * em;
  float y = middle - 0.5F * line * static_cast<float>(entries.size());
  if (!label.empty()) pen.text(right, y - 1.6F * em, label, pen.ink(), 1.0F);
  for (const LegendEntry& entry : entries) {
    pen.list().AddRectFilled({left, y + 0.08F * em}, {left + 0.95F * em, y + 1.03F * em}, packed(entry.color),
                             0.2F * em);
    pen.text(left + 1.5F * em, y, entry.text, pen.ink());
    y += line;
  }
}

// A scale of colours with its numbers.
struct ColorScale {
  std::string label;
  std::span<const Rgb> table;  // from the lower to the upper end
  ValueRange range;
  bool logarithmic = false;
  bool values_below = false, values_above = false;
};

// @return the bar's left border.
float draw_color_bar(const OverlayPen& pen, const ColorScale& scale, float right, float middle,
                     float length) {
  const float em = pen.text_height(), thickness = 0.9F * em;
  const int most = std::clamp(static_cast<int>(length / (2.6F * em)), 2, 9);
  const std::vector<Tick> marks = ticks(scale.range, scale.logarithmic, most);
  float widest = 0.0F;
  for (const Tick& tick : marks) widest = std::max(widest, pen.size_of(tick.text).x);

  const float x1 = right - widest - 0.6F * em, x0 = x1 - thickness;
  const float top = middle - 0.5F * length, bottom = middle + 0.5F * length;
  const std::span<const Rgb> table = scale.table;
  // One quad between entries, shaded by the rasteriser.
  for (std::size_t i = 0; i + 1 < table.size(); ++i) {
    const auto at = [&](std::size_t k) {
      return bottom - length * static_cast<float>(k) / static_cast<float>(table.size() - 1);
    };
    const ImU32 low = packed(table[i]), high = packed(table[i + 1]);
    pen.list().AddRectFilledMultiColor({x0, at(i + 1)}, {x1, at(i)}, high, high, low, low);
  }
  // Tips where values lie beyond the range: they get the end's colour.
  const float tip = 0.7F * thickness;
  if (scale.values_above) {
    pen.list().AddTriangleFilled({x0, top}, {x1, top}, {0.5F * (x0 + x1), top - tip}, packed(table.back()));
  }
  if (scale.values_below) {
    pen.list().AddTriangleFilled({x0, bottom}, {x1, bottom}, {0.5F * (x0 + x1), bottom + tip},
                                 packed(table.front()));
  }
  const ValueRange& range = scale.range;
  for (const Tick& tick : marks) {
    double t = 0.5;
    if (range.upper > range.lower) {
      t = scale.logarithmic ? std::log10(tick.value / range.lower) / std::log10(range.upper / range.lower)
                            : (tick.value - range.lower) / (range.upper - range.lower);
    }
    const float y = bottom - length * static_cast<float>(std::clamp(t, 0.0, 1.0));
    pen.list().AddLine({x1, y}, {x1 + 0.25F * em, y}, pen.ink(), std::max(1.0F, em / 16.0F));
    pen.text(x1 + 0.45F * em, y - 0.55F * em, tick.text, pen.ink());
  }
  pen.text(right, top - tip - 1.6F * em, scale.label, pen.ink(), 1.0F);
  return x0;
}

// A column at the right border, `length` high about `middle`.
void draw_line_colors(const OverlayPen& pen, const SceneView& view, const ColorLegend& legend, float right,
                      float middle, float length) {
  switch (view.style.color_by) {
    case ColorBy::kUniform:
      return;
    case ColorBy::kDirection:
      draw_legend(pen, "direction",
                  {{{1.0F, 0.1F, 0.1F}, "x"}, {{0.1F, 1.0F, 0.1F}, "y"}, {{0.1F, 0.1F, 1.0F}, "z"}}, right,
                  middle);
      return;
    case ColorBy::kTermination: {
      std::vector<LegendEntry> entries;
      for (int k = 0; k < kEndCount; ++k) {
        const std::size_t count = legend.ends[as_size(k)];
        if (count == 0) continue;
        std::string name(name_of(static_cast<End>(k)));
        std::replace(name.begin(), name.end(), '_', ' ');
        entries.push_back({map_color(ColorMap::kCategorical, (k + 0.5) / kCategoryCount),
                           name + "  " + std::to_string(count)});
      }
      draw_legend(pen, color_label(view.style, view.units), entries, right, middle);
      return;
    }
    default:
      draw_color_bar(pen,
                     {.label = color_label(view.style, view.units),
                      .table = color_table(color_map_of(view.style)),
                      .range = legend.range,
                      .logarithmic = is_logarithmic(view.style),
                      .values_below = legend.values_below,
                      .values_above = legend.values_above},
                     right, middle, length);
  }
}

// Of each value what is most opaque of it, whatever its gradient.
std::vector<ColorSample> deepest_colors(const RegionTransfer& regions, const ValueRange& range,
                                        std::size_t count) {
  constexpr int kRows = 64;
  std::vector<ColorSample> samples(count);
  const PlaceRange places = regions.extent();
  if (places.empty()) return samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double value =
        std::lerp(range.lower, range.upper, static_cast<double>(i) / static_cast<double>(count - 1));
    double deepest = 0.0;
    for (int row = 0; row <= kRows; ++row) {
      const double gradient = std::max(0.0, places.upper.y) * row / kRows;
      const RegionTransfer::Sample sample = regions.at({value, gradient});
      if (!(sample.depth > deepest)) continue;
      deepest = sample.depth;
      samples[i] = {sample.color, 1.0 - std::exp(-sample.depth)};
    }
  }
  return samples;
}

// The values that a bar spreads its colours over: all of them, but where a transfer function tells apart no more than a 256th
// of their range, those of its points.
ValueRange distinguished(const VolumeView& volume) {
  const ValueRange all{volume.image->lowest, volume.image->highest};
  const auto& points = volume.transfer.points();
  if (volume.regions || points.empty()) return all;
  constexpr double kNarrow = 1.0 / 256.0;
  const ValueRange shown{points.front().value, points.back().value};
  const bool narrow =
      shown.lower < shown.upper && shown.upper - shown.lower < kNarrow * (all.upper - all.lower);
  return narrow ? shown : all;
}

// The values of a volume: their colours, and beside them how opaque they are.
void draw_volume_colors(const OverlayPen& pen, const SceneView& view, float right, float middle,
                        float length) {
  const VolumeView& volume = *view.volume;
  const ValueRange range = distinguished(volume);
  if (!(range.lower < range.upper)) return;
  constexpr std::size_t kEntries = 128;
  const std::vector<ColorSample> samples = volume.regions
                                               ? deepest_colors(*volume.regions, range, kEntries)
                                               : volume.transfer.table(range.lower, range.upper, kEntries);
  std::vector<Rgb> colors;
  colors.reserve(samples.size());
  for (const ColorSample& sample : samples)
    colors.push_back({sample.color.r, sample.color.g, sample.color.b});
  const float left = draw_color_bar(
      pen,
      {.label = view.volume_label,
       .table = colors,
       .range = range,
       .values_below = volume.image->lowest<range.lower, .values_above = volume.image->highest> range.upper},
      right, middle, length);
  const float em = pen.text_height(), base = left - 0.3F * em, widest = 2.0F * em;
  const auto place = [&](std::size_t i) {
    const float y = middle + length * (0.5F - static_cast<float>(i) / static_cast<float>(kEntries - 1));
    return ImVec2(base - widest * static_cast<float>(samples[i].opacity), y);
  };
  for (std::size_t i = 0; i + 1 < kEntries; ++i)
    pen.list().AddLine(place(i), place(i + 1), pen.faint_ink(), std::max(1.0F, em / 12.0F));
}

// The parts of a label map by name; of many the first ones.
void draw_labels(const OverlayPen& pen, const std::string& label, const LabelTable& table, float right,
                 float middle, float length) {
  const auto most = as_size(std::max(1, static_cast<int>(length / (1.45F * pen.text_height()))));
  const std::vector<Label>& labels = table.labels();
  std::vector<LegendEntry> entries;
  for (const Label& label : labels) {
    if (entries.size() == most) break;
    entries.push_back({{label.color.r, label.color.g, label.color.b}, label.name});
  }
  const std::size_t left_out = labels.size() - entries.size();
  draw_legend(pen, label + (left_out > 0 ? ", " + std::to_string(left_out) + " more" : ""), entries, right,
              middle);
}

// What lies over a slice.
void draw_blend_colors(const OverlayPen& pen, const SliceBlend& blend, float right, float height) {
  const float middle = 0.5F * height, length = 0.5F * height;
  if (blend.image->labels) {
    draw_labels(pen, blend.name, *blend.image->labels, right, middle, length);
    return;
  }
  const ValueWindow& window = blend.window;
  const ValueRange range{window.level - 0.5 * window.width, window.level + 0.5 * window.width};
  if (!(range.lower < range.upper)) return;
  draw_color_bar(
      pen,
      {.label = blend.name,
       .table = color_table(blend.map),
       .range = range,
       .values_below = blend.image->lowest<range.lower, .values_above = blend.image->highest> range.upper},
      right, middle, length);
}

void draw_directions(const OverlayPen& pen, bool anatomical, float right, float middle) {
  const std::array<const char*, 3> axes =
      anatomical ? std::array<const char*, 3>{"left, right", "back, front", "feet, head"}
                 : std::array<const char*, 3>{"x", "y", "z"};
  draw_legend(pen, "direction",
              {{{1.0F, 0.1F, 0.1F}, axes[0]}, {{0.1F, 1.0F, 0.1F}, axes[1]}, {{0.1F, 0.1F, 1.0F}, axes[2]}},
              right, middle);
}

// The colours of slices and glyphs.
void draw_tensor_colors(const OverlayPen& pen, const SceneView& view, float right, float middle,
                        float length) {
  const bool tensors = view.tensors && view.tensors->image->field;
  if (!tensors || view.tensors->color == TensorColor::kDirection) {
    draw_directions(pen, view.anatomical, right, middle);
    return;
  }
  const std::array<Rgb, 2> greys{Rgb(0.0F), Rgb(1.0F)};
  draw_color_bar(pen, {.label = "FA", .table = greys, .range = {0.0, 1.0}}, right, middle, length);
}

bool shows_path(const SceneView& view) { return view.probe && view.probe->path.count > 0; }

// Where the middle of a column of colours stands, and how long it is, in heights of the picture.
struct ColumnPlace {
  float middle, length;
};
// Columns share the border, from above: so many, and which of them.
ColumnPlace column_place(std::size_t count, std::size_t which) {
  constexpr std::array<ColumnPlace, 2> kTwo{{{0.31F, 0.30F}, {0.74F, 0.26F}}};
  constexpr std::array<ColumnPlace, 3> kThree{{{0.19F, 0.19F}, {0.47F, 0.19F}, {0.76F, 0.19F}}};
  if (count == 2) return kTwo[which];
  return count == 3 ? kThree[which] : ColumnPlace{0.5F, 0.46F};
}

// From the right border to the left one: all that was drawn since there were `first` corners.
void move_to_left(const OverlayPen& pen, int first, float left) {
  ImVector<ImDrawVert>& corners = pen.list().VtxBuffer;
  float least = HUGE_VALF;
  for (int i = first; i < corners.Size; ++i) least = std::min(least, corners[i].pos.x);
  for (int i = first; i < corners.Size; ++i) corners[i].pos.x += left - least;
}

void draw_at_right(const OverlayPen& pen, const SceneView& view, const ColorLegend& legend, int width,
                   int height) {
  const float em = pen.text_height(), h = static_cast<float>(height);
  // Room for the letter of the right border.
  const float right = static_cast<float>(width) - (view.anatomical ? 3.6F : 1.2F) * em;
  if (view.slice && view.slice->blend) {
    draw_blend_colors(pen, *view.slice->blend, right, h);
    return;
  }
  const bool volume = view.volume && view.volume->shown;
  if (volume && view.volume->image->labels) {
    draw_labels(pen, view.volume_label, *view.volume->image->labels, right, 0.5F * h, 0.7F * h);
    return;
  }
  if (volume && has_colored_parts(*view.volume)) {
    // Directions have no scale: their legend stands above that of the volume.
    draw_directions(pen, view.anatomical, right, 0.2F * h);
    draw_volume_colors(pen, view, right, 0.6F * h, 0.46F * h);
    return;
  }
  // The volume above, then the lens, the lines, and the forces at the foot.
  std::vector<std::function<void(float middle, float length)>> columns;
  if (volume) {
    columns.emplace_back(
        [&](float middle, float length) { draw_volume_colors(pen, view, right, middle, length); });
  } else if ((view.tensors || view.tracts) && !legend.has_lines) {
    columns.emplace_back(
        [&](float middle, float length) { draw_tensor_colors(pen, view, right, middle, length); });
  }
  if (view.color_lens && legend.has_lines) {
    columns.emplace_back([&](float middle, float length) {
      draw_color_bar(pen,
                     {.label = "in the lens: " + color_label(view.color_lens->style, view.units),
                      .table = color_table(color_map_of(view.color_lens->style)),
                      .range = legend.lens_range,
                      .logarithmic = is_logarithmic(view.color_lens->style)},
                     right, middle, length);
    });
  }
  if (legend.has_lines) {
    columns.emplace_back(
        [&](float middle, float length) { draw_line_colors(pen, view, legend, right, middle, length); });
  }
  if (shows_path(view)) {
    columns.emplace_back([&](float middle, float length) {
      draw_color_bar(pen,
                     {.label = "force [N]",
                      .table = color_table(view.probe->style.force_map),
                      .range = force_range(*view.probe),
                      .values_above = legend.forces_above},
                     right, middle, length);
    });
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const ColumnPlace place = column_place(columns.size(), i);
    columns[i](place.middle * h, place.length * h);
  }
}

}  // namespace

void draw_colors(const OverlayPen& pen, const SceneView& view, const ColorLegend& legend, int width,
                 int height) {
  const int first = pen.list().VtxBuffer.Size;
  draw_at_right(pen, view, legend, width, height);
  // Right of the letter of the left border.
  if (view.color_bar_left)
    move_to_left(pen, first, std::round((view.anatomical ? 3.6F : 1.2F) * pen.text_height()));
}

}  // namespace palpate
