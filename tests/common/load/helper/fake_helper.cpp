// A helper program that misbehaves. What it does is the name of the file that it is asked to open.
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "common/load/helper/channel.h"
#include "common/load/helper/protocol.h"
#include "common/load/helper/sandbox.h"

using namespace palpate;

namespace {

std::string good_info() {
  FileInfo info;
  info.format = "fake";
  info.times = {0.0, 1.0};
  info.blocks.push_back(
      {"b", "uniform", Index3(2, 2, 2), 8, 1, {}, {{"v", Association::kPoint, 1, ScalarType::kFloat32, 8}}});
  return encode_info(info);
}

void answer(const std::string& json) {
  MemoryFile memory;
  if (!send_message(kHelperSocket, memory, json)) std::exit(0);
}

[[noreturn]] void wait_for_ever() {
  while (true) ::pause();
}

/// What this process can still do beyond its memory, each tried.
std::string ways_out() {
  std::string ways;
  const auto note = [&](bool done, const char* what) { ways += done ? std::string(" ") + what : ""; };
  char made[] = "/tmp/palpate-way-out-XXXXXX";
  note(::mkdtemp(made) != nullptr, "folder");
  const std::string file = "/tmp/palpate-way-out-" + std::to_string(::getpid());
  note(::open(file.c_str(), O_WRONLY | O_CREAT, 0600) >= 0, "new-file");
  const char* const own = std::getenv("PALPATE_FAKE_TARGET");
  note(::open(own, O_RDWR) >= 0, "writing");
  note(::truncate(own, 0) == 0, "truncating");
  note(::rename(own, file.c_str()) == 0, "renaming");
  note(::chmod(own, 0777) == 0, "chmod");
  note(::unlink(own) == 0, "removing");
  for (const int family : {AF_INET, AF_INET6, AF_UNIX, AF_NETLINK})
    note(::socket(family, SOCK_DGRAM, 0) >= 0, "socket");
  note(::kill(::getppid(), 0) == 0, "signals");
  const pid_t child = ::fork();
  if (child == 0) {
    ::execl("/bin/true", "true", static_cast<char*>(nullptr));
    ::_exit(1);
  }
  int status = 1;
  ::waitpid(child, &status, 0);
  note(status == 0, "program");
  // What has to go on.
  note(::open(own, O_RDONLY) < 0, "(no-reading)");
  MemoryFile memory;
  const std::vector<std::byte> block(4096);
  note(memory.append(block) != 0, "(no-memory)");
  return ways + ".";
}

void misbehave(const std::string& how) {
  if (how == "crash") {
    ::signal(SIGSEGV, SIG_DFL);  // a sanitizer would catch it
    ::raise(SIGSEGV);
  }
  if (how == "exit") {
    std::fputs("first line\nthe library said no\n", stderr);
    std::exit(7);
  }
  if (how == "hang") wait_for_ever();
  if (how == "late") {
    ::usleep(1'500'000);
    answer(good_info());
  }
  if (how == "close") {
    ::close(kHelperSocket);
    wait_for_ever();
  }
  if (how == "memory") {
    std::vector<void*> blocks;
    for (int i = 0; i < 64; ++i) {
      void* block =
          ::mmap(nullptr, std::size_t{1} << 26, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      if (block == MAP_FAILED) {
        answer(encode_failure(ExitCode::kBadInput, "refused after " + std::to_string(i) + " blocks"));
        return;
      }
      blocks.push_back(block);
    }
    answer(good_info());
  }
  if (how == "file") {
    MemoryFile memory;
    const std::vector<std::byte> block(std::size_t{1} << 24);
    for (int i = 0; i < 64; ++i) memory.append(block);  // the size limit ends this with a signal
    answer(good_info());
  }
  if (how == "unsealed") {
    const UniqueFd fd(::memfd_create("x", MFD_CLOEXEC));
    const std::string json = good_info();
    if (::write(fd.get(), json.data(), json.size()) < 0) std::exit(1);
    Frame frame;
    frame.json_bytes = json.size();
    (void)send_frame(kHelperSocket, frame, fd.get());
  }
  if (how == "outside") {
    MemoryFile memory;
    memory.append({});
    memory.seal();
    Frame frame;
    frame.json_offset = 1 << 20;
    frame.json_bytes = ~std::uint64_t{0} - 5;
    (void)send_frame(kHelperSocket, frame, memory.fd());
  }
  if (how == "naked") (void)send_frame(kHelperSocket, Frame{}, -1);
  if (how == "pipe") {
    // A descriptor that is no memory at all.
    Frame frame;
    (void)send_frame(kHelperSocket, frame, STDIN_FILENO);
  }
  if (how == "short" && ::write(kHelperSocket, "PLP1", 4) < 0) std::exit(1);
  if (how == "garbage") answer(std::string(1000, '\xff'));
  if (how == "flood") {
    Frame frame;
    frame.kind = Frame::kProgress;
    frame.fraction = 0.5;
    while (send_frame(kHelperSocket, frame, -1)) {
    }
  }
  if (how == "sandbox") {
    const Sandbox sandbox = enter_sandbox();
    answer(encode_failure(ExitCode::kBadInput, std::string(sandbox.files ? "files " : "") +
                                                   (sandbox.network ? "network " : "") + "kept; got out by" +
                                                   ways_out()));
  }
  if (how == "environment") {
    char limits[4096] = {};
    const UniqueFd fd(::open("/proc/self/limits", O_RDONLY));
    if (::read(fd.get(), limits, sizeof(limits) - 1) < 0) std::exit(1);
    std::string open_files;
    for (int i = 0; i < 64; ++i) {
      if (i != fd.get() && ::fcntl(i, F_GETFD) >= 0) open_files += std::to_string(i) + " ";
    }
    answer(
        encode_failure(ExitCode::kBadInput, "open: " + open_files + "stdin: " + std::to_string(::getchar())));
  }
}

}  // namespace

int main() {
  while (true) {
    Frame frame;
    UniqueFd fd;
    const Received received = receive_frame(kHelperSocket, -1, frame, fd);
    if (received == Received::kTimeOut) continue;
    if (received != Received::kFrame) return 0;
    const auto memory = MappedMemory::map(fd);
    const RequestMessage request = decode_request(json_of(frame, memory->bytes()));
    static std::string how;
    if (const auto* open = std::get_if<OpenMessage>(&request)) {
      how = open->request.files.front().stem().string();
      if (how.rfind("later-", 0) == 0) {
        answer(good_info());
      } else {
        misbehave(how);
      }
    } else if (how.rfind("later-", 0) == 0) {
      misbehave(how.substr(6));
    }
  }
}
