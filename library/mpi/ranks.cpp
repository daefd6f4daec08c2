#include "library/mpi/ranks.h"

#include <algorithm>
#include <chrono>
#include <limits>
#include <thread>

#include <mpi.h>

#include "common/base/clock.h"
#include "common/base/index.h"

namespace palpate::mpi {

struct Ranks::Pending {
  MPI_Request request = MPI_REQUEST_NULL;
};

Ranks::Ranks(int& argc, char**& argv) {
  MPI_Init(&argc, &argv);
  MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
  MPI_Comm_size(MPI_COMM_WORLD, &count_);
}

Ranks::~Ranks() { MPI_Finalize(); }

void Ranks::abort(ExitCode code) {
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  std::abort();  // not reached: MPI_Abort() is not declared as one that does not return
}

void Ranks::finish(Pending& pending) {
  constexpr int kSpins = 200;
  constexpr std::chrono::microseconds kSleep{100};
  const Stopwatch watch;
  int done = 0;
  for (int n = 0;; ++n) {
    MPI_Test(&pending.request, &done, MPI_STATUS_IGNORE);
    if (done != 0) break;
    if (n > kSpins) std::this_thread::sleep_for(kSleep);
  }
  waited_ += watch.seconds();
}

void Ranks::sum(std::span<std::int64_t> numbers) {
  Pending pending;
  MPI_Iallreduce(MPI_IN_PLACE, numbers.data(), static_cast<int>(numbers.size()), MPI_INT64_T, MPI_SUM,
                 MPI_COMM_WORLD, &pending.request);
  finish(pending);
}

std::vector<std::int64_t> Ranks::sum_before(std::span<const std::int64_t> numbers) {
  std::vector<std::int64_t> sums(numbers.size(), 0);
  Pending pending;
  MPI_Iexscan(numbers.data(), sums.data(), static_cast<int>(numbers.size()), MPI_INT64_T, MPI_SUM,
              MPI_COMM_WORLD, &pending.request);
  finish(pending);
  if (rank_ == 0) std::ranges::fill(sums, 0);  // undefined there
  return sums;
}

std::vector<double> Ranks::gather(double number) {
  std::vector<double> all(rank_ == 0 ? as_size(count_) : 0);
  MPI_Gather(&number, 1, MPI_DOUBLE, all.data(), 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  return all;
}

std::vector<std::byte> Ranks::exchange(const std::vector<std::vector<std::byte>>& to) {
  constexpr std::int64_t kMost = std::numeric_limits<int>::max();  // MPI counts in int
  std::vector<int> sent(as_size(count_)), received(as_size(count_)), sent_at(as_size(count_)),
      received_at(as_size(count_));
  std::vector<std::byte> out;
  std::int64_t total = 0;
  for (std::size_t r = 0; r < to.size(); ++r) total += static_cast<std::int64_t>(to[r].size());
  constexpr const char* kTooMuch =
      "lines of more than 2 GB would move to one rank in a round: start more ranks";
  if (total > kMost) throw work_error(kTooMuch);
  out.reserve(as_size(total));
  for (std::size_t r = 0; r < to.size(); ++r) {
    sent[r] = static_cast<int>(to[r].size());
    sent_at[r] = static_cast<int>(out.size());
    out.insert(out.end(), to[r].begin(), to[r].end());
    if (r != as_size(rank_)) bytes_sent_ += sent[r];
  }
  Pending counts;
  MPI_Ialltoall(sent.data(), 1, MPI_INT, received.data(), 1, MPI_INT, MPI_COMM_WORLD, &counts.request);
  finish(counts);
  total = 0;
  for (std::size_t r = 0; r < received.size(); ++r) {
    received_at[r] = static_cast<int>(std::min(total, kMost));
    total += received[r];
  }
  if (total > kMost) throw work_error(kTooMuch);
  std::vector<std::byte> in(as_size(total));
  Pending bytes;
  MPI_Ialltoallv(out.data(), sent.data(), sent_at.data(), MPI_BYTE, in.data(), received.data(),
                 received_at.data(), MPI_BYTE, MPI_COMM_WORLD, &bytes.request);
  finish(bytes);
  return in;
}

void Ranks::wait_for_all() {
  Pending pending;
  MPI_Ibarrier(MPI_COMM_WORLD, &pending.request);
  finish(pending);
}

void Ranks::agree(ExitCode code, const std::string& line) {
  const int failed = code == ExitCode::kDone ? count_ : rank_;
  int first = count_;
  MPI_Allreduce(&failed, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == count_) return;
  int what[2] = {static_cast<int>(code), static_cast<int>(line.size())};
  MPI_Bcast(what, 2, MPI_INT, first, MPI_COMM_WORLD);
  std::string text = line;
  text.resize(as_size(what[1]));
  MPI_Bcast(text.data(), what[1], MPI_CHAR, first, MPI_COMM_WORLD);
  throw Agreed(static_cast<ExitCode>(what[0]), text);
}

}  // namespace palpate::mpi
