/// What a picture shows of the probe, as plain data: the hand and the proxy that it is tied to, the
/// streamline that holds it, where it has been, and the lines around it (figure 1.1 and sec. 8.1 of
/// Ikits 2006: rake probe, stream balls, local vector icon; figure 8.4: path through tensors).
///
/// Positions are in data coordinates. A view is cheap to copy and to change every frame: what is large in
/// it is shared, and counts as the same while it is the same object. Things whose position is not finite
/// are not drawn.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "common/geometry/line.h"
#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/line_style.h"

namespace palpate {

/// Points of a path in the order of time, in pieces: a gap parts what a jump would join.
class ProbePath {
 public:
  /// @param spacing [data units] a point no farther than this from the one before it along every axis is
  /// left out: a resting hand adds nothing.
  explicit ProbePath(double spacing = 0.0) noexcept : spacing_(spacing) {}

  /// Adds a point and the size of the force there [N]. A position that is not finite begins a new piece; a
  /// force that is not finite is drawn grey.
  void append(const Vec3& position, double force);

  [[nodiscard]] std::size_t size() const noexcept { return positions_.size(); }
  [[nodiscard]] std::span<const Vec3> positions() const noexcept { return positions_; }
  [[nodiscard]] std::span<const double> forces() const noexcept { return forces_; }
  /// Index of the first point of each piece, rising from 0; empty where there are no points.
  [[nodiscard]] std::span<const std::size_t> pieces() const noexcept { return pieces_; }

 private:
  double spacing_;
  bool gap_ = true;  // the next point begins a piece
  std::vector<Vec3> positions_;
  std::vector<double> forces_;
  std::vector<std::size_t> pieces_;
};

/// The path through `positions` with `forces` [N], one a position.
/// @throws Error (work failed) where their numbers differ.
[[nodiscard]] std::shared_ptr<const ProbePath> make_probe_path(std::span<const Vec3> positions,
                                                               std::span<const double> forces,
                                                               double spacing = 0.0);

/// The streamline that holds the probe: a highlighted ribbon, and balls at equal times along it. Coloured
/// like the scene's lines; the values are of the quantity that colours these (SceneView::style), in data
/// units. Without values, and where the style colours by none, a plain colour is taken.
struct FollowedLine {
  std::vector<Vec3> points;
  std::vector<double> values;  ///< one a point, or none
  std::vector<Vec3> balls;
  std::vector<double> ball_values;  ///< one a ball, or none
  double ball_radius = 0.0;         ///< [data units]; 0: ProbeStyle::ball_size
};

/// What of a path is drawn. The path may go on growing after that.
struct PathView {
  std::shared_ptr<const ProbePath> points;  ///< may be null
  std::size_t count = 0;                    ///< the first so many of them
  std::optional<ValueRange> range;          ///< of the colours [N]; where absent: 0 to ProbeView::force_cap

  bool operator==(const PathView&) const = default;
};

enum class SeedShape : std::uint8_t { kNone, kRake, kPlane };
inline constexpr std::array<std::string_view, 3> kSeedShapeNames{"none", "rake", "plane"};
[[nodiscard]] constexpr std::string_view name_of(SeedShape shape) noexcept {
  return kSeedShapeNames[static_cast<std::size_t>(shape)];
}

/// Seeds at the probe with the short streamlines through them.
struct LocalSeeds {
  SeedShape shape = SeedShape::kNone;
  /// A rake goes from `origin` to origin + u. A plane is the parallelogram origin + a u + b v, a and b in
  /// [0, 1]. Handles stand at the ends and corners.
  Vec3 origin{0.0}, u{0.0}, v{0.0};
  std::vector<Vec3> seeds;
  std::shared_ptr<const std::vector<Line>> lines;  ///< may be null; coloured like the scene's
  /// Of these lines, where the scene's style colours by an array; without, and where that is another one, a
  /// plain colour is taken. Null: none.
  std::shared_ptr<const LineArray> array;
  double width = 5.0;  ///< thousandths of the picture's height: they stand out of the scene's
};

/// A line that the user has kept.
struct DrawnLine {
  std::shared_ptr<const Line> line;  ///< may be null
  int number = 1;                    ///< written at its first point; 0: nothing is
  std::optional<Rgb> color;          ///< where absent: cached_color(number)
};

/// A colour for each number, from the categorical map; it repeats after seven.
[[nodiscard]] Rgb cached_color(int number) noexcept;

/// Sizes in thousandths of the picture's height at the focal point, so that they hold at each zoom.
struct ProbeStyle {
  double probe_size = 16.0;     ///< diameter
  double proxy_size = 22.0;     ///< diameter
  double link_size = 13.0;      ///< diameter of further proxies of a chain
  double ball_size = 16.0;      ///< diameter
  double seed_size = 10.0;      ///< diameter
  double handle_size = 13.0;    ///< diameter
  double band_width = 8.0;      ///< unstretched
  double band_rest = 40.0;      ///< stretch at which the band is thinner by 1/sqrt(2)
  double arrow_length = 140.0;  ///< at the reference speed
  double path_width = 4.0;
  double followed_width = 8.0;
  double kept_width = 6.0;
  /// Opacity of probe, proxy, band, arrow, balls and followed line where something nearer hides them: the
  /// hand must not be lost in a bundle of lines. 0: hidden is hidden.
  double see_through = 0.55;
  double tensor_length = 44.0;              ///< of the longest axis of ProbeView::tensor
  ColorMap force_map = ColorMap::kTension;  ///< of band and path

  bool operator==(const ProbeStyle&) const = default;
};

struct ProbeView {
  Vec3 probe{HUGE_VAL};  ///< where the hand is
  Vec3 proxy{HUGE_VAL};  ///< where the constraints let it be
  /// Proxies of all links of a chain, in its order (Ikits 2006, figure 6.7): smaller balls stand at those
  /// other than `proxy`, thin lines between them. Empty: there is one.
  std::vector<Vec3> links;
  double force = 0.0;      ///< [N], size of the force on the hand
  double force_cap = 0.0;  ///< [N], the largest that the safety stage lets through; 0: no band, no colours
  bool show_force = true;  ///< write the newtons beside the band

  Vec3 velocity{0.0};  ///< of the field at the probe, where the arrow starts; zero or not finite: no arrow
  double reference_speed = 0.0;  ///< for which the arrow has ProbeStyle::arrow_length; <= 0: no arrow

  /// A diffusion tensor at the proxy, whose glyph stands in its place.
  std::optional<Mat3> tensor;

  std::shared_ptr<const FollowedLine> followed;  ///< may be null
  PathView path;
  std::shared_ptr<const LocalSeeds> seeds;                    ///< may be null
  std::shared_ptr<const std::vector<DrawnLine>> drawn_lines;  ///< may be null
  ProbeStyle style;
};

/// The range over which the colours of path and band spread [N].
[[nodiscard]] ValueRange force_range(const ProbeView& view) noexcept;

/// Whether both give the same picture; shared parts count as the same where they are the same objects.
[[nodiscard]] bool same_picture(const ProbeView& a, const ProbeView& b) noexcept;

}  // namespace palpate
