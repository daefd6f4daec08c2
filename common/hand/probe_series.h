/// A scalar over time at the probe, read step by step on a thread of its own: the hand moves on meanwhile.
///
/// Steps are read from coarse to fine, so that a curve is there in rough from the start. Of all steps one is
/// in memory, unless they are to be kept: then a curve follows the hand at once when each has been read.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/base/progress.h"
#include "common/field/scalar_field.h"
#include "common/math/vec.h"
#include "common/scene/input.h"

namespace palpate {

/// Values at one place.
struct SeriesCurve {
  std::string name;            ///< of the scalar; empty: nothing is plotted
  std::optional<Vec3> place;   ///< data coordinates; none before the probe was anywhere
  std::vector<double> times;   ///< ascending
  std::vector<double> values;  ///< NaN where there is none, or none yet
  std::size_t read = 0;        ///< how many of them are known
  std::string problem;         ///< why there is no curve; empty: there is
};

/// The numbers below `count`, each half way between ones that came before as far as that goes: 0, count - 1,
/// …
[[nodiscard]] std::vector<std::size_t> coarse_to_fine(std::size_t count);

class ProbeSeries {
 public:
  /// @param wake called on the thread that reads when there is something new.
  explicit ProbeSeries(std::function<void()> wake);
  ~ProbeSeries();  ///< cancels what is being read
  ProbeSeries(const ProbeSeries&) = delete;
  ProbeSeries& operator=(const ProbeSeries&) = delete;

  /// Opens the input anew, beside what the window has open, and reads `value` of it from now on. The place
  /// stays. @param value a scalar's label; empty: nothing is read.
  void choose(const InputOptions& input, const std::string& value, int threads);
  /// The latest place wins. One that has moved by less than a thousandth of the data's size is the same.
  void request(const Vec3& place);
  /// Whether steps stay in memory once they were read.
  void keep_steps(bool keep);

  [[nodiscard]] SeriesCurve curve() const;
  /// Whether the curve of the last request is still to come, in part or as a whole.
  [[nodiscard]] bool reading() const;

 private:
  /// What is wanted.
  struct Wanted {
    std::uint64_t choice = 0;  ///< counts calls of choose()
    InputOptions input;
    std::string value;
    int threads = 0;
    std::optional<Vec3> place;
    bool keep = false;
  };
  class Reader;
  void run(const std::stop_token& stop);
  void fill(Reader& reader, const Wanted& wanted, Progress& progress, const std::stop_token& stop);
  [[nodiscard]] bool current(const Wanted& wanted, double seconds) const;
  void publish(const Wanted& wanted, const SeriesCurve& curve);

  std::function<void()> wake_;
  mutable std::mutex mutex_;  ///< of the next five
  Wanted wanted_;
  bool due_ = false;    ///< something wanted has not been looked at
  bool busy_ = false;   ///< something is being read
  double moved_ = 0.0;  ///< less than that is no move [data units]
  SeriesCurve curve_;
  std::shared_ptr<Progress> progress_;  ///< of what is being read
  std::condition_variable_any asked_;
  std::jthread thread_;  // last: it uses all of the above
};

}  // namespace palpate
