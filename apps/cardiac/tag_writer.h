/// Writes what a wall's surfaces were found or painted as into a mesh, while the window goes on.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include "common/base/progress.h"
#include "common/scene/document/document.h"

namespace palpate {

/// One file at a time, on a thread of its own.
class TagWriter {
 public:
  TagWriter() = default;
  ~TagWriter();  ///< what is not written by then is not written
  TagWriter(const TagWriter&) = delete;
  TagWriter& operator=(const TagWriter&) = delete;

  /// Opens what `document` has open once more and writes it as `info --surfaces FILE.vtu` does. @pre not running().
  void start(const Document& document, const std::filesystem::path& file);
  [[nodiscard]] bool running() const noexcept { return job_ != nullptr && !job_->ended; }

  struct News {
    std::string words;  ///< empty: there are none
    bool failed = false;
  };
  /// What came of it, told once.
  [[nodiscard]] News news();

 private:
  struct Job {
    Progress progress;
    News news;  ///< set before `ended`
    std::atomic<bool> ended{false};
  };
  std::unique_ptr<Job> job_;
  std::jthread thread_;  // last: it uses the job
};

}  // namespace palpate
