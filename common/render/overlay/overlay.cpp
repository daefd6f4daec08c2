#include "common/render/overlay/overlay.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/render/font.h"
#include "common/render/overlay/overlay_colors.h"
#include "common/render/overlay/overlay_pen.h"

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

// A line of words at the upper left.
struct TitleLine {
  float left, top;
  const std::string* words;
  Lettering lettering;
};

// Title and subtitle, those that are there.
std::vector<TitleLine> title_lines(const OverlayPen& pen, const SceneView& view) {
  const float em = pen.text_height(), left = view.slice ? em : 1.2F * em;
  const auto big = view.slice ? Lettering::kText : Lettering::kTitle;
  std::vector<TitleLine> lines;
  if (!view.title.empty()) lines.push_back({left, em, &view.title, big});
  if (!view.subtitle.empty()) {
    const float below = view.slice ? 1.9F * em : view.title.empty() ? 0.0F : 1.75F * em;
    lines.push_back({left, em + below, &view.subtitle, Lettering::kText});
  }
  return lines;
}

void draw_title(const OverlayPen& pen, const SceneView& view) {
  for (const TitleLine& line : title_lines(pen, view)) {
    if (view.slice) {  // which may be white there
      pen.label(line.left, line.top, *line.words);
    } else {
      pen.text(line.left, line.top, *line.words, line.words == &view.title ? pen.ink() : pen.faint_ink(),
               0.0F, line.lettering);
    }
  }
}

// Width and level of the grey values in the upper right corner, as radiologists read them; labels have colours of their own.
void draw_window(const OverlayPen& pen, const SceneView& view, int width) {
  if (!view.slice || view.slice->image->labels) return;
  const ValueWindow& window = view.slice->window;
  // In steps that are not seen: a two-hundredth of the width or less, as 1, 0.1, 0.01.
  const double step = std::pow(10.0, std::floor(std::log10(window.width / 200.0)));
  const auto text = [step](double value) {
    const double rounded = std::round(value / step) * step;
    return short_number(std::isfinite(rounded) ? rounded + 0.0 : value);
  };
  const std::string words = "W " + text(window.width) + "  L " + text(window.level);
  const float em = pen.text_height(), left = static_cast<float>(width) - em - OverlayPen::size_of(words).x;
  if (left > 2.0F * em + OverlayPen::size_of(view.title).x)
    pen.label(left, em, words);  // small pictures have no room
}

// The three axes of the data as arrows in the lower left corner, the farthest one first.
void draw_axes(const OverlayPen& pen, const SceneView& view, int height) {
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

// The lower border of what lies over the picture: above a patient's letter there.
float foot_of(const OverlayPen& pen, const SceneView& view, int height) {
  constexpr float kRoom = 1.2F, kLetter = 1.8F;  // heights of the text
  return static_cast<float>(height) - (kRoom + (view.anatomical ? kLetter : 0.0F)) * pen.text_height();
}

// Lines of words that are no wider than `widest`, unless a word is.
std::vector<std::string> wrapped(const std::string& words, float widest) {
  std::vector<std::string> lines;
  for (const std::string_view word : split(words, ' ')) {
    const std::string longer = lines.empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (lines.empty() || OverlayPen::size_of(longer).x > widest) {
      lines.emplace_back(word);
    } else {
      lines.back() = longer;
    }
  }
  return lines;
}

// Between the axes and the scale.
void draw_caption(const OverlayPen& pen, const SceneView& view, int width, int height) {
  constexpr float kShare = 0.5F, kLine = 1.3F;  // of the width; heights of the text
  const std::vector<std::string> lines = wrapped(view.caption, kShare * static_cast<float>(width));
  float y = foot_of(pen, view, height) - kLine * pen.text_height() * static_cast<float>(lines.size());
  for (const std::string& line : lines) {
    pen.text(0.5F * static_cast<float>(width), y, line, pen.ink(), 0.5F);
    y += kLine * pen.text_height();
  }
}

// A round length in the lower right corner, as long as things are in the plane of the focal point.
void draw_scale_bar(const OverlayPen& pen, const SceneView& view, int width, int height) {
  constexpr double kLongest = 0.2;  // of the width
  const double pixel = view.camera.view_height / height;
  const double longest = kLongest * width * pixel;
  if (!(longest > 0.0) || !std::isfinite(longest)) return;
  double length = std::pow(10.0, std::floor(std::log10(longest)));
  for (const double step : {5.0, 2.0}) {
    if (step * length <= longest) {
      length *= step;
      break;
    }
  }
  const float em = pen.text_height(), right = static_cast<float>(width) - 1.2F * em;
  const float y = foot_of(pen, view, height), left = right - static_cast<float>(length / pixel);
  const float thickness = std::max(1.5F, 0.13F * em), end = 0.35F * em;
  pen.list().AddLine({left, y}, {right, y}, pen.ink(), thickness);
  for (const float x : {left, right}) pen.list().AddLine({x, y - end}, {x, y + end}, pen.ink(), thickness);
  const std::string unit = length_unit(view);
  pen.text(0.5F * (left + right), y - 1.5F * em, short_number(length) + (unit.empty() ? "" : " " + unit),
           pen.ink(), 0.5F);
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
    letters += (direction[axis] > 0.0 ? kUp : kDown)[as_size(axis)];
  }
  return letters;
}

