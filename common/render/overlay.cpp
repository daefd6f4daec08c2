#include "common/render/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "common/base/error.h"
#include "common/render/font.h"
#include "common/render/ticks.h"

namespace palpate {

struct Overlay::State {
  ImGuiContext* context = nullptr;
  float text_height = 0.0F;  ///< that the font's texture was made for
};

namespace {

// Makes an ImGui context current, and the one before it again: the window has a context of its own.
class ContextScope {
 public:
  explicit ContextScope(ImGuiContext* context) : before_(ImGui::GetCurrentContext()) {
    ImGui::SetCurrentContext(context);
  }
  ~ContextScope() { ImGui::SetCurrentContext(before_); }
  ContextScope(const ContextScope&) = delete;
  ContextScope& operator=(const ContextScope&) = delete;

 private:
  ImGuiContext* before_;
};

ImU32 packed(const Rgb& color, float opacity = 1.0F) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, opacity});
}

// Fonts of the atlas, in the order in which they are added.
enum class Lettering { kText, kTitle };
constexpr float kTitleScale = 1.35F;

// Draws text and shapes in the colours of the background.
class Pen {
 public:
  Pen(ImDrawList& list, float text_height, Background background)
      : list_(list), text_height_(text_height), dark_(background == Background::kDark) {}

  [[nodiscard]] float text_height() const { return text_height_; }
  [[nodiscard]] ImU32 ink() const { return dark_ ? IM_COL32(232, 235, 240, 255) : IM_COL32(28, 31, 36, 255); }
  [[nodiscard]] ImU32 faint_ink() const {
    return dark_ ? IM_COL32(168, 174, 184, 255) : IM_COL32(86, 92, 102, 255);
  }
  [[nodiscard]] ImU32 paper(int opacity) const {
    return dark_ ? IM_COL32(16, 18, 21, opacity) : IM_COL32(255, 255, 255, opacity);
  }

  [[nodiscard]] static ImVec2 size_of(const std::string& text, Lettering lettering = Lettering::kText) {
    const ImFont* const font = font_of(lettering);
    return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0F, text.c_str());
  }

  // `align` is the share of the text's width that lies left of x.
  void text(float x, float y, const std::string& words, ImU32 color, float align = 0.0F,
            Lettering lettering = Lettering::kText) const {
    const ImFont* const font = font_of(lettering);
    x = std::round(x - align * size_of(words, lettering).x);
    y = std::round(y);
    // A rim in the colour of the background keeps letters readable over lines.
    const float rim = std::max(1.0F, std::round(text_height_ / 14.0F));
    for (const ImVec2 shift : {ImVec2(-rim, 0), ImVec2(rim, 0), ImVec2(0, -rim), ImVec2(0, rim)}) {
      list_.AddText(font, font->FontSize, {x + shift.x, y + shift.y}, paper(110), words.c_str());
    }
    list_.AddText(font, font->FontSize, {x, y}, color, words.c_str());
  }

  // Words on a plate in the colour of the background, for places where anything may lie behind them.
  void label(float x, float y, const std::string& words) const {
    const ImVec2 size = size_of(words);
    const float margin = 0.3F * text_height_;
    list_.AddRectFilled({x - margin, y - 0.5F * margin}, {x + size.x + margin, y + size.y + 0.5F * margin},
                        paper(190), margin);
    text(x, y, words, ink());
  }

  ImDrawList& list() const { return list_; }

 private:
  static ImFont* font_of(Lettering lettering) {
    return ImGui::GetIO().Fonts->Fonts[static_cast<int>(lettering)];
  }

  ImDrawList& list_;
  float text_height_;
  bool dark_;
};

void draw_title(const Pen& pen, const SceneView& view) {
  const float em = pen.text_height();
  float y = em;
  if (!view.title.empty()) {
    pen.text(1.2F * em, y, view.title, pen.ink(), 0.0F, Lettering::kTitle);
    y += 1.75F * em;
  }
  if (!view.subtitle.empty()) pen.text(1.2F * em, y, view.subtitle, pen.faint_ink());
}

