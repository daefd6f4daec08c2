#include "library/mpi/round_trace.h"

#include <algorithm>
#include <string>
#include <tuple>
#include <utility>

#include <time.h>

#include "common/base/index.h"

namespace palpate::mpi {
namespace {

double thread_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

RoundTrace::RoundTrace(const VectorField& field, const Blocks& blocks, const TraceOptions& options,
                       Ranks& ranks)
    : field_(field), blocks_(blocks), ranks_(ranks), tracing_(field, options) {
  if (options.forward) ways_.push_back(TraceDirection::kForward);
  if (options.backward) ways_.push_back(TraceDirection::kBackward);
}

LineTracer& RoundTrace::tracer_of(std::uint64_t line) {
  const std::size_t way = line % ways_.size();
  if (!tracers_[way]) tracers_[way].emplace(tracing_.tracer(ways_[way]));
  return *tracers_[way];
}

void RoundTrace::begin(std::span<const Vec3> seeds) {
  const auto rank = as_size(ranks_.rank()), count = as_size(ranks_.count());
  for (std::size_t seed = seeds.size() * rank / count; seed < seeds.size() * (rank + 1) / count; ++seed) {
    const Vec3 x = field_.frame().local_from_data(seeds[seed]);
    for (std::size_t way = 0; way < ways_.size(); ++way) {
      HeldLine held{.line = seed * ways_.size() + way, .part = 0, .block = 0, .state = {}};
      LineTracer& tracer = tracer_of(held.line);
      if (!tracer.start(x)) {
        pack({.line = held.line, .part = 0, .last = true, .outside = true, .end = {}, .points = {}}, parts_);
        continue;
      }
      held.block = blocks_.block_of(tracer.cell());
      StateWriter state;
      tracer.save(state);
      held.state = state.take();
      held_.push_back(std::move(held));
    }
  }
}

void RoundTrace::resume(std::vector<HeldLine> held) {
  held_ = std::move(held);
  for (HeldLine& line : held_) {
    LineTracer& tracer = tracer_of(line.line);
    StateReader reader(line.state);
    tracer.restore(reader);
    line.block = blocks_.block_of(tracer.cell());
  }
}

std::int64_t RoundTrace::deal() {
  std::ranges::sort(held_, {}, [](const HeldLine& held) { return std::pair(held.block, held.line); });
  std::vector<std::int64_t> in_block(as_size(blocks_.count()), 0);
  for (const HeldLine& held : held_) ++in_block[as_size(held.block)];
  std::vector<std::int64_t> place = ranks_.sum_before(in_block);
  ranks_.sum(in_block);
  std::int64_t total = 0;
  for (std::size_t b = 0; b < in_block.size(); ++b) {
    place[b] += total;
    total += in_block[b];
  }
  std::vector<std::vector<std::byte>> to(as_size(ranks_.count()));
  for (HeldLine& held : held_) {
    const std::int64_t at = place[as_size(held.block)]++;
    const auto rank = as_size(at * ranks_.count() / total);
    if (rank != as_size(ranks_.rank())) ++figures_.moved;
    pack(held, to[rank]);
    held = {};  // the memory is needed for the packed ones
  }
  held_ = unpack_held(ranks_.exchange(to));
  return total;
}

void RoundTrace::follow(std::int64_t pieces) {
  const double start = thread_seconds();
  std::vector<bool> mine(as_size(blocks_.count()), false);
  for (const HeldLine& held : held_) mine[as_size(held.block)] = true;
  std::int64_t left = pieces;
  std::vector<HeldLine> kept;
  for (HeldLine& held : held_) {
    if (left <= 0 || goes_on(held, left, mine)) kept.push_back(std::move(held));
  }
  held_ = std::move(kept);
  figures_.pieces += pieces - left;
  figures_.seconds_traced += thread_seconds() - start;
}

/// Follows one line. @return whether it goes on in another round.
bool RoundTrace::goes_on(HeldLine& held, std::int64_t& pieces, const std::vector<bool>& mine) {
  LineTracer& tracer = tracer_of(held.line);
  StateReader reader(held.state);
  tracer.restore(reader);
  for (;;) {
    --pieces;
    if (tracer.advance()) {
      keep_part(held, tracer.line(), true);
      return false;
    }
    if (!tracer.movable()) continue;
    const int block = blocks_.block_of(tracer.cell());
    if (pieces > 0 && mine[as_size(block)]) continue;
    keep_part(held, tracer.line(), false);
    StateWriter state;
    tracer.save(state);
    held.state = state.take();
    held.block = block;
    ++held.part;
    return true;
  }
}

void RoundTrace::keep_part(const HeldLine& held, const Line& line, bool last) {
  LinePart part{
      .line = held.line, .part = held.part, .last = last, .outside = false, .end = line.end, .points = {}};
  // The first point is the last one of what went before; a line that was only begun holds its seed.
  part.points.assign(line.points.begin() + (held.part == 0 ? 0 : 1), line.points.end());
  pack(part, parts_);
}

TraceResult join_parts(std::vector<LinePart> parts, std::size_t seeds, std::span<const TraceDirection> ways) {
  TraceResult result;
  std::ranges::sort(parts, {}, [](const LinePart& part) { return std::pair(part.line, part.part); });
  std::size_t at = 0;
  for (std::uint64_t line = 0; line < seeds * ways.size(); ++line) {
    const auto seed = static_cast<std::uint32_t>(line / ways.size());
    Line whole{.points = {},
               .end = End::kLeftDomain,
               .direction = ways[line % ways.size()],
               .seed = seed,
               .moment = 0.0};
    bool ended = false, outside = false;
    for (std::uint32_t part = 0; !ended; ++part, ++at) {
      if (at == parts.size() || parts[at].line != line || parts[at].part != part)
        throw work_error("part " + std::to_string(part) + " of line " + std::to_string(line) +
                         " is missing: another run has written into the same work folder");
      LinePart& found = parts[at];
      whole.points.insert(whole.points.end(), found.points.begin(), found.points.end());
      found.points = {};
      ended = found.last;
      outside = found.outside;
      whole.end = found.end;
    }
    if (outside) {
      if (line % ways.size() == 0) result.outside_seeds.push_back(seed);
      continue;
    }
    ++result.ends[as_size(whole.end)];
    result.points += whole.points.size();
    result.lines.push_back(std::move(whole));
  }
  return result;
}

}  // namespace palpate::mpi
