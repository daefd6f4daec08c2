#include "loaders/dicom/dicom_loader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <numeric>
#include <utility>
#include <variant>
#include <vector>

#include <gdcmTrace.h>

#include "common/base/error.h"
#include "common/base/files/mapped_file.h"
#include "common/base/index.h"
#include "common/base/parallel.h"
#include "common/base/text.h"
#include "common/load/dicom_mark.h"
#include "common/load/series_list.h"
#include "common/load/volume_block.h"
#include "common/math/lattice.h"
#include "loaders/dicom/dicom_pixels.h"
#include "loaders/dicom/dicom_series.h"

namespace palpate {
namespace {

constexpr std::size_t kMostFiles = 200'000;

struct Found {
  std::vector<std::string> files;
  std::size_t others = 0;  ///< that are no DICOM
};

bool is_dicom(const std::filesystem::path& path) {
  std::string head(kDicomHeadBytes, '\0');
  std::ifstream file(path, std::ios::binary);
  file.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(as_size(file.gcount()));
  return is_dicom_start(head);
}

/// DICOM files of a folder by name, those of folders in it too where `deep`.
Found files_in(const std::filesystem::path& folder, bool deep) {
  constexpr int kDeepest = 12;
  Found found;
  std::error_code error;
  std::filesystem::recursive_directory_iterator it(
      folder, std::filesystem::directory_options::skip_permission_denied, error);
  for (; !error && it != std::filesystem::recursive_directory_iterator() && found.files.size() < kMostFiles;
       it.increment(error)) {
    if (!deep || it.depth() >= kDeepest) it.disable_recursion_pending();
    std::error_code ignored;
    if (!it->is_regular_file(ignored)) continue;
    if (is_dicom(it->path())) {
      found.files.push_back(it->path().string());
    } else {
      ++found.others;
    }
  }
  std::sort(found.files.begin(), found.files.end());
  return found;
}

struct Listed {
  std::string series, title;
  std::vector<std::string> files;
};

std::vector<ListedSeries> listed(const std::vector<Listed>& all) {
  std::vector<ListedSeries> series;
  for (const Listed& one : all) series.push_back({one.title, one.files.size()});
  return series;
}

/// What `read` makes of each file, or why it makes nothing: on all threads, since each file is waited for.
template <typename T, typename Read>
std::vector<std::variant<T, Error>> read_each(const std::vector<std::string>& files, const Read& read) {
  std::vector<std::variant<T, Error>> made(files.size());
  parallel_for(files.size(), 0, [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      try {
        made[i] = read(files[i]);
      } catch (const Error& error) {
        made[i] = error;
      }
    }
  });
  return made;
}

/// Series with images, in the order of their first files. A file that is damaged costs that file and a word in `lost`.
std::vector<Listed> list_series(const Found& found, std::vector<std::string>& notes, std::string& lost) {
  std::vector<Listed> all;
  std::string damaged;
  std::size_t damaged_count = 0, without_image = 0;
  auto labels = read_each<DicomLabel>(found.files, read_dicom_label);
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const std::string& file = found.files[i];
    if (const Error* const error = std::get_if<Error>(&labels[i])) {
      if (damaged_count++ == 0) damaged = error->what();
      continue;
    }
    auto& label = std::get<DicomLabel>(labels[i]);
    if (label.series.empty() && label.title.empty()) {
      if (label.listed.empty()) ++without_image;
      continue;
    }
    const auto known =
        std::find_if(all.begin(), all.end(), [&](const Listed& one) { return one.series == label.series; });
    if (known == all.end()) {
      all.push_back({std::move(label.series), std::move(label.title), {file}});
    } else {
      known->files.push_back(file);
    }
  }
  if (all.empty() && damaged_count > 0) throw Error(ExitCode::kBadInput, damaged);
  if (damaged_count > 0) {
    lost =
        counted(damaged_count, "damaged file") + " left out: " + damaged + (damaged_count > 1 ? ", …" : "");
    notes.push_back(lost);
  }
  if (without_image > 0) notes.push_back(counted(without_image, "DICOM file") + " without an image left out");
  if (found.others > 0) notes.push_back(counted(found.others, "file") + " of other kinds left out");
  return all;
}

