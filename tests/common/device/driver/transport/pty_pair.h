/// A real pair of pseudo terminals: a driver opens one side as a serial line, a model speaks at the other,
/// on a thread of its own and in real time. The line is as a system has it: it echoes, joins lines and obeys
/// control characters until it is set up.
#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "tests/common/device/driver/transport/fake_line.h"

namespace palpate::test {

class PtyPair {
 public:
  /// @throws std::runtime_error where the system gives none.
  explicit PtyPair(std::shared_ptr<Speaker> speaker);
  /// The other side closes, as that of a line that is pulled out.
  ~PtyPair();
  PtyPair(const PtyPair&) = delete;
  PtyPair& operator=(const PtyPair&) = delete;

  [[nodiscard]] const std::string& path() const { return path_; }
  /// Held while the speaker is called, for a test that changes it meanwhile.
  [[nodiscard]] std::mutex& mutex() { return mutex_; }

 private:
  void work(const std::stop_token& stop);

  std::shared_ptr<Speaker> speaker_;
  std::string path_;
  int master_ = -1;
  std::mutex mutex_;
  std::jthread thread_;  // last: it uses the above
};

}  // namespace palpate::test
