#include "library/mpi/work_folder.h"

#include <algorithm>
#include <fstream>
#include <set>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/files/output_file.h"
#include "common/base/index.h"

namespace palpate::mpi {
namespace {

namespace fs = std::filesystem;

void write(const fs::path& path, std::span<const std::byte> bytes) {
  OutputFile out(path, true);
  out.write(bytes);
  out.finish();
}

std::string text_of(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

/// The first line of `kept` that differs from the one of `asked` in its place.
std::string difference(const std::string& kept, const std::string& asked) {
  std::istringstream a(kept), b(asked);
  std::string of_kept, of_asked;
  while (std::getline(a, of_kept)) {
    std::getline(b, of_asked);
    if (of_kept != of_asked) return of_kept;
  }
  return "a run of another version";
}

std::vector<std::byte> bytes_of(const fs::path& path) {
  if (fs::file_size(path) == 0) return {};
  const MappedFile file(path.string());
  const auto bytes = std::as_bytes(std::span(file.text()));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

WorkFolder::WorkFolder(fs::path path, const std::string& job, Ranks& ranks)
    : path_(std::move(path)), ranks_(ranks) {
  ranks_.together([&] {
    if (ranks_.rank() == 0) open(job);
  });
  ranks_.together([&] { rounds_ = read_rounds(); });
}

void WorkFolder::open(const std::string& job) {
  std::error_code refused;
  fs::create_directories(path_, refused);
  if (refused)
    throw work_error("the work folder " + path_.string() + " cannot be made: " + refused.message());
  const fs::path named = path_ / "job";
  if (fs::exists(named)) {
    const std::string kept = text_of(named);
    if (kept != job)
      throw usage_error("the work folder " + path_.string() + " holds another run (" + difference(kept, job) +
                        "): repeat that one, remove the folder, or name another by --work");
  } else if (!fs::is_empty(path_)) {
    throw usage_error("the work folder " + path_.string() + " holds files of others: name another by --work");
  } else {
    write(named, std::as_bytes(std::span(job)));
  }
  rounds_ = read_rounds();
  remove_broken_rounds();
}

std::vector<WorkFolder::Round> WorkFolder::read_rounds() const {
  std::vector<Round> rounds;
  std::ifstream in(path_ / "whole");
  for (Round round; in >> round.round >> round.ranks;) rounds.push_back(round);
  return rounds;
}

fs::path WorkFolder::file(const char* what, std::int64_t round, int rank) const {
  return path_ / (std::string(what) + "." + std::to_string(round) + "." + std::to_string(rank));
}

/// What a run that broke off has left of a round that is not whole.
void WorkFolder::remove_broken_rounds() const {
  std::set<fs::path> whole{path_ / "job", path_ / "whole"};
  for (const Round& round : rounds_) {
    for (int rank = 0; rank < round.ranks; ++rank) {
      whole.insert(file("parts", round.round, rank));
      if (round.round == last_round()) whole.insert(file("held", round.round, rank));
    }
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(path_)) {
    if (!whole.contains(entry.path())) fs::remove(entry.path());
  }
}

std::vector<HeldLine> WorkFolder::held() const {
  std::vector<HeldLine> all;
  if (rounds_.empty()) return all;
  for (int rank = ranks_.rank(); rank < rounds_.back().ranks; rank += ranks_.count()) {
    std::vector<HeldLine> of_rank = unpack_held(bytes_of(file("held", last_round(), rank)));
    std::ranges::move(of_rank, std::back_inserter(all));
  }
  return all;
}

void WorkFolder::keep(std::int64_t round, std::span<const HeldLine> held, std::span<const std::byte> parts) {
  const Round before = rounds_.empty() ? Round() : rounds_.back();
  ranks_.together([&] {
    std::vector<std::byte> bytes;
    for (const HeldLine& line : held) pack(line, bytes);
    write(file("held", round, ranks_.rank()), bytes);
    write(file("parts", round, ranks_.rank()), parts);
  });
  rounds_.push_back({round, ranks_.count()});
  ranks_.together([&] {
    if (ranks_.rank() != 0) return;
    std::string text;
    for (const Round& each : rounds_)
      text += std::to_string(each.round) + " " + std::to_string(each.ranks) + "\n";
    write(path_ / "whole", std::as_bytes(std::span(text)));
    for (int rank = 0; rank < before.ranks; ++rank) fs::remove(file("held", before.round, rank));
  });
}

std::vector<LinePart> WorkFolder::parts() const {
  std::vector<LinePart> all;
  for (const Round& round : rounds_) {
    for (int rank = 0; rank < round.ranks; ++rank) {
      std::vector<LinePart> of_rank = unpack_parts(bytes_of(file("parts", round.round, rank)));
      std::ranges::move(of_rank, std::back_inserter(all));
    }
  }
  return all;
}

void WorkFolder::remove() const {
  remove_broken_rounds();
  for (const Round& round : rounds_) {
    for (int rank = 0; rank < round.ranks; ++rank) {
      fs::remove(file("parts", round.round, rank));
      fs::remove(file("held", round.round, rank));
    }
  }
  fs::remove(path_ / "whole");
  fs::remove(path_ / "job");
  fs::remove(path_);
}

}  // namespace palpate::mpi
