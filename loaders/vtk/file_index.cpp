#include "loaders/vtk/file_index.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/json.h"
#include "common/base/text.h"
#include "common/load/find_format.h"
#include "common/load/step_times.h"
#include "loaders/vtk/file_names.h"
#include "loaders/vtk/parallel_index.h"
#include "loaders/vtk/xml_scan.h"

namespace palpate {
namespace {

constexpr int kMaxDepth = 8;
constexpr std::size_t kMaxPieces = 1'000'000;

std::optional<double> number_of(const std::string& text) {
  const std::optional<double> value = number(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

/// Whether the file is there and lists blocks; what is wrong with it shows when it is read.
bool lists_blocks(const std::filesystem::path& file) {
  try {
    return find_format(file) == Format::kVtkMultiBlock;
  } catch (const Error&) {
    return false;
  }
}

/// The blocks of a .vtm or .vthb, also of those inside it.
void add_blocks(const std::filesystem::path& file, int depth, std::vector<FilePiece>& pieces) {
  if (depth > kMaxDepth) throw input_error({file.string(), "", "multi-block files are nested too deeply"});
  const MappedFile mapped(file.string());
  XmlTags tags(mapped.text());
  XmlTag tag;
  std::vector<std::string> groups;  // names of the <Block>s around
  int level = -1;
  bool complete = false;
  while (tags.next(tag)) {
    if (tag.name == "VTKFile" && tag.closes) complete = true;
    if (tag.name == "Block" || tag.name == "Partition") {
      if (tag.opens) level = parsed<int>(tag.at("level")).value_or(-1);
      if (tag.opens && !tag.closes)
        groups.push_back(level < 0 ? tag.at("name") : "level " + std::to_string(level));
      if (tag.closes && !tag.opens && !groups.empty()) groups.pop_back();
      continue;
    }
    if (tag.name != "DataSet" || !tag.opens || tag.at("file").empty()) continue;
    std::string name = tag.at("name");
    if (name.empty() && !groups.empty()) name = groups.back() + (level < 0 ? "" : "/" + tag.at("index"));
    const std::filesystem::path path = file.parent_path() / tag.at("file");
    if (lists_blocks(path)) {
      add_blocks(path, depth + 1, pieces);
    } else {
      pieces.push_back({path, name, level});
    }
    if (pieces.size() > kMaxPieces) throw input_error({file.string(), "", "names too many blocks"});
  }
  if (!complete)
    throw input_error({file.string(), "", "its end is missing (no </VTKFile>)", "", "it may be truncated"});
  if (pieces.empty() && depth == 0)
    throw input_error({file.string(), "", "names no file", "a DataSet with a file"});
}

struct Entry {
  double time = 0.0;
  std::string file;
  std::string name;
  std::string part;  ///< .pvd: what the entry says of its place beside others of that time
};

std::vector<Entry> read_pvd(const std::filesystem::path& file, std::string_view text) {
  std::vector<Entry> entries;
  XmlTags tags(text);
  XmlTag tag;
  bool complete = false;
  while (tags.next(tag)) {
    if (tag.name == "VTKFile" && tag.closes) complete = true;
    if (tag.name != "DataSet" || !tag.opens) continue;
    const std::string& time = tag.at("timestep");
    const bool stated = tag.attributes.contains("timestep");
    const auto value = stated ? number_of(time) : std::optional<double>(0.0);
    if (!value) throw input_error({file.string(), "", "timestep=\"" + time.substr(0, 40) + "\"", "a number"});
    entries.push_back({*value, tag.at("file"), tag.at("name"), tag.at("part") + "/" + tag.at("group")});
    if (entries.size() > kMaxPieces) throw input_error({file.string(), "", "names too many files"});
  }
  if (!complete)
    throw input_error({file.string(), "", "its end is missing (no </VTKFile>)", "", "it may be truncated"});
  return entries;
}

/// {"file-series-version": "1.0", "files": [{"name": "a.vtu", "time": 0.0}, …]}
std::vector<Entry> read_series(const std::filesystem::path& file, std::string_view text) {
  const auto index = parse_json(text);
  std::vector<Entry> entries;
  const bool shaped = index.is_object() && index.contains("files") && index["files"].is_array();
  if (!shaped)
    throw input_error(
        {file.string(), "", "is no file series", "JSON with a list \"files\"", "it may be truncated"});
  for (const auto& entry : index["files"]) {
    const bool right = entry.is_object() && entry.contains("name") && entry["name"].is_string() &&
                       (!entry.contains("time") || entry["time"].is_number());
    if (!right) throw input_error({file.string(), "", "has an entry without a name or with a wrong time"});
    entries.push_back(
        {entry.value("time", static_cast<double>(entries.size())), entry["name"].get<std::string>(), "", ""});
  }
  return entries;
}

/// What an index says of an entry's place beside others of its time.
std::string place_of(const Entry& entry) { return entry.part + "|" + entry.name; }

/// The runs of an index: which entries stand for one part of the data.
class Runs {
 public:
  Runs(const std::vector<Entry>& entries, const std::filesystem::path& folder, const SameGrid& same_grid)
      : folder_(folder), same_grid_(same_grid) {
    std::map<std::string, const Entry*> last;
    std::map<std::pair<std::string, double>, std::vector<const Entry*>> beside;
    for (const Entry& entry : entries) {
      // A run that begins anew may have another name.
      const Entry*& before = last[place_of(entry)];
      if (before != nullptr && entry.time < before->time) join(*before, entry);
      before = &entry;
      std::vector<const Entry*>& others = beside[{place_of(entry), entry.time}];
      if (others.size() >= kMostBeside) continue;
      for (const Entry* other : others) join(*other, entry);
      others.push_back(&entry);
    }
  }

  /// Entries that belong to the same part: their places and the words of their files are alike, or their grids.
  [[nodiscard]] std::string part_of(const Entry& entry) const {
    const std::string base = split_name(entry.file).before;
    const auto other = first_names_.find({place_of(entry), base});
    return place_of(entry) + "|" + (other == first_names_.end() ? base : other->second);
  }

  /// Whether two files of one place and time are one thing twice.
  [[nodiscard]] bool replaces(const Entry& later, const Entry& earlier) {
    return later.time == earlier.time && place_of(later) == place_of(earlier) && alike(earlier, later);
  }

 private:
  static constexpr std::size_t kMostBeside = 8;  ///< more files of one time are blocks

  void join(const Entry& earlier, const Entry& later) {
    const std::string first = split_name(earlier.file).before;
    const std::string second = split_name(later.file).before;
    const std::string place = place_of(later);
    if (first == second || first_names_.count({place, second}) > 0 || !alike(earlier, later)) return;
    const auto known = first_names_.find({place, first});
    first_names_[{place, second}] = known == first_names_.end() ? first : known->second;
  }

  /// The first pair of files decides for all of their names.
  bool alike(const Entry& earlier, const Entry& later) {
    if (earlier.file == later.file) return true;
    const auto [at, fresh] =
        alike_.try_emplace({split_name(earlier.file).before, split_name(later.file).before}, false);
    if (fresh && same_grid_) at->second = same_grid_(folder_ / earlier.file, folder_ / later.file);
    return at->second;
  }

  std::filesystem::path folder_;
  const SameGrid& same_grid_;
  std::map<std::pair<std::string, std::string>, std::string> first_names_;  ///< by place and name of a run
  std::map<std::pair<std::string, std::string>, bool> alike_;
};

/// Whether the index was appended to, rather than being in no order: a part repeats a time, or few entries
/// lie before the one that precedes them.
bool goes_on_after_restart(const std::vector<Entry>& entries, const Runs& runs) {
  std::map<std::string, std::pair<double, std::set<double>>> parts;
  std::size_t falls = 0;
  bool repeats = false;
  for (const Entry& entry : entries) {
    const auto [at, fresh] = parts.try_emplace(runs.part_of(entry), entry.time, std::set<double>());
    auto& [last, times] = at->second;
    if (!fresh && entry.time < last) {
      ++falls;
      repeats = repeats || times.count(entry.time) > 0;
    }
    last = entry.time;
    times.insert(entry.time);
  }
  return falls > 0 && (repeats || 4 * falls <= entries.size());
}

/// Of two files that are one part at one time, leaves the later.
void leave_last_files(std::vector<Entry>& entries, Runs& runs, std::vector<std::string>& notes) {
  constexpr std::size_t kNamed = 3;
  std::map<double, std::vector<std::size_t>> by_time;
  std::set<std::size_t> gone;
  std::string named;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    std::vector<std::size_t>& others = by_time[entries[e].time];
    for (const std::size_t other : others) {
      if (gone.count(other) > 0 || !runs.replaces(entries[e], entries[other])) continue;
      gone.insert(other);
      if (gone.size() > kNamed) continue;
      named += (named.empty() ? "" : ", ") + entries[other].file + " by " + entries[e].file + " at time " +
               short_number(entries[e].time);
    }
    constexpr std::size_t kMostBeside = 8;
    if (others.size() < kMostBeside) others.push_back(e);
  }
  if (gone.empty()) return;
  std::vector<Entry> kept;
  for (std::size_t e = 0; e < entries.size(); ++e) {
    if (gone.count(e) == 0) kept.push_back(std::move(entries[e]));
  }
  entries.swap(kept);
  notes.push_back("the index has one part more than once at a time: " + counted(gone.size(), "file") +
                  " replaced by the later one: " + named + (gone.size() > kNamed ? ", …" : ""));
}

/// Leaves the later run of a restarted one: where a part begins again at an earlier time, what the file had
/// from that time on goes. A file that stands twice at one time counts once.
void leave_later_runs(std::vector<Entry>& entries, const std::filesystem::path& folder,
                      const SameGrid& same_grid, std::vector<std::string>& notes) {
  Runs runs(entries, folder, same_grid);
  const bool restarted = goes_on_after_restart(entries, runs);
  std::map<std::string, double> last;  // time of each part
  std::vector<Entry> kept;
  std::set<double> replaced;
  std::set<std::pair<double, std::string>> seen;
  for (Entry& entry : entries) {
    const std::string part = runs.part_of(entry);
    const auto at = last.find(part);
    const bool again = !seen.emplace(entry.time, entry.file).second;
    if (restarted && at != last.end() && entry.time < at->second) {
      std::erase_if(kept, [&](const Entry& other) {
        if (other.time < entry.time) return false;
        replaced.insert(other.time);
        return true;
      });
      last.clear();
    } else if (again) {
      continue;
    }
    last[part] = entry.time;
    kept.push_back(std::move(entry));
  }
  entries.swap(kept);
  leave_last_files(entries, runs, notes);
  if (replaced.empty()) return;
  notes.push_back("the index goes on after a restart: " + counted(replaced.size(), "time") + " from " +
                  short_number(*replaced.begin()) + " to " + short_number(*replaced.rbegin()) +
                  " of the earlier run replaced by the later one");
}

}  // namespace

std::vector<FileStep> read_index(const std::filesystem::path& file, Format format,
                                 std::vector<std::string>& notes, const SameGrid& same_grid) {
  if (format == Format::kVtkMultiBlock) {
    FileStep step;
    add_blocks(file, 0, step.pieces);
    return {step};
  }
  if (format == Format::kVtkParallel) {
    const ParallelIndex index = read_parallel_index(file.string());
    if (index.structured()) return {{0.0, {{file, ""}}}};
    FileStep step;
    for (const ParallelPiece& piece : index.pieces)
      step.pieces.push_back({piece.file, "piece " + std::to_string(step.pieces.size() + 1)});
    return {step};
  }
  const MappedFile mapped(file.string());
  const bool json = mapped.text().find_first_not_of(" \t\r\n") != std::string_view::npos &&
                    mapped.text()[mapped.text().find_first_not_of(" \t\r\n")] == '{';
  std::vector<Entry> entries = json ? read_series(file, mapped.text()) : read_pvd(file, mapped.text());
  std::vector<double> times;
  for (const Entry& entry : entries) times.push_back(entry.time);
  times = joined_times(std::move(times));
  for (std::size_t e = 0; e < entries.size(); ++e) entries[e].time = times[e];
  leave_later_runs(entries, file.parent_path(), same_grid, notes);
  std::map<double, FileStep> steps;
  for (const Entry& entry : entries) {
    if (entry.file.empty()) throw input_error({file.string(), "", "has an entry without a file"});
    FileStep& step = steps[entry.time];
    step.time = entry.time;
    step.pieces.push_back({file.parent_path() / entry.file, entry.name});
  }
  if (steps.empty()) throw input_error({file.string(), "", "names no file"});
  std::vector<FileStep> list;
  list.reserve(steps.size());
  for (auto& [time, step] : steps) list.push_back(std::move(step));
  return list;
}

void leave_out_missing(std::vector<FileStep>& steps, std::vector<std::string>& notes) {
  std::vector<std::string> missing;
  for (FileStep& step : steps) {
    std::erase_if(step.pieces, [&missing](const FilePiece& piece) {
      std::error_code error;
      if (std::filesystem::exists(piece.file, error)) return false;
      missing.push_back(piece.file.string());
      return true;
    });
  }
  const std::size_t emptied = std::erase_if(steps, [](const FileStep& step) { return step.pieces.empty(); });
  if (!missing.empty()) {
    std::string note = counted(missing.size(), "file") + " missing, left out: ";
    constexpr std::size_t kNamed = 3;
    for (std::size_t i = 0; i < std::min(kNamed, missing.size()); ++i)
      note += (i == 0 ? "" : ", ") + missing[i];
    notes.push_back(note + (missing.size() > kNamed ? ", …" : ""));
  }
  if (steps.empty()) {
    throw input_error({missing.empty() ? notes.back() : missing.front(), "",
                       missing.empty() ? "no file is left" : "is missing, and so is every other file"});
  }
  if (emptied > 0) notes.push_back(counted(emptied, "time step") + " without a file left out");
}

}  // namespace palpate
