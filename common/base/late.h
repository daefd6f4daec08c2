/// A value that is made when it is first asked for, and then kept: what takes long to find out is not found out for nobody.
#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <utility>

namespace palpate {

/// Copies share the value. From any thread: one makes it, the others wait for it.
template <typename T>
class Late {
 public:
  Late() : Late(T()) {}
  Late(T value) {  // NOLINT(google-explicit-constructor): what is known is as good
    std::promise<T> made;
    made.set_value(std::move(value));
    value_ = made.get_future().share();
  }
  /// @param make is called once at most.
  [[nodiscard]] static Late by(std::function<T()> make) {
    Late late(std::shared_future<T>{});
    late.value_ = std::async(std::launch::deferred, std::move(make)).share();
    return late;
  }

  /// @throws what making it does, each time.
  [[nodiscard]] const T& get() const { return value_.get(); }
  [[nodiscard]] bool made() const {
    return value_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

 private:
  explicit Late(std::shared_future<T> value) : value_(std::move(value)) {}

  std::shared_future<T> value_;
};

}  // namespace palpate