const Listed& chosen(const std::vector<Listed>& all, const std::string& asked, const std::string& place) {
  const auto number = parsed<std::size_t>(asked);
  if (number && *number >= 1 && *number <= all.size()) return all[*number - 1];
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Listed& one) { return one.series == asked; });
  if (found == all.end())
    throw usage_error("--series " + asked + ": " + place + " has " + series_list(listed(all)));
  return *found;
}

/// The numbers of all frames as they stand in the file; packed ones are the rest of it.
std::string_view pixels_of(const MappedFile& file, const DicomFrame& frame) {
  return file.text().substr(std::min<std::size_t>(frame.pixels_at.value_or(0), file.text().size()));
}

/// Whether one is a copy of the other: of the same name, place and time, and with the same pixels. Programs that
/// take names of patients off give all images one name.
bool is_copy(const DicomFrame& a, const DicomFrame& b) {
  const bool alike = a.image == b.image && a.position == b.position && a.along_row == b.along_row &&
                     a.along_column == b.along_column && a.temporal == b.temporal &&
                     a.acquisition == b.acquisition && a.instance == b.instance;
  if (!alike || a.pixels_at.has_value() != b.pixels_at.has_value()) return false;
  const MappedFile first(a.file), second(b.file);
  return pixels_of(first, a) == pixels_of(second, b);
}

/// Adds a sentence of what is not there.
void add_lost(const std::string& sentence, std::vector<std::string>& notes, std::string& lost) {
  notes.push_back(sentence);
  lost += (lost.empty() ? "" : "; ") + sentence;
}

/// Of all files, those left out that are copies of others, or cannot be read: these cost themselves and a word in
/// `lost`, but for the one that is `named`, and where most are of that kind.
std::vector<DicomFrame> frames_of(const std::vector<std::string>& files, const std::string& named,
                                  std::vector<std::string>& notes, std::string& lost) {
  std::vector<DicomFrame> frames;
  std::string refused;
  std::size_t refused_count = 0;
  std::multimap<std::string, std::size_t> known;  // the first frame of each file by its name
  std::size_t copies = 0;
  std::string copy;
  const auto all = read_each<std::vector<DicomFrame>>(files, read_dicom_frames);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::string& file = files[i];
    if (const Error* const error = std::get_if<Error>(&all[i])) {
      if (file == named) throw *error;
      if (refused_count++ == 0) refused = error->what();
      continue;
    }
    const auto& of_file = std::get<std::vector<DicomFrame>>(all[i]);
    const DicomFrame& first = of_file.front();
    const auto [from, to] = known.equal_range(first.image);
    const auto original = first.image.empty() ? to : std::find_if(from, to, [&](const auto& one) {
      return is_copy(frames[one.second], first);
    });
    if (original != to) {
      if (copies++ == 0) copy = file + ", a copy of " + frames[original->second].file;
      continue;
    }
    known.emplace(first.image, frames.size());
    frames.insert(frames.end(), of_file.begin(), of_file.end());
  }
  if (refused_count > 0 && refused_count >= known.size()) throw Error(ExitCode::kBadInput, refused);
  if (refused_count > 0)
    add_lost(counted(refused_count, "file") + " of the series left out: " + refused +
                 (refused_count > 1 ? ", …" : ""),
             notes, lost);
  if (copies > 0)
    notes.push_back(counted(copies, "file") + " of images that are there twice left out: " + copy +
                    (copies > 1 ? ", …" : ""));
  return frames;
}

