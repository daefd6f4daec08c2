/// What the files of the library share and nobody else sees: what handles hold, jobs that are watched, errors.
#pragma once

#include <chrono>
#include <cstdint>
#include <future>
#include <memory>
#include <mutex>
#include <new>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/progress.h"
#include "common/field/data_set.h"
#include "common/field/scalar_field.h"
#include "common/field/vector_field.h"
#include "common/geometry/line.h"
#include "common/haptics/proxy_chain.h"
#include "common/math/vec.h"
#include "common/scene/input.h"
#include "common/servo/hand_step.h"
#include "library/palpate/palpate.h"
#include "library/palpate/touch.h"

namespace palpate::api {

inline Error::Kind kind_of(ExitCode code) {
  switch (code) {
    case ExitCode::kUsage:
      return Error::Kind::kUsage;
    case ExitCode::kBadInput:
      return Error::Kind::kBadInput;
    case ExitCode::kInterrupted:
      return Error::Kind::kInterrupted;
    default:
      return Error::Kind::kWorkFailed;
  }
}

/// What `work` returns; what it throws as the library's own error.
template <class Work>
auto guarded(const Work& work) {
  try {
    return work();
  } catch (const palpate::Error& error) {
    throw Error(kind_of(error.code()), error.what());
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::kWorkFailed, "not enough memory");
  }
}

/// What `work` returns, which runs in a thread of its own while `watch` is asked in this one.
template <class Work>
auto watched(const Watcher& watch, const Work& work) {
  return guarded([&] {
    constexpr std::chrono::milliseconds kWatchPeriod{100};
    Progress progress;
    if (!watch) return work(progress);
    auto done = std::async(std::launch::async, [&] { return work(progress); });
    try {
      while (done.wait_for(kWatchPeriod) != std::future_status::ready) {
        if (!watch(progress.stage(), progress.fraction())) progress.cancel();
      }
    } catch (...) {  // of the watcher; the future waits for the work
      progress.cancel();
      throw;
    }
    return done.get();
  });
}

inline Point point_of(const Vec3& x) { return {x.x, x.y, x.z}; }
inline Vec3 vec_of(const Point& x) { return {x[0], x[1], x[2]}; }

struct FieldData {
  std::shared_ptr<const VectorField> field;
};

struct ScalarData {
  std::shared_ptr<const ScalarField> field;
};

struct OpenData {
  Input input;
  mutable std::mutex mutex;
};

/// Makes the handles and looks into them.
struct Access {
  static Field field(std::shared_ptr<const VectorField> made) {
    Field handle;
    handle.data_ = std::make_shared<FieldData>(FieldData{std::move(made)});
    return handle;
  }
  static Scalar scalar(std::shared_ptr<const ScalarField> made) {
    Scalar handle;
    handle.data_ = std::make_shared<ScalarData>(ScalarData{std::move(made)});
    return handle;
  }
  static Data data(Input input) {
    Data handle;
    handle.data_ = std::shared_ptr<OpenData>(new OpenData{std::move(input), {}});
    return handle;
  }
  static const std::shared_ptr<const VectorField>& of(const Field& handle) { return handle.data_->field; }
  static const std::shared_ptr<const ScalarField>& of(const Scalar& handle) { return handle.data_->field; }
  static OpenData& of(const Data& handle) { return *handle.data_; }
  static void set(Lines& handle, std::shared_ptr<const LineData> made) { handle.data_ = std::move(made); }
  static std::vector<Line> lines(const Lines& handle);
};

struct LinkData;

struct ChainData {
  std::vector<std::shared_ptr<const LinkData>> links;
  ChainSettings settings;
  DeviceLimits limits;
  double scale = 1.0;
};

/// What was felt, step by step.
struct TouchData {
  std::size_t links = 0;
  std::vector<double> times;
  std::vector<Point> probes, proxies, force;
  std::vector<double> residual;
  std::vector<std::uint8_t> state;

  /// @param probe where the hand was, as the caller knows it; null: as the step has it.
  void add(const HandStep& step, double scale, const Point* probe = nullptr);
};

struct TouchAccess {
  static Link link(LinkData made);
  static const std::shared_ptr<const LinkData>& of(const Link& handle) { return handle.data_; }
  static const ChainData& of(const Chain& handle) { return *handle.data_; }
  static Touch touch(TouchData made);
  /// Without proxies, as a chain begins.
  static std::unique_ptr<ProxyChain> make(const Chain& chain);
};

/// A mesh of tetrahedra; its points are not copied. @param cells four points each.
/// @throws Error (bad input), of the programs, for a corner that is no point.
[[nodiscard]] UnstructuredTopology tetrahedra_of(const SharedDoubles& points,
                                                 std::span<const std::int64_t> cells);

}  // namespace palpate::api
