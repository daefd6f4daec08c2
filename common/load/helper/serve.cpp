#include "common/load/helper/serve.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <filesystem>
#include <mutex>
#include <new>
#include <system_error>
#include <thread>

#include <fcntl.h>
#include <poll.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/load/helper/channel.h"
#include "common/load/helper/protocol.h"
#include "common/load/helper/sandbox.h"

namespace palpate {
namespace {

/// Ends the process when the other end of the socket closes, whatever the loader is doing. The explorer's
/// death closes it too, and that of the thread which started the helper does not: so this serves better
/// than PR_SET_PDEATHSIG, which follows the thread.
void end_with_explorer() {
  std::thread([] {
    pollfd wait{kHelperSocket, POLLRDHUP, 0};
    while (true) {
      const int ready = ::poll(&wait, 1, -1);
      if (ready > 0 && (wait.revents & (POLLRDHUP | POLLHUP | POLLERR | POLLNVAL)) != 0) ::_exit(0);
    }
  }).detach();
}

/// What is in memory before the answer, so that an error in the middle of encoding starts afresh.
struct Answer {
  MemoryFile memory;
  std::string json;
};

Answer failure(ExitCode code, const std::string& line) { return {MemoryFile(), encode_failure(code, line)}; }

}  // namespace

int serve(Service& service) {
  if (::fcntl(kHelperSocket, F_GETFD) < 0) {
    std::fputs("This program works for the explorers, which start it themselves.\n", stderr);
    return static_cast<int>(ExitCode::kUsage);
  }
  end_with_explorer();

  while (true) {
    Frame frame;
    UniqueFd fd;
    const Received received = receive_frame(kHelperSocket, -1, frame, fd);
    if (received == Received::kTimeOut) continue;
    if (received == Received::kClosed) return 0;
    if (received == Received::kMalformed || frame.kind != Frame::kMessage) return 1;

    Answer answer;
    try {
      const auto memory = MappedMemory::map(fd);
      answer.json = service.answer(json_of(frame, memory->bytes()), memory->bytes(), answer.memory);
    } catch (const Error& error) {
      answer = failure(error.code(), error.what());
    } catch (const std::bad_alloc&) {
      answer = failure(ExitCode::kBadInput,
                       input_error({service.subject, "", "needs more memory than its size justifies", "",
                                    "the file may be damaged, or the machine too small"})
                           .what());
    } catch (const std::system_error& error) {
      answer = failure(
          ExitCode::kBadInput,
          input_error({service.subject, "", std::string("out of memory or files (") + error.what() + ")"})
              .what());
    } catch (const std::exception& error) {
      answer = failure(ExitCode::kBadInput, input_error({service.subject, "", error.what()}).what());
    }
    if (!send_message(kHelperSocket, answer.memory, answer.json)) return 0;
  }
}

void send_news(std::string_view json) {
  MemoryFile memory;
  (void)send_message(kHelperSocket, memory, json, Frame::kNews);  // a lost explorer ends this process anyway
}

ProgressReporter::ProgressReporter(const Progress& progress)
    : thread_([&progress](const std::stop_token& stop) {
        std::mutex mutex;
        std::condition_variable_any wake;
        std::unique_lock lock(mutex);
        constexpr std::chrono::milliseconds kBetween(100);
        while (!wake.wait_for(lock, stop, kBetween, [] { return false; }) && !stop.stop_requested()) {
          Frame frame;
          frame.kind = Frame::kProgress;
          frame.fraction = progress.fraction();
          const std::string stage = progress.stage();
          std::copy_n(stage.data(), std::min(stage.size(), frame.stage.size() - 1), frame.stage.data());
          (void)send_frame(kHelperSocket, frame, -1);
        }
      }) {}

ProgressReporter::~ProgressReporter() = default;

int serve_loader(Loader& loader) {
  std::vector<std::filesystem::path> writable;
  std::error_code ignored;
  if (loader.writes_temporary_files()) writable.push_back(std::filesystem::temp_directory_path(ignored));
  (void)enter_sandbox(writable);

  // At most some twenty reports a second: a reader may call for every cell.
  auto last = std::chrono::steady_clock::now();
  loader.on_progress = [&last](double fraction) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last < std::chrono::milliseconds(50)) return;
    last = now;
    Frame frame;
    frame.kind = Frame::kProgress;
    frame.fraction = fraction;
    (void)send_frame(kHelperSocket, frame, -1);  // a lost explorer ends this process anyway
  };

  Service service;
  service.answer = [&](std::string_view text, std::span<const std::byte>, MemoryFile& memory) {
    const RequestMessage request = decode_request(text);
    if (const auto* open = std::get_if<OpenMessage>(&request)) {
      if (!open->request.files.empty()) service.subject = open->request.files.front().string();
      FileInfo info = loader.open(open->request, open->format);
      info.format = row_of(open->format).name;
      info.loader = row_of(open->format).helper;
      return encode_info(info);
    }
    const auto& read = std::get<ReadMessage>(request);
    loader.room = [&memory](std::uint64_t bytes) { return memory.room(bytes); };
    return encode_blocks(loader.read(read.arrays, read.time_step), memory);
  };
  return serve(service);
}

}  // namespace palpate