// The three axes of the data as arrows in the lower left corner, the farthest one first.
void draw_axes(const Pen& pen, const SceneView& view, int height) {
  struct Axis {
    const char* name;
    ImU32 color;
    Vec3 direction;  // right, up, back
  };
  const auto in_view = [&](const Vec3& axis) { return axis * view.camera.axes; };
  // In a patient the axes lead to the right, the front and up.
  const std::array<const char*, 3> names =
      view.anatomical ? std::array<const char*, 3>{"R", "A", "S"} : std::array<const char*, 3>{"x", "y", "z"};
  std::array<Axis, 3> axes{{{names[0], IM_COL32(226, 88, 82, 255), in_view({1.0, 0.0, 0.0})},
                            {names[1], IM_COL32(96, 186, 92, 255), in_view({0.0, 1.0, 0.0})},
                            {names[2], IM_COL32(86, 140, 240, 255), in_view({0.0, 0.0, 1.0})}}};
  std::stable_sort(axes.begin(), axes.end(),
                   [](const Axis& a, const Axis& b) { return a.direction.z < b.direction.z; });
  const float em = pen.text_height();
  const float arm = 2.6F * em, thickness = std::max(1.5F, 0.13F * em);
  const ImVec2 origin(1.6F * em + arm, static_cast<float>(height) - 1.6F * em - arm);
  for (const Axis& axis : axes) {
    const auto dx = static_cast<float>(axis.direction.x), dy = -static_cast<float>(axis.direction.y);
    const float length = std::hypot(dx, dy);
    const ImVec2 tip(origin.x + arm * dx, origin.y + arm * dy);
    const float head = std::min(0.62F * em, arm * length);
    if (length > 0.02F) {
      const ImVec2 along(dx / length, dy / length), across(-along.y, along.x);
      const ImVec2 neck(tip.x - head * along.x, tip.y - head * along.y);
      pen.list().AddLine(origin, neck, axis.color, thickness);
      pen.list().AddTriangleFilled(tip, {neck.x + 0.38F * head * across.x, neck.y + 0.38F * head * across.y},
                                   {neck.x - 0.38F * head * across.x, neck.y - 0.38F * head * across.y},
                                   axis.color);
    } else {
      pen.list().AddCircleFilled(origin, 0.7F * thickness, axis.color);
    }
    const float reach = arm + 0.62F * em;
    pen.text(origin.x + reach * dx, origin.y + reach * dy - 0.55F * em, axis.name, axis.color, 0.5F);
  }
}

// Colour patches with words, from `top` down, right-aligned to `right`.
struct LegendEntry {
  Rgb color;
  std::string text;
};

