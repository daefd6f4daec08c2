/// Draws lines as illuminated ribbons of constant width that face the viewer (shaders/line/).
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <list>
#include <optional>
#include <span>
#include <vector>

#include "common/render/color/color_tables.h"
#include "common/render/gl/object.h"
#include "common/render/line/line_geometry.h"

namespace palpate {

/// How one set of lines is drawn.
struct LineDraw {
  enum class Coloring : int { kMap = 0, kDirection = 1, kOneColor = 2, kUnlit = 3 };
  Coloring coloring = Coloring::kMap;
  Rgb color{1.0F};                ///< for kOneColor and kUnlit
  float width = 3.0F;             ///< [pixels] at the focal point
  float min_width = 1.0F;         ///< [pixels] anywhere
  float halo_width = 0.0F;        ///< [pixels] beyond either edge; 0: none
  std::optional<Rgb> halo_color;  ///< where absent, the background's: a gap around nearer lines
  /// Only where something nearer hides the lines; they shine through by `opacity`.
  bool hidden_part = false;
  /// Once more over what was drawn before them since, by `opacity`; they are in the depths already.
  bool seen_again = false;
  /// Brings lines nearer in depth alone, in half widths: of two along one curve it decides which is seen.
  float lift = 0.0F;
  float dimming = 0.0F;  ///< share of the background at any depth
  float fading = 1.0F;   ///< share of the depth cue
  float opacity = 1.0F;
  float clearing = 0.0F;  ///< share of it that goes with the place in the colour map: LineStyle

  [[nodiscard]] bool transparent() const noexcept { return opacity < 1.0F || clearing > 0.0F; }
  Vec3f lens_center{0.0F};       ///< of a ball where the second values colour them (scene frame)
  float lens_radius = 0.0F;      ///< 0: there is none
  double tolerance = 0.0;        ///< how far lines may be moved to save segments (scene frame)
  Vec3f back{0.0F, 0.0F, 1.0F};  ///< toward the viewer; transparent segments are sorted along it
  /// Share of the segments that are left of `tolerance`, in (0, 1]: less moves lines farther, and where that is not
  /// enough leaves out some of them.
  double detail = 1.0;
  std::optional<Mat4> clip_from_scene;  ///< what lies outside is not drawn; where absent all is
  float pixel = 0.0F;                   ///< at the focal point (scene frame)
  /// Asked every few hundredths of a second whether to leave this picture; none: it is drawn without waiting.
  const std::function<bool()>* stop = nullptr;
};

namespace detail {
/// Sets the line program's uniforms and the state for opaque or transparent lines; the caller draws its
/// triangles and then calls end_lines().
void begin_lines(const LineDraw& how, bool has_values);
void end_lines();
// Bindings of shaders/line/line.vert.
inline constexpr std::uint32_t kLinePoints = 0, kLineValues = 1, kLineLensValues = 2;
}  // namespace detail

/// The compiled programs and their colour tables, shared by all sets of lines. Needs the frame's uniform
/// block bound to 0.
class LineProgram {
 public:
  /// Where fragments go: into the picture, or into the lists of its pixels (line_layers.h).
  enum class Into : std::uint8_t { kPicture, kLayers };
  explicit LineProgram(Into into = Into::kPicture) : into_(into) {}
  /// @param lens_map of what is inside the ball of LineDraw, where there is one.
  void use(ColorMap map, std::optional<ColorMap> lens_map = std::nullopt);

 private:
  Into into_;
  std::array<GlProgram, 2> programs_;  ///< without and with a lens, each compiled at its first use
  ColorTables tables_;
};

/// Lines on the GPU.
class LineSet {
 public:
  void set_geometry(LineGeometry geometry);
  /// One place in the colour map for each vertex.
  void set_values(std::vector<float> coordinates);
  /// The same for what is inside the ball of LineDraw; none: it has no colours of its own.
  void set_lens_values(std::span<const float> coordinates);
  /// @pre LineProgram::use(). @throws DrawingStopped (volume/tile_pass.h) where LineDraw::stop says so.
  void draw(const LineDraw& how);

 private:
  /// What segments are made by: as many as a tolerance leaves, joined so many times more, a share of the lines.
  struct Detail {
    double tolerance = 0.0;
    int joined = 0;
    double share = 1.0;

    bool operator==(const Detail&) const = default;
  };
  /// Segments that lie one after the other, and in a box.
  struct Run {
    std::size_t first = 0, last = 0;
    Vec3f lower{0.0F}, upper{0.0F};
  };
  struct Level {
    Detail detail;
    std::vector<LineSegment> segments;
    std::vector<Run> runs;
    GlBuffer indices;
  };
  const Level& level(const LineDraw& how);
  const Level& level(const Detail& wanted);
  const Level& keep(const Detail& detail, std::vector<LineSegment> segments);
  void draw_sorted(const Level& level, const Vec3f& along);
  static void draw_seen(const Level& level, const LineDraw& how);

  LineGeometry geometry_;
  std::vector<float> coordinates_;
  std::list<Level> levels_;  ///< the one that was asked for last first
  struct Sorting {
    Detail detail;
    Vec3f along{0.0F};

    bool operator==(const Sorting&) const = default;
  };
  std::optional<Sorting> sorting_;
  GlVertexArray vertex_array_;
  GlBuffer points_, values_, lens_values_;
  GlBuffer sorted_;  ///< indices in the order of sorting_
  bool has_lens_values_ = false;
};

}  // namespace palpate
