#include "library/mpi/options.h"

#include <CLI/CLI.hpp>

#include "common/base/error.h"
#include "common/base/version.h"

namespace palpate::mpi {

ParsedOptions parse_options(int argc, char** argv) {
  ParsedOptions parsed;
  Options& options = parsed.options;
  std::string integrator;
  CLI::App app{"Trace lines on many machines: the same bits for any number of ranks", "palpate-mpi"};
  app.set_version_flag("--version", version_text("palpate-mpi"));
  app.require_subcommand(1);
  app.footer(
      "mpirun -n 8 palpate-mpi trace carotid.vtk --seeds random:1000 --out lines.vtp\n"
      "Ranks see one file system. What ended before its time goes on where the same command is given again.");
  CLI::App& trace = *app.add_subcommand("trace", "trace lines from seeds and write them to a file");
  trace.add_option("FILE", options.files, "data, as flow opens them; NRRD of raw vectors stay on the disk")
      ->required();
  trace.add_option("--solution", options.solution, "PLOT3D solution file");
  trace.add_option("--field", options.field, "vector field; default: the likeliest one");
  trace.add_option("--time", options.time, "time step: first, last or a time");
  trace.add_option("--cell-values", options.cell_values, "recovered or constant")
      ->check(CLI::IsMember({"recovered", "constant"}));
  trace.add_option("--seeds", options.seeds, "where lines start, as for flow trace")->required();
  trace.add_option("--seed", options.seed, "of random numbers");
  trace.add_option("--out", options.out, "line file: .vtp .tck .trk .trx .csv")->required();
  trace.add_option("--direction", options.direction, "forward, backward or both")
      ->check(CLI::IsMember({"forward", "backward", "both"}));
  trace.add_option("--integrator", integrator, "default: exact on tetrahedra, dp54 elsewhere");
  trace.add_option("--tolerance", options.trace.tolerance, "accumulated error per diagonal, relative to it");
  trace.add_option("--step", options.trace.step, "step length, or spacing of points [data units]");
  trace.add_option("--max-length", options.trace.max_length, "[data units]; default: 10 diagonals");
  trace.add_option("--max-time", options.trace.max_time, "[data units]");
  trace.add_option("--max-steps", options.trace.max_steps, "pieces of a line");
  trace.add_option("--blocks", options.blocks,
                   "pieces of the field by which lines are dealt out; default: 4 a rank");
  trace.add_option("--round-pieces", options.pieces, "of lines, that a rank follows in a round at most")
      ->check(CLI::Range(std::int64_t{1}, std::int64_t{1} << 40));
  trace.add_option("--work", options.work, "folder of what is traced so far; default: OUT.work");
  trace.add_option("--keep-every", options.keep_seconds, "seconds between rounds that are kept; 0: each")
      ->check(CLI::NonNegativeNumber);
  trace.add_flag("--force", options.force, "overwrite the output");
  trace.add_flag("--json", options.json, "one JSON object on stdout");
  trace.add_flag("--quiet", options.quiet, "no remarks");
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForVersion&) {
    parsed.text = version_text("palpate-mpi") + "\n";
    return parsed;
  } catch (const CLI::CallForHelp&) {
    parsed.text = (trace.parsed() ? trace : app).help();
    return parsed;
  } catch (const CLI::ParseError& error) {
    throw usage_error(std::string(error.what()) + "; palpate-mpi trace --help lists the options");
  }
  if (!integrator.empty()) options.trace.integrator = integrator_from_name(integrator);
  options.trace.forward = options.direction != "backward";
  options.trace.backward = options.direction != "forward";
  options.trace.threads = 1;
  if (options.blocks < 0) throw usage_error("--blocks must not be negative");
  if (options.work.empty()) options.work = options.out.string() + ".work";
  return parsed;
}

}  // namespace palpate::mpi