/// The volume of all frames. Where images of one frame and files of several make none together, that of the kind
/// with the most frames, or of the one that is `named`.
DicomSeries sort_frames(std::vector<DicomFrame> frames, const std::string& named, bool allow_gaps,
                        std::vector<std::string>& notes, std::string& lost) {
  std::map<std::string, std::vector<DicomFrame>> kinds;  // by the file of several frames, "" for all others
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool several = frames[i].number > 0 || (i + 1 < frames.size() && frames[i + 1].number > 0 &&
                                                  frames[i + 1].file == frames[i].file);
    kinds[several ? frames[i].file : std::string()].push_back(frames[i]);
  }
  std::string problem;
  try {
    return sort_dicom_series(std::move(frames), allow_gaps);
  } catch (const Error& error) {
    if (kinds.size() < 2) throw;
    problem = error.what();
  }
  auto kept = std::max_element(kinds.begin(), kinds.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
  if (!named.empty()) kept = kinds.contains(named) ? kinds.find(named) : kinds.find("");
  if (kept == kinds.end()) throw Error(ExitCode::kBadInput, problem);
  std::string names;
  std::size_t left_out = 0;
  for (const auto& [file, of_file] : kinds) {
    if (file == kept->first) continue;
    left_out += file.empty() ? of_file.size() : 1;
    names += (names.empty() ? "" : ", ") + (file.empty() ? of_file.front().file : file);
  }
  DicomSeries series = sort_dicom_series(kept->second, allow_gaps);
  add_lost(counted(left_out, "file") + " that " + (left_out == 1 ? "makes" : "make") +
               " no volume with the others left out (" + names + "): " + problem,
           notes, lost);
  return series;
}

class DicomLoader : public Loader {
 public:
  FileInfo open(const LoadRequest& request, Format) override {
    gdcm::Trace::WarningOff();
    gdcm::Trace::ErrorOff();
    if (request.diffusion && request.diffusion->names_gradients()) {
      // Converters turn rows around and sort slices: the axes of their tables are not those of the images.
      throw usage_error(
          "--bval, --bvec: " + request.files.front().string() +
          " is DICOM, whose gradients are taken from its images; convert it to NIfTI to fit it to a "
          "table of the axes of that");
    }
    FileInfo info;
    std::string title, lost;
    const std::vector<std::string> files = choose_files(request, title, info.notes, lost);
    std::error_code ignored;
    const bool one =
        request.files.size() == 1 && !std::filesystem::is_directory(request.files.front(), ignored);
    const std::string named = one ? request.files.front().string() : std::string();
    try {
      series_ =
          sort_frames(frames_of(files, named, info.notes, lost), named, request.allow_gaps, info.notes, lost);
    } catch (const Error& error) {
      // What is missing may be what is damaged.
      if (lost.empty()) throw;
      throw Error(error.code(), std::string(error.what()) + "; " + lost);
    }

    info.anatomical = true;
    info.units = "coordinates in mm";
    info.notes.insert(info.notes.begin(),
                      "series " + title + ", " + counted(files.size(), "file") + "; LPS turned into RAS+");
    info.notes.insert(info.notes.end(), series_.notes.begin(), series_.notes.end());
    const Index3& n = series_.topology.points;
    const auto points = count_of(n);
    array_ = {"scalars", Association::kPoint, dicom_components(series_), dicom_value_type(series_), points};
    if (array_.components > 1) array_.name = kColorArray;
    const DicomFrame& middle = series_.frames[as_size(n.z) / 2];
    if (!middle.units.empty()) info.units += ", values in " + middle.units;
    info.window = middle.window;
    volumes_ = {0};
    if (request.diffusion) {
      describe_diffusion(info);
    } else {
      info.times = series_.times;
      if (!series_.times_are.empty()) info.notes.push_back(series_.times_are);
    }
    info.blocks.push_back(describe_image(series_.topology, array_));
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    return read_image(series_.topology, array_.name, names, [&] {
      return read_dicom_values(series_, array_.type, signals_ ? volumes_ : std::vector<std::size_t>{step},
                               on_progress, room);
    });
  }

