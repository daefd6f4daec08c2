/// The noise of a field (field/noise_field.h), measured on a thread of its own: the hand moves on meanwhile,
/// and what was measured stays with the field.
#pragma once

#include <condition_variable>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "common/field/scalar_field.h"

namespace palpate {

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

}  // namespace palpate
