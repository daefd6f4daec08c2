#include "common/load/fsl_gradients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <span>
#include <string_view>

#include "common/base/error.h"
#include "common/base/text.h"
#include "common/field/tensor/gradient_table.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

/// Lines of numbers; blank lines are left out.
using Table = std::vector<std::vector<double>>;

/// Whether commas stand in numbers ("0,5 -0,25"), not between them: no point is there, every comma has a digit
/// on both sides, no word has two, and several words stand in a line.
bool has_decimal_commas(std::string_view text) {
  if (text.find(',') == std::string_view::npos || text.find('.') != std::string_view::npos) return false;
  bool several = false;
  for (const std::string_view line : split(text, '\n')) {
    const std::vector<std::string_view> parts = words(line);
    several = several || parts.size() > 1;
    for (const std::string_view word : parts) {
      const std::size_t comma = word.find(',');
      if (comma == std::string_view::npos) continue;
      const auto digit = [&](std::size_t at) {
        return at < word.size() && word[at] >= '0' && word[at] <= '9';
      };
      if (comma == 0 || !digit(comma - 1) || !digit(comma + 1) ||
          word.find(',', comma + 1) != std::string_view::npos) {
        return false;
      }
    }
  }
  return several;
}

Table read_table(const std::string& file, std::vector<std::string>& notes) {
  // A number and its blank for every volume and axis fit many times over.
  constexpr std::size_t kMostBytes = std::size_t{1} << 20;
  const HeadOfFile head = read_head(file, kMostBytes);
  if (head.file_size > kMostBytes)
    throw input_error({file, "", "has " + bytes_text(head.file_size), "a short table of numbers", ""});
  std::string text = head.bytes;
  constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
  if (text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
  // Lines end with CR alone on old machines.
  if (text.find('\n') == std::string::npos) std::replace(text.begin(), text.end(), '\r', '\n');
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\t' || c == '\r' || c == ';'; }, ' ');
  const bool decimal = has_decimal_commas(text);
  if (decimal) notes.push_back(file + ": commas taken for decimal points");
  std::replace(text.begin(), text.end(), ',', decimal ? '.' : ' ');
  Table table;
  std::size_t line_number = 0;
  for (const std::string_view line : split(text, '\n')) {
    ++line_number;
    if (trimmed(line).starts_with('#')) continue;
    std::vector<double> numbers;
    for (const std::string_view word : split(line, ' ')) {
      if (word.empty()) continue;
      const std::optional<double> value = number(word);
      if (!value) {
        throw input_error({file, "line " + std::to_string(line_number),
                           "'" + std::string(word.substr(0, 40)) + "' is no number", "numbers", ""});
      }
      numbers.push_back(*value);
    }
    if (!numbers.empty()) table.push_back(std::move(numbers));
  }
  return table;
}

Error wrong_count(const std::string& file, const std::string& found, std::size_t volumes) {
  return input_error({file, "", found, "one for each of the image's " + counted(volumes, "volume"),
                      "is it the file of another image?"});
}

std::vector<double> read_weightings(const std::string& file, std::size_t volumes,
                                    std::vector<std::string>& notes) {
  std::vector<double> all;
  for (const std::vector<double>& line : read_table(file, notes))
    all.insert(all.end(), line.begin(), line.end());
  if (all.size() != volumes) throw wrong_count(file, "has " + counted(all.size(), "b-value"), volumes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!std::isfinite(all[i]) || all[i] < 0.0) {
      throw input_error({file, "b-value " + std::to_string(i + 1), "is " + short_number(all[i]),
                         "a finite number, not below zero", ""});
    }
  }
  return all;
}

