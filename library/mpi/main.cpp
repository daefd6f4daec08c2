/// palpate-mpi: flow's trace on many machines.
#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <new>
#include <numeric>

#include <signal.h>
#include <sys/resource.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/base/version.h"
#include "common/load/write/write_lines.h"
#include "common/scene/input.h"
#include "common/scene/seeds.h"
#include "common/scene/sha256.h"
#include "common/scene/time_steps.h"
#include "library/mpi/mapped_vectors.h"
#include "library/mpi/options.h"
#include "library/mpi/round_trace.h"
#include "library/mpi/work_folder.h"

namespace palpate::mpi {
namespace {

/// What a rank says whose run is ended from outside, as by mpirun where another rank is lost.
std::array<char, 512> last_words{};

void say_last_words(int signal) {
  const ssize_t ignored = ::write(STDERR_FILENO, last_words.data(), std::strlen(last_words.data()));
  static_cast<void>(ignored);
  _exit(128 + signal);
}

void prepare_last_words(const std::filesystem::path& work, std::int64_t round) {
  std::snprintf(last_words.data(), last_words.size(),
                "palpate-mpi: ended from outside, as where a rank is lost; %s: give the same command again\n",
                round == 0 ? "no round was kept yet"
                           : (std::to_string(round) + " rounds are kept in " + work.string()).c_str());
}

void say(const Options& options, const Ranks& ranks, const std::string& line) {
  if (ranks.rank() == 0 && !options.quiet) std::fprintf(stderr, "palpate-mpi: %s\n", line.c_str());
}

std::shared_ptr<const VectorField> open_field(const Options& options, const Ranks& ranks) {
  InputOptions spec;
  spec.files = options.files;
  if (!options.solution.empty()) spec.solution = options.solution;
  spec.field = options.field;
  spec.cell_values = options.cell_values;
  Input input = Input::open(spec);
  if (!input.times().empty()) input.set_time_step(choose_time(input.times(), options.time).step);
  MappedField mapped = map_vectors(input);
  if (mapped.field) return mapped.field;
  std::shared_ptr<const VectorField> field = input.load_field(1);
  const std::uint64_t bytes =
      std::visit([](const auto& values) { return values.size_bytes(); }, field->values().values);
  say(options, ranks,
      input.title() + ": each rank holds the whole field" +
          (mapped.why.empty() ? "" : " since " + mapped.why) + ", " + bytes_text(bytes) +
          " of values besides the grid; NRRD of raw vectors on a uniform grid stay on the disk");
  for (const std::string& note : field->notes().lines) say(options, ranks, input.title() + ": " + note);
  return field;
}

/// What a run that goes on must have been told, a line each.
std::string job_text(const Options& options, std::span<const Vec3> seeds) {
  const auto word = [](const std::string& text) { return text.empty() ? std::string("default") : text; };
  // The state of a line is that of one build.
  std::string job = "version " + version() + " " + sha256_of_file("/proc/self/exe") + "\n";
  for (const std::filesystem::path& file : options.files) {
    job += "file " + std::filesystem::absolute(file).string() + " of " +
           std::to_string(std::filesystem::is_directory(file) ? 0 : std::filesystem::file_size(file)) +
           " bytes\n";
  }
  const TraceOptions& trace = options.trace;
  const std::string_view bytes(reinterpret_cast<const char*>(seeds.data()), seeds.size_bytes());
  job += "solution " + word(options.solution) + "\nfield " + word(options.field) + "\ntime " +
         word(options.time) + "\ncell values " + options.cell_values + "\n" + counted(seeds.size(), "seed") +
         " " + sha256_of(bytes) + "\ndirection " + options.direction + "\nintegrator " +
         (trace.integrator ? std::string(name_of(*trace.integrator)) : "default") + "\ntolerance " +
         exact_number(trace.tolerance) + "\nstep " + exact_number(trace.step) + "\nlength " +
         exact_number(trace.max_length) + "\ntime limit " + exact_number(trace.max_time) + "\nsteps " +
         std::to_string(trace.max_steps) + "\n";
  return job;
}

double process_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Run {
  std::int64_t rounds = 0, resumed_from = 0;
  Stopwatch watch;
};

/// Rounds until no line is left.
void trace_rounds(const Options& options, RoundTrace& trace, WorkFolder& work, Ranks& ranks, Run& run) {
  constexpr std::size_t kMostPartBytes = std::size_t{256} << 20;  // of a rank, between rounds that are kept
  Stopwatch since_kept;
  for (std::int64_t round = work.last_round();;) {
    const std::int64_t left = trace.deal();
    if (left == 0 && round == 0) round = 1;  // all seeds lie outside
    std::array<std::int64_t, 1> due{(ranks.rank() == 0 && since_kept.seconds() >= options.keep_seconds) ||
                                    trace.part_bytes() > kMostPartBytes};
    ranks.sum(due);
    // The lines of a round that is kept are those dealt out for the next.
    if (round > work.last_round() && (left == 0 || due[0] > 0)) {
      const std::vector<std::byte> parts = trace.take_parts();
      work.keep(round, trace.held(), parts);
      prepare_last_words(options.work, round);
      since_kept.restart();
    }
    if (left == 0) return;
    ranks.together([&] { trace.follow(options.pieces); });
    ++round;
    ++run.rounds;
  }
}

Json figures_json(const Options& options, const Blocks& blocks, const RoundTrace& trace, Ranks& ranks,
                  const Run& run) {
  const RoundFigures& of_rank = trace.figures();
  const std::vector<double> traced = ranks.gather(of_rank.seconds_traced),
                            all = ranks.gather(process_seconds()),
                            pieces = ranks.gather(static_cast<double>(of_rank.pieces)),
                            moved = ranks.gather(static_cast<double>(of_rank.moved)),
                            bytes = ranks.gather(static_cast<double>(ranks.bytes_sent())),
                            waited = ranks.gather(ranks.seconds_waited());
  const auto total = [](const std::vector<double>& numbers) {
    return std::accumulate(numbers.begin(), numbers.end(), 0.0);
  };
  Json json;
  json["output"] = options.out.string();
  json["ranks"] = ranks.count();
  json["blocks"] = blocks.count();
  json["rounds"] = run.rounds;
  json["resumed_from"] = run.resumed_from;
  json["pieces"] = static_cast<std::int64_t>(total(pieces));
  json["lines_moved"] = static_cast<std::int64_t>(total(moved));
  json["bytes_sent"] = static_cast<std::int64_t>(total(bytes));
  json["cpu_seconds_tracing"] = traced;
  json["cpu_seconds"] = all;
  json["seconds_waited"] = waited;
  json["seconds"] = run.watch.seconds();
  return json;
}

void finish(const Options& options, const VectorField& field, std::size_t seeds, const RoundTrace& trace,
            const WorkFolder& work, Json json, const Blocks& blocks) {
  TraceResult result = join_parts(work.parts(), seeds, trace.ways());
  result.errors = line_errors(result.lines, field.diagonal(), options.trace.tolerance);
  if (result.lines.empty())
    throw work_error("no line: all " + counted(seeds, "seed") + " lie outside the data");
  write_lines(options.out, result.lines, options.force);
  work.remove();
  json["lines"] = result.lines.size();
  json["points"] = result.points;
  json["outside_seeds"] = result.outside_seeds.size();
  Json& ends = json["ends"] = Json::object();
  std::string why;
  for (std::size_t e = 0; e < result.ends.size(); ++e) {
    if (result.ends[e] == 0) continue;
    const std::string name(name_of(static_cast<End>(e)));
    ends[name] = result.ends[e];
    why += (why.empty() ? "" : ", ") + name + " " + std::to_string(result.ends[e]);
  }
  if (options.json) {
    std::printf("%s\n", json_text(json).c_str());
    return;
  }
  std::printf(
      "%s: %s from %s, %zu points; %zu seeds outside\n  ends       %s\n  %s\n  method     %s, tolerance %s\n"
      "  ranks      %d, %s, %lld rounds, %lld lines moved in %s\n",
      options.out.c_str(), counted(result.lines.size(), "line").c_str(), counted(seeds, "seed").c_str(),
      result.points, result.outside_seeds.size(), why.c_str(), errors_text(result.errors).c_str(),
      std::string(name_of(trace.integrator())).c_str(), short_number(options.trace.tolerance).c_str(),
      json["ranks"].get<int>(), blocks.text().c_str(), json["rounds"].get<long long>(),
      json["lines_moved"].get<long long>(), bytes_text(json["bytes_sent"].get<std::uint64_t>()).c_str());
}

void trace(const Options& options, Ranks& ranks) {
  Run run;
  std::shared_ptr<const VectorField> field;
  std::vector<Vec3> seeds;
  std::optional<Blocks> blocks;
  std::optional<RoundTrace> lines;
  ranks.together([&] {
    check_line_output(options.out, options.force);
    const SeedSpec spec = parse_seeds(options.seeds);
    field = open_field(options, ranks);
    seeds = make_seeds(spec, *field, options.seed);
    blocks.emplace(*field, options.blocks > 0 ? options.blocks : 4 * ranks.count());
    lines.emplace(*field, *blocks, options.trace, ranks);
  });
  WorkFolder work(options.work, job_text(options, seeds), ranks);
  run.resumed_from = work.last_round();
  prepare_last_words(options.work, work.last_round());
  struct sigaction action {};
  action.sa_handler = say_last_words;
  sigaction(SIGTERM, &action, nullptr);
  ranks.together([&] {
    if (work.last_round() == 0) {
      lines->begin(seeds);
    } else {
      lines->resume(work.held());
    }
  });
  if (run.resumed_from > 0)
    say(options, ranks,
        "goes on from round " + std::to_string(run.resumed_from) + ", kept in " + options.work.string());
  trace_rounds(options, *lines, work, ranks, run);
  const Json json = figures_json(options, *blocks, *lines, ranks, run);
  ranks.together([&] {
    if (ranks.rank() == 0) finish(options, *field, seeds.size(), *lines, work, json, *blocks);
  });
}

int run(int argc, char** argv) {
  Ranks ranks(argc, argv);
  try {
    ParsedOptions parsed;
    ranks.together([&] { parsed = parse_options(argc, argv); });
    if (!parsed.text.empty()) {
      if (ranks.rank() == 0) std::fputs(parsed.text.c_str(), stdout);
      return 0;
    }
    trace(parsed.options, ranks);
    return 0;
  } catch (const Agreed& error) {
    if (ranks.rank() == 0) std::fprintf(stderr, "palpate-mpi: %s\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "palpate-mpi: rank %d: %s\n", ranks.rank(), error.what());
    ranks.abort(ExitCode::kWorkFailed);
  }
}

}  // namespace
}  // namespace palpate::mpi

int main(int argc, char** argv) { return palpate::mpi::run(argc, argv); }
