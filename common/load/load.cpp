#include "common/load/load.h"

#include <algorithm>
#include <map>
#include <system_error>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/find_helper.h"
#include "common/base/ledger.h"
#include "common/base/memory.h"
#include "common/load/find_format.h"
#include "common/load/format.h"
#include "common/load/helper/helper_process.h"
#include "common/load/helper/protocol.h"

namespace palpate {
namespace {

/// What a reader may take beyond what the input justifies: its libraries and their working memory. Measured
/// on the Exodus II sample: 330 MB of address space in all.
constexpr std::uint64_t kBaseMemory = std::uint64_t{700} << 20;
/// Address space for each byte of input: compressed single precision grows about tenfold, is held twice
/// (by the reader and in shared memory), and cells take more room in memory than in text.
constexpr std::uint64_t kMemoryFactor = 32;
/// A reader's time: start-up on a loaded machine, and the slowest reading that still makes sense.
constexpr double kBaseSeconds = 8.0;
constexpr double kSecondsPerByte = 1.0 / 2e6;
constexpr double kSecondsToFill = 60.0;  ///< the box of a sparse grid: 20 GB
/// Curved elements: the fewest bytes that one takes in a (compressed) file, and what a sample of it takes.
/// Their reader looks first whether the machine has the memory.
constexpr double kBytesPerElement = 200.0;
constexpr double kMemoryPerSample = 600.0;
constexpr double kSecondsPerSample = 1e-5;
constexpr int kRefineOfReader = 4;  ///< where none is asked for

std::uint64_t size_of(const std::filesystem::path& path) {
  std::error_code error;
  if (std::filesystem::is_regular_file(path, error)) {
    const auto size = std::filesystem::file_size(path, error);
    return error ? 0 : size;
  }
  return 0;
}

/// Bytes of a file, or of what lies beside an index file: an index is small and says nothing of what it
/// leads to.
std::uint64_t input_bytes(const LoadRequest& request, const FormatRow& row) {
  std::uint64_t bytes = request.solution ? size_of(*request.solution) : 0;
  for (const auto& file : request.files) bytes += size_of(file);
  std::filesystem::path folder = request.files.front();
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error)) {
    if (!row.beside) return bytes;
    folder = folder.has_parent_path() ? folder.parent_path() : ".";
  }
  constexpr int kMaxEntries = 100'000;
  int entries = 0;
  for (auto it = std::filesystem::recursive_directory_iterator(
           folder, std::filesystem::directory_options::skip_permission_denied, error);
       !error && it != std::filesystem::recursive_directory_iterator() && entries < kMaxEntries;
       it.increment(error), ++entries) {
    if (it.depth() > 4) it.disable_recursion_pending();
    const bool own = it->path().filename().string().find(".palpate.") != std::string::npos;
    if (!own) bytes += size_of(it->path());  // what is kept for the next opening is no input
  }
  return bytes;
}

/// Places at which the curved elements of so many bytes may be sampled.
double samples_of(std::uint64_t bytes, int refine) {
  const double side = 1.0 + (refine > 0 ? refine : kRefineOfReader);
  return static_cast<double>(bytes) / kBytesPerElement * side * side * side;
}

LoadLimits resolve(LoadLimits limits, std::uint64_t bytes, const FormatRow& row, int refine) {
  const double samples = row.curved ? samples_of(bytes, refine) : 0.0;
  if (limits.memory_bytes == 0) {
    const std::uint64_t most = usable_memory();
    // A sparse grid takes as much as its box, whatever its file does; its reader looks first.
    const double wanted = row.sparse ? static_cast<double>(most)
                                     : static_cast<double>(kBaseMemory) +
                                           static_cast<double>(kMemoryFactor) * static_cast<double>(bytes) +
                                           kMemoryPerSample * samples;
    limits.memory_bytes =
        wanted < static_cast<double>(most) ? static_cast<std::uint64_t>(wanted) : std::max(kBaseMemory, most);
  }
  if (limits.seconds <= 0.0) {
    limits.seconds =
        kBaseSeconds + kSecondsPerByte * static_cast<double>(bytes) + kSecondsPerSample * samples;
    if (row.sparse) limits.seconds += kSecondsToFill;
  }
  return limits;
}

Error error_of(const HelperFailure& failure, const std::string& file, std::string_view helper) {
  const std::string reader = "the reader " + std::string(helper);
  switch (failure.kind) {
    case HelperFailure::Kind::kTimeOut:
      return input_error(
          {file, "", reader + " " + failure.what, "", "the file may be damaged, or the machine is too busy"});
    case HelperFailure::Kind::kMalformed:
      return input_error({file, "", reader + " gave an answer that makes no sense: " + failure.what, "",
                          "the file may be damaged"});
    case HelperFailure::Kind::kEnded:
      break;
  }
  return input_error({file, "", reader + " " + failure.what, "", "the file may be damaged"});
}

constexpr const char* kLedgerHelper = "helper ";

/// Arrays, and the time that all took together with the mesh, by their shares of the bytes.
void enter_arrays(const std::vector<DataSet>& blocks, double seconds) {
  std::map<std::string, std::uint64_t> bytes;
  std::uint64_t all = 0;
  for (const DataSet& block : blocks) {
    for (const DataArray& array : block.arrays) {
      bytes[array.name] += array.stored_bytes();
      all += array.stored_bytes();
    }
  }
  if (all == 0) Ledger::enter("mesh without arrays", "read", 1e3 * seconds);
  for (const auto& [name, size] : bytes) {
    const double part = static_cast<double>(size) / static_cast<double>(std::max<std::uint64_t>(all, 1));
    Ledger::enter("array " + name, "read", 1e3 * seconds * part, size);
  }
}

}  // namespace

