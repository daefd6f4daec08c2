/// The isosurfaces that the hand feels, as triangles for the picture, made on a thread of their own: the hand
/// and the sliders move on meanwhile.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/field/value_histogram.h"
#include "common/haptics/constraint/isosurface_settings.h"
#include "common/trace/isosurface/isosurface_mesh.h"

namespace palpate {

/// What is felt: isosurfaces of these values; none where the field is null.
struct HapticLevels {
  std::shared_ptr<const ScalarField> field;
  Isovalues isovalues;

  bool operator==(const HapticLevels&) const = default;
};

/// The first place where the straight way from `from` to `to` (data coordinates) changes its side of a level:
/// sampled at 2048 places of its part inside the bounds, then bisected, on the side of `from`. What is
/// crossed twice between two samples is missed.
[[nodiscard]] std::optional<Vec3> first_surface_between(const HapticLevels& levels, const Vec3& from,
                                                        const Vec3& to);

/// The isovalue on whose surface a proxy is where the field has that value; none where it is on none.
[[nodiscard]] std::optional<double> haptic_level(const HapticLevels& levels, double value);

/// Says which isovalues lie outside the values of `field`, where no surface is; empty where none does.
[[nodiscard]] std::string beyond_values(const ScalarField& field, const Isovalues& isovalues);

class HapticSurfaces {
 public:
  /// @param wake called on the thread that makes them when there is something new.
  explicit HapticSurfaces(std::function<void()> wake);
  ~HapticSurfaces();  ///< cancels what is being made
  HapticSurfaces(const HapticSurfaces&) = delete;
  HapticSurfaces& operator=(const HapticSurfaces&) = delete;

  /// The latest request wins; the same one again costs nothing. Isovalues that stay are not made again; what
  /// takes longer than a moment makes way for the next.
  void request(const HapticLevels& levels);

  /// What was made last of the field that is wanted now.
  struct Made {
    std::vector<std::shared_ptr<const IsosurfaceMesh>> meshes;  ///< one an isovalue
    std::shared_ptr<const ValueHistogram> histogram;  ///< of the field's values, local ones; may be null
    std::string problem;                              ///< why a surface is not drawn; empty: it is
  };
  [[nodiscard]] Made made() const;
  /// Part done of what is being made, from 0 to 1; none while nothing is.
  [[nodiscard]] std::optional<double> fraction() const;

 private:
  void run(const std::stop_token& stop);
  [[nodiscard]] Made make(const HapticLevels& levels, const Made& before, Progress& progress) const;

  std::function<void()> wake_;
  HapticLevels asked_;        ///< the owner's
  mutable std::mutex mutex_;  ///< of the next four
  HapticLevels wanted_levels_;
  std::optional<HapticLevels> waiting_;
  Made made_;
  std::shared_ptr<Progress> progress_;  ///< of what is being made
  std::condition_variable_any wanted_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
