#include "loaders/vtk/foam/foam_collated.h"

#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

#include "common/base/error.h"
#include "common/base/text.h"
#include "loaders/vtk/foam/foam_text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kCollated = "decomposedBlockData";

/// The dictionary at the head of a text; empty where there is none.
std::string_view head_of(std::string_view text) {
  FoamTokens tokens(text, {});
  if (tokens.peek() != "FoamFile") return {};
  (void)tokens.next();
  const std::string_view body = tokens.entry();
  return text.substr(0, static_cast<std::size_t>(body.data() + body.size() - text.data()));
}

/// What the head says of a key; empty where it does not.
std::string_view said_in(std::string_view head, std::string_view key) {
  FoamTokens tokens(head, {});
  (void)tokens.next();
  if (tokens.peek() == "{") (void)tokens.next();
  while (!tokens.done() && tokens.peek() != "}") {
    const bool found = tokens.next() == key;
    const std::string_view value = tokens.entry();
    if (found) return trimmed(value);
  }
  return {};
}

/// The header of the parts by what the collated file's own says of them.
std::string head_by(std::string_view outer) {
  const auto either = [&](std::string_view one, std::string_view other) {
    const std::string_view found = said_in(outer, one);
    return std::string(found.empty() ? said_in(outer, other) : found);
  };
  const std::string kind = either("data.class", "data_class"), format = either("data.format", "data_format");
  if (kind.empty()) throw FoamMalformed{"a first block without a header"};
  const std::string arch(said_in(outer, "arch"));
  return "FoamFile\n{\n version 2.0;\n format " + (format.empty() ? "ascii" : format) + ";\n" +
         (arch.empty() ? "" : " arch " + arch + ";\n") + " class " + kind + ";\n object " +
         std::string(said_in(outer, "object")) + ";\n}\n";
}

/// Starts a process that removes `folder` when this one has ended, however it does: helper programs are killed.
/// @returns what it waits for the end of.
int remove_at_end(const std::string& folder) {
  std::array<int, 2> ends{};
  if (::pipe2(ends.data(), O_CLOEXEC) != 0) return -1;
  const pid_t process = ::fork();
  if (process == 0) {
    // Nothing else of this process may stay open there: others wait for that, too.
    ::dup2(ends[0], 0);
    ::close_range(1, ~0U, 0);
    ::setsid();
    char none = 0;
    while (::read(0, &none, 1) < 0 && errno == EINTR) {
    }
    // No program is started from within the sandbox; glibc lets a forked process allocate.
    std::error_code ignored;
    fs::remove_all(folder, ignored);
    ::_exit(0);
  }
  ::close(ends[0]);
  if (process > 0) return ends[1];
  ::close(ends[1]);
  return -1;
}

}  // namespace

std::vector<std::string> part_foam_blocks(std::string_view text) {
  const std::string_view outer = head_of(text);
  std::vector<std::string> out;
  if (outer.empty() || said_in(outer, "class") != kCollated) return out;
  FoamTokens tokens = foam_body(text);
  std::string head;
  while (!tokens.done()) {
    if (tokens.peek().substr(0, 4) == "List") (void)tokens.next();
    const std::size_t count = tokens.count();
    std::string_view block;
    if (count > 0 || tokens.peek() == "(") {
      tokens.expect("(");
      block = tokens.bytes(count, 1);
      tokens.expect(")");
    }
    const std::string_view own = head_of(block);
    if (out.empty()) head = own.empty() ? head_by(outer) : std::string(own) + "\n";
    out.push_back((own.empty() ? head : std::string()) + std::string(block));
  }
  return out;
}

std::pair<int, int> foam_processors_of(std::string_view folder) {
  constexpr std::string_view kName = "processors";
  if (folder.substr(0, kName.size()) != kName) return {0, 0};
  folder.remove_prefix(kName.size());
  const std::size_t range = folder.find('_');
  const auto all = parsed<int>(folder.substr(0, range));
  if (!all || *all <= 0) return {0, 0};
  if (range == std::string_view::npos) return {0, *all};
  const std::string_view part = folder.substr(range + 1);
  const std::size_t dash = part.find('-');
  const auto first = parsed<int>(part.substr(0, dash));
  const auto last = dash == std::string_view::npos ? first : parsed<int>(part.substr(dash + 1));
  if (!first || !last || *first < 0 || *last < *first || *last >= *all) return {0, 0};
  return {*first, *last - *first + 1};
}

FoamCollated::FoamCollated(const std::vector<fs::path>& collated) {
  const fs::path temporary = fs::temp_directory_path();
  std::string name = (temporary / "palpate-foam-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr)
    throw work_error("no folder for temporary files can be made in " + temporary.string());
  home_ = name;
  alive_ = remove_at_end(name);
  for (const fs::path& from : collated) part(from);
}

FoamCollated::~FoamCollated() {
  std::error_code ignored;
  fs::remove_all(home_, ignored);
  if (alive_ >= 0) ::close(alive_);
}

void FoamCollated::part(const fs::path& from) {
  const auto [first, count] = foam_processors_of(from.filename().string());
  std::vector<fs::path> to;
  for (int rank = first; rank < first + count; ++rank) {
    to.push_back(home_ / ("processor" + std::to_string(rank)));
    fs::create_directories(to.back());
  }
  folders_.insert(folders_.end(), to.begin(), to.end());
  std::error_code error;
  for (fs::recursive_directory_iterator it(from, error), end; !error && it != end; it.increment(error)) {
    const fs::path inside = fs::relative(it->path(), from);
    std::string name = inside.filename().string();
    if (it->is_directory()) {
      if (name == "uniform" || name == "lagrangian") {
        it.disable_recursion_pending();
        continue;
      }
      for (const fs::path& folder : to) fs::create_directories(folder / inside);
      continue;
    }
    if (name.find("ProcAddressing") != std::string::npos || !it->is_regular_file()) continue;
    fs::path plain = it->path();
    if (plain.extension() == ".gz") plain.replace_extension();
    const std::string file = it->path().string();
    try {
      const FoamText text(plain);
      bytes_ += text.text().size();
      if (bytes_ > kMostBytes) {
        throw input_error({from.string(), "", "holds more than " + std::to_string(kMostBytes >> 30U) + " GiB",
                           "a collated case that fits into the folder of temporary files",
                           "run reconstructPar"});
      }
      const std::vector<std::string> blocks = part_foam_blocks(text.text());
      if (blocks.empty()) continue;
      if (blocks.size() != to.size()) {
        throw FoamMalformed{"blocks of " + std::to_string(blocks.size()) + " processors where " +
                            std::to_string(to.size()) + " are due"};
      }
      for (std::size_t b = 0; b < blocks.size(); ++b) {
        std::ofstream out(to[b] / inside.parent_path() / plain.filename(), std::ios::binary);
        out << blocks[b];
        if (!out.flush())
          throw work_error("the folder of temporary files " + home_.string() + " cannot be written");
      }
    } catch (const FoamMalformed& problem) {
      throw input_error(
          {file, "", "has " + problem.found, "a collated file of OpenFOAM", "the file may be damaged"});
    }
  }
}

}  // namespace palpate