struct Source::State {
  std::string file;  ///< the first file, for messages
  std::string helper;
  LoadLimits limits;
  std::unique_ptr<HelperProcess> process;
  FileInfo info;

  /// Asks the helper and hands its answer to `decode`.
  template <typename Decode>
  auto ask(const RequestMessage& message, Progress* progress, const Decode& decode) {
    const auto reply = process->ask(encode(message), progress);
    if (!reply) throw error_of(process->failure(), file, helper);
    try {
      return decode(*reply);
    } catch (const ProtocolError& error) {
      throw error_of({HelperFailure::Kind::kMalformed, error.what()}, file, helper);
    }
  }
};

Source::Source(std::unique_ptr<State> state) : state_(std::move(state)) {}
Source::Source(Source&&) noexcept = default;
Source& Source::operator=(Source&&) noexcept = default;
Source::~Source() = default;

Source Source::open(const LoadRequest& request, const LoadLimits& limits, Progress* progress) {
  if (request.files.empty()) throw usage_error("no file to open");
  if (progress != nullptr) progress->check();
  auto state = std::make_unique<State>();
  state->file = request.files.front().string();

  const auto format_of = [&request](const std::filesystem::path& file) {
    if (!request.raw) return find_format(file);
    (void)read_head(file, 0);  // a regular file, at least
    return Format::kRaw;
  };
  const Format format = format_of(request.files.front());
  for (const auto& file : request.files) {
    const Format other = format_of(file);
    if (other != format) {
      throw input_error({file.string(), "", "is " + std::string(row_of(other).name),
                         std::string(row_of(format).name) + " like " + state->file,
                         "open files of one format together"});
    }
  }
  if (request.solution) {
    if (format != Format::kPlot3d) {
      throw usage_error("--solution goes with a PLOT3D grid; " + state->file + " is " +
                        std::string(row_of(format).name));
    }
    (void)read_head(*request.solution, 1);
  }

  state->helper = row_of(format).helper;
  const std::filesystem::path program = find_helper(state->helper);
  if (program.empty()) {
    throw usage_error(state->file + ": its reader " + state->helper +
                      " is not installed; build that target or install palpate again");
  }
  state->limits = resolve(limits, input_bytes(request, row_of(format)), row_of(format), request.refine);
  for (const FormatRow& row : format_rows())
    Ledger::offer(kLedgerHelper + std::string(row.helper), "not for this format");
  const Work work(kLedgerHelper + state->helper, "reads " + std::string(row_of(format).name));
  state->process = std::make_unique<HelperProcess>(program, state->limits);
  state->info = state->ask(OpenMessage{format, request}, progress,
                           [](const HelperProcess::Reply& reply) { return decode_info(reply.json); });
  std::vector<std::filesystem::path> named = request.files;
  if (request.solution) named.push_back(*request.solution);
  for (const std::filesystem::path& file : named) {
    std::error_code unknown;
    const std::uintmax_t size = std::filesystem::file_size(file, unknown);  // none of a folder
    Ledger::enter("file " + file.string(), "read by " + state->helper, 0.0, unknown ? 0 : size);
  }
  if (request.diffusion && request.diffusion->names_gradients() && !state->info.diffusion.gradients) {
    throw usage_error("--bval, --bvec: " + state->file + " (" + std::string(row_of(format).name) +
                      ") holds no diffusion-weighted volumes to which they could belong");
  }
  return Source(std::move(state));
}

const FileInfo& Source::info() const noexcept { return state_->info; }

std::vector<ArrayInfo> Source::arrays() const {
  std::vector<ArrayInfo> all;
  for (const BlockInfo& block : state_->info.blocks) {
    for (const ArrayInfo& array : block.arrays) {
      const bool known = std::any_of(all.begin(), all.end(), [&](const ArrayInfo& other) {
        return other.name == array.name && other.association == array.association;
      });
      if (!known) all.push_back(array);
    }
  }
  return all;
}

std::vector<DataSet> Source::read(const std::vector<std::string>& array_names, std::size_t time_step,
                                  Progress* progress) {
  const std::size_t steps = std::max<std::size_t>(1, state_->info.times.size());
  if (time_step >= steps) {
    throw usage_error(state_->file + ": has " + std::to_string(steps) + " time steps, not " +
                      std::to_string(time_step + 1));
  }
  const Stopwatch watch;
  auto blocks =
      state_->ask(ReadMessage{array_names, time_step}, progress, [](const HelperProcess::Reply& reply) {
        return decode_blocks(reply.json, reply.memory->bytes(), reply.memory);
      });
  // A reader that finds an array damaged or missing at this time step may leave it out without a word.
  for (const ArrayInfo& array : arrays()) {
    if (std::find(array_names.begin(), array_names.end(), array.name) == array_names.end()) continue;
    const bool there = std::any_of(blocks.begin(), blocks.end(), [&array](const DataSet& block) {
      return block.find(array.name, array.association) != nullptr;
    });
    if (!there) {
      const std::string step = state_->info.times.empty() ? "" : "time step " + std::to_string(time_step + 1);
      throw input_error({state_->file, step, "array '" + array.name + "' is missing or damaged", "",
                         "leave it out or repair the file"});
    }
  }
  enter_arrays(blocks, watch.seconds());
  return blocks;
}

}  // namespace palpate
