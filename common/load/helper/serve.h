/// The helper program's side: a Loader, and the loop that answers an explorer's requests with it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

#include "common/base/progress.h"
#include "common/load/format.h"
#include "common/load/helper/memory_file.h"
#include "common/load/load.h"

namespace palpate {

/// Reads one family of file formats. One object serves one opened input.
class Loader {
 public:
  Loader() = default;
  virtual ~Loader() = default;
  Loader(const Loader&) = delete;
  Loader& operator=(const Loader&) = delete;

  /// Finds out what the files hold: all of FileInfo but its first two members. `request` was checked: the files exist and are of `format`.
  /// @throws Error (bad input) with a line that names the file.
  virtual FileInfo open(const LoadRequest& request, Format format) = 0;

  /// Topology of every block and the named arrays at a time step (< times, or 0). @throws Error.
  virtual std::vector<DataSet> read(const std::vector<std::string>& array_names, std::size_t time_step) = 0;

  /// Whether it lays files apart in the folder of temporary files; others may write nothing.
  [[nodiscard]] virtual bool writes_temporary_files() const { return false; }

  /// Called with the part done, 0 to 1, now and then; may be empty.
  std::function<void(double)> on_progress;
  /// Memory for numbers that read() gives, zeros: that of the answer, so that they need not be copied. Empty: there is none.
  std::function<std::shared_ptr<std::byte>(std::uint64_t bytes)> room;
};

/// What a helper program does with a request.
struct Service {
  /// Gets the JSON of the request, the memory of its arrays, and the memory for the arrays of the answer.
  /// @return the JSON of the answer. @throws Error, and whatever else: the explorer gets it as a failure.
  std::function<std::string(std::string_view, std::span<const std::byte>, MemoryFile&)> answer;
  std::string subject;  ///< a file, for messages that come from below any reader
};

/// Answers requests on kHelperSocket until the explorer goes away; the exit status of the helper program.
int serve(Service& service);

/// Says something to the explorer's user while an answer is being made: a JSON object that both ends agree
/// on. Safe from the thread that makes the answer.
void send_news(std::string_view json);

/// While it lives, the explorer shows `progress`: its stage and the part done, ten times a second.
class ProgressReporter {
 public:
  explicit ProgressReporter(const Progress& progress);
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

 private:
  std::jthread thread_;
};

/// Answers requests on kHelperSocket until the explorer goes away; the exit status of the helper program.
/// The helper ends as soon as its explorer does, in the middle of a reading too. It works in a sandbox (sandbox.h).
int serve_loader(Loader& loader);

}  // namespace palpate
