/// Tracts drawn by hand: where the proxy went while the tensors held it, with what was felt and measured at
/// each point (Ikits 2006, figure 8.4).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/field/tensor/tensor_measure.h"
#include "common/geometry/line.h"
#include "common/geometry/tractogram.h"

namespace palpate {

/// A line and the columns that are saved with it, one number a point.
struct DrawnTract {
  Line line;                             ///< data coordinates; of a tract, time since its first point [s]
  std::vector<double> forces;            ///< the largest felt at the point [N]; NaN where none was
  std::vector<TensorMeasures> measures;  ///< none of a streamline
  std::optional<TractogramImage> image;  ///< that a tract was drawn in: of voxels
};

/// What a stroke does with the tracts that were drawn before the hand took the probe.
enum class StrokeUse : std::uint8_t {
  kAppend,  ///< goes on from the end of one that it begins at, else it is a tract of its own; what goes on
            ///< from the first point stands before it, so that tracts keep the direction of their first
            ///< stroke
  kReplace  ///< takes their place
};

/// Distance of points of drawn tracts, in diagonals of the image: fine enough for any voxel, coarse enough
/// for any file.
inline constexpr double kTractSpacing = 2e-4;

/// Grows tracts from the steps of the servo, a stroke at a time. One thread.
class TractPen {
 public:
  /// @param spacing of points [data units]: steps closer to the last point than this are taken together.
  /// @param reach about the ends of tracts in which a stroke goes on from them [data units]; 0: every stroke
  /// is a tract of its own, and drawn() stays as it is.
  TractPen(std::shared_ptr<const TensorField> field, double spacing, double reach = 0.0);

  void use(StrokeUse use) noexcept { use_ = use; }
  /// The proxy is at `proxy` [data coordinates] and the force on the hand is `force` [N]; time in seconds.
  void add(double time, const Vec3& proxy, double force);
  /// Nothing holds the proxy, or it has jumped: the next add() begins another stroke.
  void lift();
  /// The hand is off, too.
  void let_go();

  /// In the order of their first strokes. While the pen is down its tract is the last, and turned round where
  /// the stroke goes on from the first point.
  [[nodiscard]] const std::vector<DrawnTract>& tracts() const noexcept { return tracts_; }
  /// The stroke has yet to go on from the end that it began at: nothing of it is in tracts().
  [[nodiscard]] bool joining() const noexcept { return down_ && joining_; }
  /// While the pen is down, takes out all but the first `points` of its tract. @pre 0 < points.
  void cut(std::size_t points);
  /// Leaves those of two points and more to the caller, and none here.
  [[nodiscard]] std::vector<DrawnTract> take();
  /// What was there when the pen was lifted last; another object whenever that has changed. Never null.
  [[nodiscard]] const std::shared_ptr<const std::vector<DrawnTract>>& drawn() const noexcept {
    return drawn_;
  }
  /// Goes back to what drawn() was. A stroke that is being drawn ends. @param drawn not null.
  void put(std::shared_ptr<const std::vector<DrawnTract>> drawn);
  /// Grows whenever tracts() has changed by more than a point at the end of its last tract.
  [[nodiscard]] std::uint64_t edits() const noexcept { return edits_; }

 private:
  void note_drawn();
  void begin(double time, const Vec3& proxy);
  [[nodiscard]] bool goes_on(const Vec3& proxy) const;

  std::shared_ptr<const TensorField> field_;
  double spacing_, reach_;
  StrokeUse use_ = StrokeUse::kAppend;
  CellHint hint_;
  double start_ = 0.0;  ///< time at which the last tract's own is 0
  bool down_ = false;
  bool joining_ = false;   ///< the stroke has not gone on from its tract's end yet
  bool turned_ = false;    ///< its tract is turned round until it ends
  std::size_t added_ = 0;  ///< points of the stroke
  bool fresh_ = true;      ///< the hand has drawn nothing since it took the probe
  std::uint64_t edits_ = 0;
  std::vector<DrawnTract> tracts_;
  std::shared_ptr<const std::vector<DrawnTract>> drawn_ = std::make_shared<const std::vector<DrawnTract>>();
};

/// Writes `lines` with the columns `force` and, where they have measures, `cl`, `cp` and `fa`, where the
/// format has columns (.vtp, .trk, .csv), over the image of the first that has one. @throws Error as write_lines().
void write_drawn(const std::filesystem::path& path, std::span<const DrawnTract> lines, bool overwrite);

/// The same for those of at least two points. @return how many these are.
std::size_t save_tracts(const std::filesystem::path& path, const std::vector<DrawnTract>& tracts,
                        bool overwrite);

}  // namespace palpate
