/// A rake or a plane of seeds at the probe, and the streamlines through them (Ikits 2006, figure 1.1), traced
/// on a thread of their own: the hand moves on meanwhile.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "common/field/vector_field.h"
#include "common/render/probe_view.h"

namespace palpate {

/// What is wanted; seeds lie about `center`.
struct LocalRequest {
  std::shared_ptr<const VectorField> field;
  SeedShape shape = SeedShape::kNone;
  Vec3 center{0.0};     ///< data coordinates
  Vec3 along{0.0};      ///< a rake, and one side of a plane, go from center - along to center + along
  Vec3 across{0.0};     ///< the other side of a plane
  int seeds = 11;       ///< of a rake; along one side of a plane
  double length = 0.0;  ///< of the lines on either side of their seeds, data units
  std::shared_ptr<const LineArray> array;  ///< that colours the scene, if one does: LocalSeeds::array

  bool operator==(const LocalRequest&) const = default;
};

/// The seeds of a request, those of a plane row by row.
[[nodiscard]] std::vector<Vec3> local_seeds(const LocalRequest& request);

class LocalLines {
 public:
  /// @param wake called on the tracing thread when there is something new.
  explicit LocalLines(std::function<void()> wake);
  LocalLines(const LocalLines&) = delete;
  LocalLines& operator=(const LocalLines&) = delete;

  /// The latest request wins; the same one again costs nothing.
  void request(const LocalRequest& request);
  /// What was traced last, for the latest shape; null where none is wanted.
  [[nodiscard]] std::shared_ptr<const LocalSeeds> drawn();

 private:
  void run(const std::stop_token& stop);

  std::function<void()> wake_;
  LocalRequest asked_;  ///< the owner's
  std::mutex mutex_;    ///< of the next three
  SeedShape shape_ = SeedShape::kNone;
  std::optional<LocalRequest> waiting_;
  std::shared_ptr<const LocalSeeds> drawn_;
  std::condition_variable_any wanted_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
