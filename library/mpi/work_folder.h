/// What a run keeps in files: the parts of lines that are traced, and after whole rounds the lines on their way. From the
/// last whole round a run goes on, with any number of ranks.
///
///   job                  what is traced, a line each: another job does not go on from here
///   whole                the rounds that are kept whole, a line each: round and ranks
///   parts.ROUND.RANK     parts of lines since the whole round before
///   held.ROUND.RANK      lines on their way after it; of the last whole round alone
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "library/mpi/line_parts.h"
#include "library/mpi/ranks.h"

namespace palpate::mpi {

class WorkFolder {
 public:
  /// Makes it, or finds what is there. Together on all ranks.
  /// @param job lines that say what is traced. @throws Error (usage) where another one is kept there; (work failed).
  WorkFolder(std::filesystem::path path, const std::string& job, Ranks& ranks);

  /// The last whole round; 0: none, the run begins.
  [[nodiscard]] std::int64_t last_round() const noexcept {
    return rounds_.empty() ? 0 : rounds_.back().round;
  }
  /// This rank's share of what was held then.
  [[nodiscard]] std::vector<HeldLine> held() const;
  /// Keeps a round. @throws Error (work failed) where the disk refuses, on all ranks.
  void keep(std::int64_t round, std::span<const HeldLine> held, std::span<const std::byte> parts);
  /// All parts that are kept.
  [[nodiscard]] std::vector<LinePart> parts() const;
  /// Removes the folder, where nothing else is in it.
  void remove() const;

 private:
  struct Round {
    std::int64_t round = 0;
    int ranks = 0;
  };
  [[nodiscard]] std::filesystem::path file(const char* what, std::int64_t round, int rank) const;
  void open(const std::string& job);
  [[nodiscard]] std::vector<Round> read_rounds() const;
  void remove_broken_rounds() const;

  std::filesystem::path path_;
  Ranks& ranks_;
  std::vector<Round> rounds_;
};

}  // namespace palpate::mpi