 private:
  /// The files of the series that is meant: all of a folder's one, that of a file, or those that are named.
  static std::vector<std::string> choose_files(const LoadRequest& request, std::string& title,
                                               std::vector<std::string>& notes, std::string& lost) {
    const std::filesystem::path& first = request.files.front();
    std::error_code ignored;
    const bool folder = std::filesystem::is_directory(first, ignored);
    const std::string place = first.string();
    Found found;
    bool several = folder;
    if (request.files.size() > 1) {
      for (const auto& file : request.files) {
        if (std::filesystem::is_directory(file, ignored))
          throw input_error({file.string(), "", "is a folder among files", "one folder, or files", ""});
        found.files.push_back(file.string());
      }
      several = true;
    } else if (folder) {
      found = files_in(first, true);
    } else {
      const DicomLabel label = read_dicom_label(place);  // refuses a damaged file that is named
      several = !label.listed.empty();
      found = several ? listed_files(label, place, notes)
                      : files_in(first.has_parent_path() ? first.parent_path() : ".", false);
      if (!several) found.others = 0;  // nobody asked for them
    }
    const std::vector<Listed> all = list_series(found, notes, lost);
    if (all.empty()) throw input_error({place, "", "holds no image", "DICOM images", ""});
    const Listed* series = nullptr;
    if (!request.series.empty()) {
      series = &chosen(all, request.series, place);
    } else if (several) {
      if (all.size() > 1) {
        throw usage_error(series_question(place, listed(all)));
      }
      series = &all.front();
    } else {
      const std::string uid = read_dicom_label(place).series;
      for (const Listed& one : all) {
        if (one.series == uid) series = &one;
      }
      if (series == nullptr) throw input_error({place, "", "holds no image", "a DICOM image", ""});
    }
    title = series->title;
    return series->files;
  }

  static Found listed_files(const DicomLabel& label, const std::string& file,
                            std::vector<std::string>& notes) {
    Found found;
    std::size_t missing = 0;
    for (const std::string& name : label.listed) {
      std::error_code ignored;
      if (std::filesystem::is_regular_file(name, ignored)) {
        found.files.push_back(name);
      } else {
        ++missing;
      }
    }
    if (found.files.empty())
      throw input_error(
          {file, "", "lists " + counted(missing, "file") + ", of which none is there", "them beside it"});
    if (missing > 0) notes.push_back(counted(missing, "file") + " that DICOMDIR lists not there");
    return found;
  }

  void describe_diffusion(FileInfo& info) {
    if (array_.components > 1) return;  // colours
    if (series_.volumes > kMostGradients) {
      throw input_error({series_.frames.front().file, "",
                         "belongs to a series of " + std::to_string(series_.volumes) + " volumes",
                         std::to_string(kMostGradients) + " at most", ""});
    }
    info.diffusion.layout = TensorLayout::kUnstated;
    if (!series_.gradients) {
      if (series_.volumes > 1) {
        info.notes.push_back("no b-values in its images: no tensor can be fitted to its " +
                             std::to_string(series_.volumes) + " volumes");
        array_.components = static_cast<int>(series_.volumes);
        volumes_.resize(series_.volumes);
        std::iota(volumes_.begin(), volumes_.end(), 0);
        signals_ = true;
      }
      return;
    }
    volumes_.resize(series_.volumes);
    std::iota(volumes_.begin(), volumes_.end(), std::size_t{0});
    signals_ = true;
    array_.name = kSignalArray;
    array_.components = static_cast<int>(volumes_.size());
    info.diffusion.gradients = series_.gradients;
    info.diffusion.gradient_frame = VectorFrame::kLps;
  }

  DicomSeries series_;
  ArrayInfo array_;
  std::vector<std::size_t> volumes_;  ///< of a tuple
  bool signals_ = false;              ///< a tuple holds several volumes
};

}  // namespace

std::unique_ptr<Loader> make_dicom_loader() { return std::make_unique<DicomLoader>(); }

}  // namespace palpate
