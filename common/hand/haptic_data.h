/// The data under the hand: the input that is open, how the workspace lies over it, and what is made of it
/// on threads of their own: felt isosurfaces as triangles, the noise that is felt as a texture, streamlines
/// near the probe.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/field/scalar_field.h"
#include "common/hand/drawn/local_lines.h"
#include "common/hand/mode/chain_description.h"
#include "common/hand/mode/haptic_surfaces.h"
#include "common/hand/mode/linear_proposal.h"
#include "common/haptics/workspace.h"
#include "common/render/camera.h"
#include "common/render/surface/surface_view.h"

namespace palpate {

// The noise of a field (field/noise_field.h), measured on a thread of its own: the hand moves on meanwhile,
// and what was measured stays with the field.

class MeasuredNoise {
 public:
  /// @param wake called on the measuring thread when it is done. @param threads as of make_noise_field().
  MeasuredNoise(std::function<void()> wake, int threads);
  MeasuredNoise(const MeasuredNoise&) = delete;
  MeasuredNoise& operator=(const MeasuredNoise&) = delete;

  /// Has the noise of `field` measured, not null. The latest request wins; the same one again costs nothing.
  void request(const std::shared_ptr<const ScalarField>& field);
  /// What make_noise_field() made of `field`, null where that is null or there was no memory for it; nothing
  /// until it is measured.
  [[nodiscard]] std::optional<std::shared_ptr<const ScalarField>> of(
      const std::shared_ptr<const ScalarField>& field) const;
  /// Requests it and waits for it.
  [[nodiscard]] std::shared_ptr<const ScalarField> wait(const std::shared_ptr<const ScalarField>& field);

 private:
  void run(const std::stop_token& stop);
  [[nodiscard]] bool has(const std::shared_ptr<const ScalarField>& field) const;

  std::function<void()> wake_;
  int threads_ = 0;
  mutable std::mutex mutex_;  ///< of the next four
  std::shared_ptr<const ScalarField> waiting_;
  std::weak_ptr<const ScalarField> asked_, measured_;  ///< a field that nobody has open is given back
  std::shared_ptr<const ScalarField> noise_;           ///< of `measured_`
  std::condition_variable_any wanted_, done_;
  std::jthread thread_;  // last: it uses all of the above
};

class HapticData {
 public:
  /// @param workspace_scale [m] per data unit; 0: the default of the data.
  /// @param wake called on other threads when there is something new to draw.
  HapticData(double workspace_scale, int threads, std::function<void()> wake);

  /// Whether this is the input that is open already: of a flow whichever scalar is felt, of others with the
  /// same scalar.
  [[nodiscard]] bool is_open(const NamedField& open) const noexcept;
  /// Takes another input. @pre !open.empty().
  void open(NamedField open);

  [[nodiscard]] const NamedField& field() const noexcept { return open_; }
  [[nodiscard]] bool empty() const noexcept { return open_.empty(); }
  [[nodiscard]] Workspace workspace() const;
  /// A flow, whose lines can be followed, kept and shown near the probe.
  [[nodiscard]] bool has_flow() const noexcept { return open_.field != nullptr; }
  /// Tensors alone, through which tracts are drawn by hand: the fibres of a heart come with the depth in its
  /// wall.
  [[nodiscard]] bool has_tensors() const noexcept { return open_.tensor != nullptr && !open_.scalar; }
  /// The fibres of a heart with the depth in its wall.
  [[nodiscard]] bool has_wall() const noexcept { return open_.tensor && open_.scalar && !open_.field; }
  /// What modes of a scalar feel; null where there is none.
  [[nodiscard]] const std::shared_ptr<const ScalarField>& scalar() const noexcept { return open_.scalar; }
  /// Direction in which that scalar grows fastest at `x`, unit; none where there is none.
  [[nodiscard]] std::optional<Vec3> gradient_at(const Vec3& x) const;
  /// Lowest and highest of what curves of mode `linear` take [data units]; 0 and 1 while there is no data.
  /// Steepness up to that of all values within an eighth of the diagonal, which little exceeds.
  [[nodiscard]] std::pair<double, double> measure_range(LinearMeasure measure) const;

  /// Of the scalar, counted once for it; null where there is none.
  [[nodiscard]] const ScalarStatistics* statistics() const;

  /// From now on what this chain feels is drawn.
  void follow(const HapticChain& made);
  /// The isovalues that are asked for; of count 0: those that the chain chose.
  void choose(const Isovalues& isovalues) noexcept { chosen_ = isovalues; }
  /// Which isosurfaces are felt; of no field in modes that feel none.
  [[nodiscard]] HapticLevels levels() const;
  /// Has their triangles made, or with `shown` false none.
  void request_surfaces(bool shown);
  /// What is drawn of them, and how far that is.
  [[nodiscard]] HapticSurfaces::Made surfaces() const;
  [[nodiscard]] std::optional<double> surfaces_fraction() const;

  /// Has the noise of the scalar measured.
  void request_noise() { noises_->request(open_.scalar); }
  /// Whether that is done.
  [[nodiscard]] bool has_noise() const { return noises_->of(open_.scalar).has_value(); }
  /// The noise of the chain that is felt; null: none is.
  [[nodiscard]] const std::shared_ptr<const ScalarField>& noise() const noexcept { return noise_; }
  /// The fixtures of that list, each read once. @throws Error as FixtureStore::list().
  [[nodiscard]] FixtureList read_fixtures(const std::vector<std::string>& texts) {
    return store_.list(texts);
  }
  /// Knows these already.
  void keep_fixtures(const FixtureStore& store) { store_ = store; }
  /// What is drawn of the fixtures of the chain that is felt.
  [[nodiscard]] const std::vector<SurfaceView>& fixture_views() const noexcept { return fixture_views_; }

  /// Builds what `description` says, waiting for the noise where that is felt. @throws Error as
  /// build_chain().
  [[nodiscard]] HapticChain build(const std::string& description, std::span<const HapticMode> modes);

  /// Has streamlines traced near `probe` (data coordinates) as `camera` sees it, which can be coloured like
  /// lines of `style`; none: kNone or no flow.
  void request_lines(SeedShape shape, const Vec3& probe, const Camera& camera, const LineStyle& style);
  [[nodiscard]] std::shared_ptr<const LocalSeeds> lines() const { return local_->drawn(); }

 private:
  double workspace_scale_;
  int threads_;
  NamedField open_;
  mutable std::shared_ptr<const ScalarField> counted_;  ///< of statistics()
  mutable ScalarStatistics statistics_;
  std::shared_ptr<const ScalarField> surfaces_of_, noise_;  ///< of the chain that is felt: HapticChain
  Isovalues chain_isovalues_, chosen_;
  FixtureStore store_;
  std::vector<SurfaceView> fixture_views_;
  std::function<void()> wake_;
  std::unique_ptr<LocalLines> local_;  ///< this and the next two from the first input on
  std::unique_ptr<HapticSurfaces> surfaces_;
  std::unique_ptr<MeasuredNoise> noises_;
};

}  // namespace palpate