void draw_legend(const Pen& pen, const std::string& label, const std::vector<LegendEntry>& entries,
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
float draw_color_bar(const Pen& pen, const ColorScale& scale, float right, float middle, float length) {
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
void draw_line_colors(const Pen& pen, const SceneView& view, const ColorLegend& legend, float right,
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
        const std::size_t count = legend.ends[static_cast<std::size_t>(k)];
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

// The values of a volume: their colours, and beside them how opaque they are.
void draw_volume_colors(const Pen& pen, const SceneView& view, float right, float middle, float length) {
  const VolumeView& volume = *view.volume;
  const ValueRange range{volume.image->lowest, volume.image->highest};
  if (!(range.lower < range.upper)) return;
  constexpr std::size_t kEntries = 128;
  const std::vector<ColorSample> samples = volume.regions
                                               ? deepest_colors(*volume.regions, range, kEntries)
                                               : volume.transfer.table(range.lower, range.upper, kEntries);
  std::vector<Rgb> colors;
  colors.reserve(samples.size());
  for (const ColorSample& sample : samples)
    colors.push_back({sample.color.r, sample.color.g, sample.color.b});
  const float left = draw_color_bar(pen, {.label = view.volume_label, .table = colors, .range = range}, right,
                                    middle, length);
  const float em = pen.text_height(), base = left - 0.3F * em, widest = 2.0F * em;
  const auto place = [&](std::size_t i) {
    const float y = middle + length * (0.5F - static_cast<float>(i) / static_cast<float>(kEntries - 1));
    return ImVec2(base - widest * static_cast<float>(samples[i].opacity), y);
  };
  for (std::size_t i = 0; i + 1 < kEntries; ++i)
    pen.list().AddLine(place(i), place(i + 1), pen.faint_ink(), std::max(1.0F, em / 12.0F));
}

void draw_directions(const Pen& pen, bool anatomical, float right, float middle) {
  const std::array<const char*, 3> axes =
      anatomical ? std::array<const char*, 3>{"left, right", "back, front", "feet, head"}
                 : std::array<const char*, 3>{"x", "y", "z"};
  draw_legend(pen, "direction",
              {{{1.0F, 0.1F, 0.1F}, axes[0]}, {{0.1F, 1.0F, 0.1F}, axes[1]}, {{0.1F, 0.1F, 1.0F}, axes[2]}},
              right, middle);
}

// The colours of slices and glyphs.
void draw_tensor_colors(const Pen& pen, const SceneView& view, float right, float middle, float length) {
  const bool tensors = view.tensors && view.tensors->image->field;
  if (!tensors || view.tensors->color == TensorColor::kDirection) {
    draw_directions(pen, view.anatomical, right, middle);
    return;
  }
  const std::array<Rgb, 2> greys{Rgb(0.0F), Rgb(1.0F)};
  draw_color_bar(pen, {.label = "FA", .table = greys, .range = {0.0, 1.0}}, right, middle, length);
}

bool shows_path(const SceneView& view) { return view.probe && view.probe->path.count > 0; }

void draw_colors(const Pen& pen, const SceneView& view, const ColorLegend& legend, int width, int height) {
  const float em = pen.text_height(), h = static_cast<float>(height);
  // Room for the letter of the right border.
  const float right = static_cast<float>(width) - (view.anatomical ? 3.6F : 1.2F) * em;
  if (view.volume && view.volume->shown) {
    // Directions have no scale: their legend stands above that of the volume.
    const bool both = has_colored_parts(*view.volume);
    if (both) draw_directions(pen, view.anatomical, right, 0.2F * h);
    draw_volume_colors(pen, view, right, (both ? 0.6F : 0.5F) * h, 0.46F * h);
    return;
  }
  if ((view.tensors || view.tracts) && !legend.has_lines) {
    draw_tensor_colors(pen, view, right, shows_path(view) ? 0.31F * h : 0.5F * h, 0.30F * h);
  }
  // Columns share the border: that of the lens above, the lines' below it, that of the forces at the foot.
  const bool path = shows_path(view), lens = view.color_lens && legend.has_lines;
  float middle = path ? 0.31F : 0.5F, length = path ? 0.30F : 0.46F;
  if (lens) {
    const float part = path ? 0.19F : 0.28F;
    draw_color_bar(pen,
                   {.label = "in the lens: " + color_label(view.color_lens->style, view.units),
                    .table = color_table(color_map_of(view.color_lens->style)),
                    .range = legend.lens_range,
                    .logarithmic = is_logarithmic(view.color_lens->style)},
                   right, path ? 0.19F * h : 0.27F * h, part * h);
    middle = path ? 0.47F : 0.70F;
    length = part;
  }
  if (legend.has_lines) draw_line_colors(pen, view, legend, right, middle * h, length * h);
  if (!path) return;
  const float force_length = lens ? 0.19F : 0.26F;
  draw_color_bar(pen,
                 {.label = "force [N]",
                  .table = color_table(view.probe->style.force_map),
                  .range = force_range(*view.probe),
                  .values_above = legend.forces_above},
                 right, (lens ? 0.76F : 0.74F) * h, force_length * h);
}

// A place in the picture where words may stand: [pixels]; none behind the eye or far outside.
std::optional<ImVec2> place_of(const SceneView& view, const Vec3& x, int width, int height) {
  if (!is_finite(x)) return std::nullopt;
  const Vec3 p = project(view.camera, x, width, height);
  if (!(p.z > 0.0) && view.camera.projection == Projection::kPerspective) return std::nullopt;
  if (!(p.x > 0.0 && p.x < width && p.y > 0.0 && p.y < height)) return std::nullopt;
  return ImVec2(static_cast<float>(p.x), static_cast<float>(p.y));
}

// Where a direction leads in a patient, the strongest letter first: "R", "LA".
std::string side_of(const Vec3& direction) {
  constexpr std::string_view kUp = "RAS", kDown = "LPI";
  constexpr double kLeast = 0.35;  // of a unit direction: some 20 degrees
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(),
            [&](int a, int b) { return std::abs(direction[a]) > std::abs(direction[b]); });
  std::string letters;
  for (const int axis : order) {
    if (std::abs(direction[axis]) < kLeast) break;
    letters += (direction[axis] > 0.0 ? kUp : kDown)[static_cast<std::size_t>(axis)];
  }
  return letters;
}

// Letters at the four borders, as in every viewer of medical images.
void draw_sides(const Pen& pen, const SceneView& view, int width, int height) {
  const float em = pen.text_height(), w = static_cast<float>(width), h = static_cast<float>(height);
  const Vec3 right = view.camera.axes[0], up = view.camera.axes[1];
  pen.text(1.2F * em, 0.5F * h - 0.5F * em, side_of(-right), pen.ink());
  pen.text(w - 1.2F * em, 0.5F * h - 0.5F * em, side_of(right), pen.ink(), 1.0F);
  pen.text(0.5F * w, 0.6F * em, side_of(up), pen.ink(), 0.5F);
  pen.text(0.5F * w, h - 1.8F * em, side_of(-up), pen.ink(), 0.5F);
}

// Upper end of a label at `left` that begins at `top`, or as little below as it takes to cover none of
// `taken` [left, top, right, bottom], which it joins.
float free_top(std::vector<ImVec4>& taken, float left, float top, const ImVec2& size) {
  const auto covered = [&](const ImVec4& other) {
    return left < other.z && left + size.x > other.x && top < other.w && top + size.y > other.y;
  };
  // Each one that is met moves the label on for good: as many rounds as there are others.
  for (std::size_t round = 0; round < taken.size(); ++round) {
    const auto met = std::find_if(taken.begin(), taken.end(), covered);
    if (met == taken.end()) break;
    top = met->w;
  }
  taken.emplace_back(left, top, left + size.x, top + size.y);
  return top;
}

// A bright line with a dark rim stands out from dark and light alike.
void draw_notes(const Pen& pen, const SceneView& view, int width, int height) {
  constexpr ImU32 kBright = IM_COL32(255, 214, 10, 255), kRim = IM_COL32(20, 16, 0, 230);
  const float em = pen.text_height(), core = std::max(1.5F, 0.13F * em),
              rim = core + std::max(2.0F, 0.14F * em);
  for (const NoteView& note : view.notes) {
    for (const bool inner : {false, true}) {
      for (std::size_t i = 1; i < note.outline.size(); ++i) {
        const auto a = place_of(view, note.outline[i - 1], width, height);
        const auto b = place_of(view, note.outline[i], width, height);
        if (a && b) pen.list().AddLine(*a, *b, inner ? kBright : kRim, inner ? core : rim);
      }
      for (const Vec3& point : note.points) {
        const auto at = place_of(view, point, width, height);
        if (at) pen.list().AddCircleFilled(*at, (inner ? 1.6F : 2.3F) * core, inner ? kBright : kRim);
      }
    }
  }
  // Words last: no line runs through them; below others where they would cover these.
  std::vector<ImVec4> taken;
  for (const NoteView& note : view.notes) {
    if (note.words.empty() || note.points.empty()) continue;
    Vec3 middle{0.0};
    for (const Vec3& point : note.points) middle += point / static_cast<double>(note.points.size());
    const auto at = place_of(view, middle, width, height);
    if (!at) continue;
    const ImVec2 size = Pen::size_of(note.words);
    const float left = at->x + 0.8F * em;
    // Right of a line, on the side from which it leans away.
    const auto a = place_of(view, note.points.front(), width, height);
    const auto b = place_of(view, note.points.back(), width, height);
    const bool falls = note.points.size() == 2 && a && b && (b->x - a->x) * (b->y - a->y) > 0.0F;
    const float wanted = falls ? at->y - 0.5F * em - size.y : at->y + 0.5F * em;
    const float top = free_top(taken, left, wanted, {size.x + 0.6F * em, size.y + 0.5F * em});
    pen.label(left, top, note.words);
  }
}

// Newtons beside the middle of the band, numbers at the first points of kept lines.
void draw_probe_words(const Pen& pen, const SceneView& view, int width, int height) {
  const ProbeView& probe = *view.probe;
  const float em = pen.text_height();
  if (probe.kept) {
    for (const KeptLine& kept : *probe.kept) {
      if (kept.number == 0 || !kept.line || kept.line->points.empty()) continue;
      const auto at = place_of(view, kept.line->points.front().position, width, height);
      if (!at) continue;
      pen.text(at->x + 0.5F * em, at->y - 1.2F * em, std::to_string(kept.number),
               packed(kept.color.value_or(kept_color(kept.number))));
    }
  }
  const bool pulled =
      probe.show_force && probe.force > 0.0 && std::isfinite(probe.force) && probe.force_cap > 0.0;
  if (!pulled) return;
  if (const auto at = place_of(view, 0.5 * (probe.probe + probe.proxy), width, height)) {
    std::array<char, 32> text{};
    (void)std::snprintf(text.data(), text.size(), "%.2f N", probe.force);
    pen.label(at->x + 1.2F * em, at->y + 0.4F * em, text.data());
  }
}

}  // namespace

Overlay::Overlay() : state_(std::make_unique<State>()) {
  IMGUI_CHECKVERSION();
  ImGuiContext* const before = ImGui::GetCurrentContext();
  state_->context = ImGui::CreateContext();
  ImGui::SetCurrentContext(before);
  const ContextScope scope(state_->context);
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::GetIO().LogFilename = nullptr;
  if (!ImGui_ImplOpenGL3_Init("#version 450 core")) {
    ImGui::DestroyContext(state_->context);
    throw work_error("text cannot be drawn: libGL.so.1 cannot be loaded; install libgl1");
  }
}

Overlay::~Overlay() {
  {
    const ContextScope scope(state_->context);
    ImGui_ImplOpenGL3_Shutdown();
  }
  ImGui::DestroyContext(state_->context);
}

float overlay_text_height(int width, int height) noexcept {
  // 1/52 of the height, or of a height that goes with the width in tall pictures.
  constexpr float kShare = 1.0F / 52.0F, kSmallest = 10.0F, kLargest = 96.0F;
  const float side = std::min(static_cast<float>(height), 0.8F * static_cast<float>(width));
  return std::round(std::clamp(kShare * side, kSmallest, kLargest));
}

void Overlay::draw(const SceneView& view, const ColorLegend& legend, int width, int height) {
  const ContextScope scope(state_->context);
  ImGuiIO& io = ImGui::GetIO();
  const float text_height = overlay_text_height(width, height);
  if (text_height != state_->text_height) {
    io.Fonts->Clear();
    add_font(*io.Fonts, text_height);
    add_font(*io.Fonts, std::round(kTitleScale * text_height));
    if (state_->text_height > 0.0F) ImGui_ImplOpenGL3_DestroyFontsTexture();
    io.Fonts->Build();
    if (state_->text_height > 0.0F) ImGui_ImplOpenGL3_CreateFontsTexture();
    state_->text_height = text_height;
  }
  io.DisplaySize = {static_cast<float>(width), static_cast<float>(height)};
  io.DeltaTime = 1.0F / 60.0F;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
  const Pen pen(*ImGui::GetBackgroundDrawList(), text_height, view.background);
  draw_title(pen, view);
  if (view.show_axes) draw_axes(pen, view, height);
  if (view.anatomical) draw_sides(pen, view, width, height);
  draw_notes(pen, view, width, height);
  if (view.probe) draw_probe_words(pen, view, width, height);
  if (view.show_color_bar) draw_colors(pen, view, legend, width, height);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace palpate