std::vector<Vec3> read_directions(const std::string& file, std::size_t volumes,
                                  std::vector<std::string>& notes) {
  const Table table = read_table(file, notes);
  const auto all_have = [&table](std::size_t count) {
    return std::all_of(table.begin(), table.end(),
                       [count](const auto& line) { return line.size() == count; });
  };
  std::vector<Vec3> directions(volumes, Vec3{0.0});
  const bool rows = table.size() == 3 && all_have(volumes);
  if (!rows && !(table.size() == volumes && all_have(3))) {
    std::string found = "has " + counted(table.size(), "line");
    if (!table.empty()) found += " of " + counted(table.front().size(), "number");
    const auto ragged = std::find_if(table.begin(), table.end(), [&table](const auto& line) {
      return line.size() != table.front().size();
    });
    if (ragged != table.end()) {
      found = "line " + std::to_string(ragged - table.begin() + 1) + " has " +
              counted(ragged->size(), "number") + ", the first " + std::to_string(table.front().size());
    }
    throw input_error({file, "", found,
                       "3 lines of " + std::to_string(volumes) + " numbers or " + std::to_string(volumes) +
                           " lines of 3, one direction a volume",
                       "is it the file of another image?"});
  }
  for (std::size_t i = 0; i < volumes; ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      directions[i][static_cast<int>(axis)] = rows ? table[axis][i] : table[i][axis];
  }
  return directions;
}

constexpr std::string_view kMrtrixEnding = ".b", kTurnedEnding = ".eddy_rotated_bvecs";

/// A line for each volume: x, y, z in scanner axes, and b.
GradientTable read_mrtrix_table(const std::string& file, std::size_t volumes,
                                std::vector<std::string>& notes) {
  const Table table = read_table(file, notes);
  if (table.size() != volumes) throw wrong_count(file, "has " + counted(table.size(), "gradient"), volumes);
  GradientTable gradients;
  constexpr double kLongest = 1e9;
  for (std::size_t i = 0; i < volumes; ++i) {
    const std::vector<double>& line = table[i];
    const std::string place = "gradient " + std::to_string(i + 1);
    if (line.size() < 4)
      throw input_error({file, place, "has " + counted(line.size(), "number"), "x, y, z and b", ""});
    Vec3 g{line[0], line[1], line[2]};
    if (!is_finite(g)) g = Vec3{0.0};
    if (!(line[3] >= 0.0 && std::isfinite(line[3]) && glm::length(g) < kLongest))
      throw input_error(
          {file, place,
           "has b = " + short_number(line[3]) + " and a direction of length " + short_number(glm::length(g)),
           "b finite and not below zero, a length of about one", ""});
    gradients.weightings.push_back(line[3]);
    gradients.directions.push_back(g);
  }
  notes.push_back("gradients from " + file + ", MRtrix's table in scanner axes");
  return gradients;
}

/// The first of `names` that is a file in `folder`, or empty.
std::string first_file(const std::filesystem::path& folder, std::span<const std::string> names) {
  for (const std::string& name : names) {
    std::error_code error;
    if (std::filesystem::is_regular_file(folder / name, error)) return (folder / name).string();
  }
  return {};
}

}  // namespace

std::string gradient_names(const std::string& file) {
  const std::string stem = nifti_stem(file);
  return stem + ".bval, " + stem + ".bvec or " + stem + ".b";
}

std::optional<FslGradientFiles> find_fsl_gradients(const std::string& file, const DiffusionRequest& request) {
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  const std::string stem = nifti_stem(file);
  FslGradientFiles files{request.bval.string(), request.bvec.string()};
  if (files.weightings.empty() && files.directions.ends_with(kMrtrixEnding)) {
    files.weightings = files.directions;
    return files;
  }
  if (files.weightings.empty())
    files.weightings = first_file(folder, std::array{stem + ".bval", stem + ".bvals", std::string("bvals")});
  if (files.directions.empty())
    files.directions = first_file(folder, std::array{stem + std::string(kTurnedEnding), stem + ".bvec",
                                                     stem + ".bvecs", std::string("bvecs")});
  if (files.weightings.empty() && files.directions.empty()) {
    files.weightings = first_file(folder, std::array{stem + std::string(kMrtrixEnding)});
    files.directions = files.weightings;
  }
  if (files.weightings.empty() && files.directions.empty()) return std::nullopt;
  if (files.weightings.empty() || files.directions.empty()) {
    const bool no_weightings = files.weightings.empty();
    throw input_error({file, "",
                       std::string("has gradient ") + (no_weightings ? "directions" : "weightings") + " (" +
                           (no_weightings ? files.directions : files.weightings) + ") without " +
                           (no_weightings ? "b-values" : "directions"),
                       gradient_names(file), no_weightings ? "name them by --bval" : "name them by --bvec"});
  }
  return files;
}

