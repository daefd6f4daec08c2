/// The ranks of a run and what they tell one another: the one place of MPI.
///
/// All exchanges are collective, once a round: rounds are what a run restarts from, a sum over all ranks says when
/// no line is left, and no message is under way between two of them. A rank that waits sleeps, so that more ranks
/// than processors do not take time from one another.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "common/base/error.h"

namespace palpate::mpi {

/// An error that all ranks throw.
class Agreed : public Error {
  using Error::Error;
};

class Ranks {
 public:
  Ranks(int& argc, char**& argv);
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  [[nodiscard]] int rank() const noexcept { return rank_; }
  [[nodiscard]] int count() const noexcept { return count_; }

  /// Replaces each number by its sum over all ranks.
  void sum(std::span<std::int64_t> numbers);
  /// Of each number the sum over the ranks before this one.
  [[nodiscard]] std::vector<std::int64_t> sum_before(std::span<const std::int64_t> numbers);
  /// Of each rank's number, in their order; for rank 0, empty elsewhere.
  [[nodiscard]] std::vector<double> gather(double number);
  /// Sends to each rank its bytes. @return what all sent to this one, by rank.
  /// @throws Error (work failed) where a rank would get or send 2 GB or more.
  [[nodiscard]] std::vector<std::byte> exchange(const std::vector<std::vector<std::byte>>& to);
  void wait_for_all();

  /// Runs `work` on every rank, in which nothing is exchanged. Where it throws on some, all throw the error of the first of
  /// them. An error outside of this is one rank's alone: abort() is all that helps.
  /// @throws Agreed.
  template <class Work>
  void together(const Work& work) {
    ExitCode code = ExitCode::kDone;
    std::string line;
    try {
      work();
    } catch (const Error& error) {
      code = error.code();
      line = error.what();
    } catch (const std::bad_alloc&) {
      code = ExitCode::kWorkFailed;
      line = "not enough memory";
    }
    agree(code, line);
  }
  /// Ends all ranks at once, where one alone has failed.
  [[noreturn]] void abort(ExitCode code);

  [[nodiscard]] std::int64_t bytes_sent() const noexcept { return bytes_sent_; }  ///< to other ranks
  [[nodiscard]] double seconds_waited() const noexcept { return waited_; }

 private:
  struct Pending;
  void agree(ExitCode code, const std::string& line);
  void finish(Pending& pending);

  int rank_ = 0, count_ = 1;
  std::int64_t bytes_sent_ = 0;
  double waited_ = 0.0;
};

}  // namespace palpate::mpi
