/// Draws lines as illuminated ribbons of constant width that face the viewer (shaders/line/).
#pragma once

#include <array>
#include <cstdint>
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
};

namespace detail {
/// Sets the line program's uniforms and the state for opaque or transparent lines; the caller draws its
/// triangles and then calls end_lines().
void begin_lines(const LineDraw& how, bool has_values);
void end_lines();
// Bindings of shaders/line/line.vert.
inline constexpr std::uint32_t kLinePoints = 0, kLineValues = 1, kLineLensValues = 2;
}  // namespace detail

/// The compiled program and its colour tables, shared by all sets of lines. Needs the frame's uniform
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
  GlProgram program_;  ///< compiled at the first use
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
  /// @pre LineProgram::use().
  void draw(const LineDraw& how);

 private:
  // The segments that were uploaded depend on these.
  struct Arrangement {
    double tolerance = -1.0;
    bool sorted = false;
    Vec3f along{0.0F};

    bool operator==(const Arrangement&) const = default;
  };
  void arrange(const Arrangement& wanted);

  LineGeometry geometry_;
  std::vector<float> coordinates_;
  std::vector<LineSegment> simplified_;  // for arrangement_.tolerance
  Arrangement arrangement_;
  std::size_t corner_count_ = 0;
  GlVertexArray vertex_array_;
  GlBuffer points_, values_, lens_values_, indices_;
  bool has_lens_values_ = false;
};

}  // namespace palpate