// Letters at the four borders, as in every viewer of medical images.
void draw_sides(const OverlayPen& pen, const SceneView& view, int width, int height) {
  const float em = pen.text_height(), w = static_cast<float>(width), h = static_cast<float>(height);
  const Vec3 right = view.camera.axes[0], up = view.camera.axes[1];
  pen.text(1.2F * em, 0.5F * h - 0.5F * em, side_of(-right), pen.ink());
  pen.text(w - 1.2F * em, 0.5F * h - 0.5F * em, side_of(right), pen.ink(), 1.0F);
  // Below a title that reaches as far, as in narrow panes.
  const std::string above = side_of(up);
  const float left = 0.5F * (w - OverlayPen::size_of(above).x);
  float top = 0.6F * em;
  for (const TitleLine& line : title_lines(pen, view)) {
    const ImVec2 size = OverlayPen::size_of(*line.words, line.lettering);
    if (line.left + size.x + 0.5F * em > left) top = line.top + size.y + 0.3F * em;
  }
  pen.text(0.5F * w, top, above, pen.ink(), 0.5F);
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

// Lines of other planes, thin, and outlines over a slice.
void draw_traces(const OverlayPen& pen, const SceneView& view, int width, int height) {
  const float thickness = std::max(1.0F, 0.09F * pen.text_height());
  for (const SliceTrace& trace : view.slice->traces) {
    const ImU32 color = packed(trace.color, 0.85F);
    for (std::size_t i = 1; i < trace.points.size(); ++i) {
      const Vec3 a = project(view.camera, trace.points[i - 1], width, height),
                 b = project(view.camera, trace.points[i], width, height);
      pen.list().AddLine({static_cast<float>(a.x), static_cast<float>(a.y)},
                         {static_cast<float>(b.x), static_cast<float>(b.y)}, color, thickness);
    }
  }
}

// A bright line with a dark rim stands out from dark and light alike.
void draw_notes(const OverlayPen& pen, const SceneView& view, int width, int height) {
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
    const ImVec2 size = OverlayPen::size_of(note.words);
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
void draw_probe_text(const OverlayPen& pen, const SceneView& view, int width, int height) {
  const ProbeView& probe = *view.probe;
  const float em = pen.text_height();
  if (probe.drawn_lines) {
    for (const DrawnLine& kept : *probe.drawn_lines) {
      if (kept.number == 0 || !kept.line || kept.line->points.empty()) continue;
      const auto at = place_of(view, kept.line->points.front().position, width, height);
      if (!at) continue;
      pen.text(at->x + 0.5F * em, at->y - 1.2F * em, std::to_string(kept.number),
               packed(kept.color.value_or(cached_color(kept.number))));
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
  const OverlayPen pen(*ImGui::GetBackgroundDrawList(), text_height, view.background);
  if (view.slice) draw_traces(pen, view, width, height);
  draw_title(pen, view);
  draw_window(pen, view, width);
  if (view.show_axes) draw_axes(pen, view, height);
  if (view.anatomical) draw_sides(pen, view, width, height);
  draw_notes(pen, view, width, height);
  if (view.probe) draw_probe_text(pen, view, width, height);
  if (!view.caption.empty()) draw_caption(pen, view, width, height);
  if (view.show_scale_bar) draw_scale_bar(pen, view, width, height);
  if (view.show_color_bar) draw_colors(pen, view, legend, width, height);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace palpate
