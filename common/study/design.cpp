#include "common/study/design.h"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <tuple>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/study/random_stream.h"

namespace palpate {
namespace {

/// A cyclic Latin square with rows, columns and symbols renumbered at random.
struct Square {
  Square(int size, RandomStream& random)
      : rows(random.order(size)), columns(random.order(size)), symbols(random.order(size)) {}

  [[nodiscard]] int row(int at) const { return rows[as_size(at)]; }
  [[nodiscard]] int column(int at) const { return columns[as_size(at)]; }
  [[nodiscard]] int symbol(int r, int c) const {
    return symbols[as_size((row(r) + column(c)) % static_cast<int>(symbols.size()))];
  }

  std::vector<int> rows, columns, symbols;
};

}  // namespace

std::vector<PlannedTrial> make_design(const DesignRequest& request) {
  const int n = request.recorded;
  if (n < 2 || n % 2 != 0) throw usage_error("--recorded: an even number of trials is needed, 2 or more");
  if (request.participants < 1 || request.tasks < 1 || request.practice < 0)
    throw usage_error("an experiment needs a participant and a task");
  std::vector<PlannedTrial> design;
  for (int participant = 0; participant < request.participants; ++participant) {
    const auto square_of_tasks = static_cast<std::uint64_t>(participant / request.tasks);
    RandomStream order({request.seed, 1, square_of_tasks});
    const Square tasks(request.tasks, order);
    for (int place = 0; place < request.tasks; ++place) {
      const int task = tasks.symbol(participant % request.tasks, place);
      RandomStream random(
          {request.seed, 2, static_cast<std::uint64_t>(task), static_cast<std::uint64_t>(participant / n)});
      const Square square(n, random);
      RandomStream own(
          {request.seed, 3, static_cast<std::uint64_t>(task), static_cast<std::uint64_t>(participant)});
      const std::vector<int> practised = own.order(request.practice), sides = own.order(request.practice);
      for (int trial = 0; trial < request.practice; ++trial) {
        design.push_back({participant, place, task, trial, true, n + practised[as_size(trial)],
                          sides[as_size(trial)] % 2 == 0});
      }
      const int row = participant % n;
      for (int at = 0; at < n; ++at) {
        const bool guided = (square.row(row) - square.column(at) + n) % n < n / 2;
        design.push_back(
            {participant, place, task, request.practice + at, false, square.symbol(row, at), guided});
      }
    }
  }
  return design;
}

DesignBalance balance_of(const std::vector<PlannedTrial>& design) {
  using Key = std::tuple<int, int, int>;
  std::map<Key, int> participant, stimulus, place, stimulus_at, task_at;
  std::map<int, std::pair<int, int>> extent;                  // of stimuli and trials by task
  std::map<std::pair<int, int>, std::vector<bool>> sequence;  // of conditions by task and participant
  int tasks = 0;
  for (const PlannedTrial& t : design) {
    tasks = std::max(tasks, t.task + 1);
    if (t.practice) continue;
    const int sign = t.guided ? 1 : -1;
    sequence[{t.task, t.participant}].push_back(t.guided);
    participant[{t.participant, t.task, 0}] += sign;
    stimulus[{t.task, t.stimulus, 0}] += sign;
    place[{t.task, t.trial, 0}] += sign;
    ++stimulus_at[{t.task, t.trial, t.stimulus}];
    auto& [stimuli, first] = extent.try_emplace(t.task, 0, t.trial).first->second;
    stimuli = std::max(stimuli, t.stimulus + 1);
    first = std::min(first, t.trial);
    if (t.trial == first) ++task_at[{t.place, t.task, 0}];
  }
  const auto largest = [](const std::map<Key, int>& counts) {
    int out = 0;
    for (const auto& [key, count] : counts) out = std::max(out, std::abs(count));
    return out;
  };
  // Combinations that do not occur count as zero.
  const auto spread = [](const std::map<Key, int>& counts, std::size_t possible) {
    int least = counts.size() < possible ? 0 : INT32_MAX, most = 0;
    for (const auto& [key, count] : counts) {
      least = std::min(least, count);
      most = std::max(most, count);
    }
    return counts.empty() ? 0 : most - least;
  };
  std::size_t possible = 0;
  for (const auto& [task, limits] : extent) possible += as_size(limits.first) * as_size(limits.first);
  std::map<int, std::set<std::vector<bool>>> different;
  for (const auto& [who, conditions] : sequence) different[who.first].insert(conditions);
  int sequences = different.empty() ? 0 : INT32_MAX;
  for (const auto& [task, all] : different) sequences = std::min(sequences, static_cast<int>(all.size()));
  return {largest(participant),
          largest(stimulus),
          largest(place),
          spread(stimulus_at, possible),
          spread(task_at, as_size(tasks) * as_size(tasks)),
          sequences};
}

}  // namespace palpate