GradientTable read_fsl_gradients(const FslGradientFiles& files, std::size_t volumes, const Mat3& axes,
                                 std::vector<std::string>& notes) {
  if (volumes > kMostGradients) throw wrong_count(files.weightings, "cannot be", kMostGradients);
  if (files.frame() == VectorFrame::kScanner) return read_mrtrix_table(files.directions, volumes, notes);
  GradientTable table{read_weightings(files.weightings, volumes, notes),
                      read_directions(files.directions, volumes, notes)};
  const Mat3 ras_from_fsl = fsl_axes(axes);
  constexpr double kLongest = 1e9;
  for (std::size_t i = 0; i < volumes; ++i) {
    Vec3& g = table.directions[i];
    const double length = is_finite(g) ? glm::length(g) : 0.0;
    if (!(length < kLongest))
      throw input_error({files.directions, "direction " + std::to_string(i + 1),
                         "has a length of " + short_number(length), "about one", ""});
    // NaN is what converters write where there is none.
    g = length > 0.0 ? length * glm::normalize(ras_from_fsl * (g / length)) : Vec3{0.0};
  }
  notes.push_back("gradients from " + files.weightings + " and " + files.directions +
                  ", in the image's axes as FSL has them, turned into RAS" +
                  (glm::determinant(axes) > 0.0 ? " (x turned around: the image is right-handed)" : ""));
  if (files.directions.ends_with(kTurnedEnding))
    notes.emplace_back(
        "directions as FSL's eddy turned them with the volumes; those of a .bvec are left aside");
  return table;
}

VectorFrame FslGradientFiles::frame() const {
  return directions.ends_with(kMrtrixEnding) && weightings == directions ? VectorFrame::kScanner
                                                                         : VectorFrame::kImage;
}

std::optional<NamedGradients> named_fsl_gradients(const std::string& file, const DiffusionRequest& request,
                                                  std::size_t volumes, const Mat3& axes,
                                                  std::vector<std::string>& notes) {
  if (!request.names_gradients()) return std::nullopt;
  const FslGradientFiles files = *find_fsl_gradients(file, request);
  return NamedGradients{read_fsl_gradients(files, volumes, axes, notes), files.frame()};
}

namespace {

constexpr std::array<std::string_view, 7> kNames{"V1", "V2", "V3", "L1", "L2", "L3", "FA"};
constexpr std::array<std::string_view, 4> kEndings{".nii.gz", ".nii", ".hdr", ".img"};

}  // namespace

std::string nifti_stem(const std::string& file) {
  std::string name = std::filesystem::path(file).filename().string();
  for (const std::string_view ending : kEndings) {
    if (name.size() > ending.size() && name.ends_with(ending))
      return name.substr(0, name.size() - ending.size());
  }
  return name;
}

std::optional<std::string> fsl_image_name(const std::string& file) {
  const std::string stem = nifti_stem(file);
  for (const std::string_view name : kNames) {
    if (stem == name || stem.ends_with("_" + std::string(name))) return std::string(name);
  }
  return std::nullopt;
}

std::vector<std::pair<std::string, std::string>> fsl_images_beside(const std::string& file) {
  const std::string own = fsl_image_name(file).value_or("");
  const std::string stem = nifti_stem(file);
  const std::string prefix = stem.substr(0, stem.size() - own.size());
  const std::filesystem::path folder = std::filesystem::path(file).parent_path();
  std::vector<std::pair<std::string, std::string>> found;
  for (const std::string_view name : kNames) {
    if (name == own) continue;
    for (const std::string_view ending : kEndings) {
      const std::filesystem::path path = folder / (prefix + std::string(name) + std::string(ending));
      std::error_code error;
      if (!std::filesystem::is_regular_file(path, error)) continue;
      found.emplace_back(name, path.string());
      break;
    }
  }
  return found;
}

}  // namespace palpate
