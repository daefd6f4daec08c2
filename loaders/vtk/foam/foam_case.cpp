#include "loaders/vtk/foam/foam_case.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/field/cells/boundary_values.h"
#include "loaders/vtk/foam/foam_collated.h"
#include "loaders/vtk/foam/foam_point_values.h"
#include "loaders/vtk/foam/foam_precision.h"
#include "loaders/vtk/foam/foam_text.h"

namespace palpate {
namespace {

namespace fs = std::filesystem;

bool there(const fs::path& file) {
  std::error_code ignored;
  return fs::exists(file, ignored) || fs::exists(file.string() + ".gz", ignored);
}

/// The folders of times of a case, rising.
std::vector<std::pair<double, fs::path>> times_in(const fs::path& folder) {
  std::vector<std::pair<double, fs::path>> out;
  std::error_code error, ignored;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const auto time = number(it->path().filename().string());
    if (time && it->is_directory(ignored)) out.emplace_back(*time, it->path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

/// The last time that has values; none where no time has.
std::optional<double> last_time(const fs::path& folder) {
  std::optional<double> out;
  std::error_code ignored;
  for (const auto& [time, path] : times_in(folder)) {
    if (!fs::is_empty(path, ignored)) out = time;
  }
  return out;
}

std::vector<Vec3> positions_of(const UnstructuredTopology& mesh) {
  std::vector<Vec3> out(mesh.positions.tuples);
  for (std::size_t p = 0; p < out.size(); ++p)
    out[p] = {mesh.positions.at(p, 0), mesh.positions.at(p, 1), mesh.positions.at(p, 2)};
  return out;
}

/// The cases of processors as one.
class DecomposedReader : public Loader {
 public:
  DecomposedReader(std::vector<fs::path> folders, std::function<std::unique_ptr<Loader>()> make_case)
      : folders_(std::move(folders)), make_case_(std::move(make_case)) {}

  FileInfo open(const LoadRequest& request, Format format) override {
    FileInfo info;
    std::set<std::string> notes;
    std::vector<std::vector<double>> times;
    std::size_t empty = 0;
    for (const fs::path& folder : folders_) {
      auto reader = make_case_();
      LoadRequest part = request;
      part.files = {folder};
      FileInfo of_part;
      try {
        of_part = reader->open(part, format);
      } catch (const Error&) {
        // A processor may have no cells.
        if (!has_no_cells(folder)) throw;
        ++empty;
        continue;
      }
      for (BlockInfo& block : of_part.blocks) {
        block.name = name_of(folder, block.name);
        info.blocks.push_back(std::move(block));
      }
      for (std::string& note : of_part.notes) notes.insert(folder.filename().string() + ": " + note);
      // A single time is not listed.
      if (of_part.times.empty()) {
        if (const std::optional<double> only = last_time(folder)) of_part.times = {*only};
      }
      times.push_back(std::move(of_part.times));
      parts_.push_back({folder, std::move(reader)});
    }
    if (parts_.empty())
      throw input_error({request.files.front().string(), "", "has processor folders without cells", "", ""});
    take_common(times, info);
    info.notes.push_back(std::to_string(folders_.size()) + " processor folders read as one case" +
                         (empty > 0 ? ", " + std::to_string(empty) + " of them without cells" : ""));
    info.notes.insert(info.notes.end(), notes.begin(), notes.end());
    return info;
  }

  std::vector<DataSet> read(const std::vector<std::string>& names, std::size_t step) override {
    std::vector<DataSet> out;
    for (std::size_t p = 0; p < parts_.size(); ++p) {
      for (DataSet& block : parts_[p].reader->read(names, steps_.empty() ? step : steps_[p][step])) {
        block.name = name_of(parts_[p].folder, block.name);
        out.push_back(std::move(block));
      }
      if (on_progress) on_progress(static_cast<double>(p + 1) / static_cast<double>(parts_.size()));
    }
    return out;
  }

 private:
  struct Part {
    fs::path folder;
    std::unique_ptr<Loader> reader;
  };

  static std::string name_of(const fs::path& folder, const std::string& block) {
    return folder.filename().string() + (block.empty() ? "" : "/" + block);
  }
  static bool has_no_cells(const fs::path& folder) {
    try {
      const FoamText owner(folder / "constant/polyMesh/owner");
      return read_foam_count(owner.text(), folder.string()) == 0;
    } catch (const Error&) {
      return false;
    }
  }

  /// Times that all parts have, and what number each has in each part.
  void take_common(const std::vector<std::vector<double>>& times, FileInfo& info) {
    std::set<double> all;
    for (const auto& of_part : times) all.insert(of_part.begin(), of_part.end());
    std::vector<double> common;
    for (const double time : all) {
      if (std::all_of(times.begin(), times.end(), [&](const auto& part) {
            return std::find(part.begin(), part.end(), time) != part.end();
          }))
        common.push_back(time);
    }
    if (all.empty()) return;
    if (common.empty()) {
      throw input_error({folders_.front().parent_path().string(), "",
                         "has processor folders of different times", "a time that all have",
                         "run reconstructPar"});
    }
    if (common.size() < all.size())
      info.notes.push_back(counted(all.size() - common.size(), "time") +
                           " left out: not all processor folders have them");
    for (const auto& of_part : times) {
      std::vector<std::size_t> steps;
      for (const double time : common)
        steps.push_back(as_size(std::find(of_part.begin(), of_part.end(), time) - of_part.begin()));
      steps_.push_back(std::move(steps));
    }
    if (common.size() > 1) info.times = std::move(common);
  }

  std::vector<fs::path> folders_;
  std::function<std::unique_ptr<Loader>()> make_case_;
  std::vector<Part> parts_;
  /// Of each part, at each common time; empty for single states.
  std::vector<std::vector<std::size_t>> steps_;
};

/// Whether the cells have one value: "internalField uniform …".
bool is_uniform(std::string_view text) {
  constexpr std::string_view kField = "internalField", kUniform = "uniform";
  const std::size_t field = text.find(kField);
  if (field == std::string_view::npos) return false;
  const std::size_t how = text.find_first_not_of(" \t\r\n", field + kField.size());
  return how != std::string_view::npos && text.substr(how, kUniform.size()) == kUniform;
}

// VTK's reader gives XX YY ZZ XY YZ XZ of a list of symmTensors, files XX XY XZ YY YZ ZZ. It leaves one for all
// cells as it is.
void order_as_vtk(FoamPatchValues& values) {
  constexpr std::size_t kSymmetric = 6;
  for (std::size_t i = 0; i + kSymmetric <= values.numbers.size(); i += kSymmetric) {
    std::swap(values.numbers[i + 1], values.numbers[i + 3]);
    std::swap(values.numbers[i + 2], values.numbers[i + 5]);
  }
}

/// The internalField, one tuple a cell, in the order of VTK's components.
/// @throws FoamMalformed.
std::vector<double> values_of_cells(std::string_view text, int components, std::size_t cells,
                                    const FoamInclude& include) {
  FoamPatchValues values = read_foam_inner_values(text, components, include);
  if (!values.uniform) {
    if (components == 6) order_as_vtk(values);
    return std::move(values.numbers);
  }
  std::vector<double> out;
  for (std::size_t cell = 0; cell < cells; ++cell)
    out.insert(out.end(), values.numbers.begin(), values.numbers.end());
  return out;
}

/// The numbers a cell that a file's class says; 0 where it is no field of cells.
int components_of_class(std::string_view text) {
  FoamTokens tokens(text.substr(0, 4096), FoamStorage{});
  while (!tokens.done()) {
    if (tokens.next() != "class") continue;
    const std::string_view name = tokens.next();
    for (const auto& [known, components] : {std::pair{"volScalarField", 1},
                                            {"volVectorField", 3},
                                            {"volSymmTensorField", 6},
                                            {"volTensorField", 9}}) {
      if (name == known) return components;
    }
    return 0;
  }
  return 0;
}

}  // namespace

fs::path foam_folder(const std::string& file) {
  std::error_code ignored;
  const fs::path path(file);
  fs::path folder = fs::is_directory(path, ignored) ? path : path.parent_path();
  if (path.filename() == "controlDict") folder = folder.parent_path();
  return folder.empty() ? fs::path(".") : folder;
}

fs::path FoamBoundaryReader::region_of(const std::string& block) const {
  const std::size_t end = block.find("/internalMesh");
  if (end != std::string::npos)
    return block.substr(0, end) == "defaultRegion" ? fs::path() : fs::path(block.substr(0, end));
  if (there(folder_ / "constant/polyMesh/boundary")) return {};
  // A case of one region alone.
  std::error_code error;
  for (fs::directory_iterator it(folder_ / "constant", error), last; !error && it != last;
       it.increment(error)) {
    if (there(it->path() / "polyMesh/boundary")) return it->path().filename();
  }
  return {};
}

/// The last at or before the time that has such a file of a mesh of its own: it may move.
fs::path FoamBoundaryReader::mesh_folder(const fs::path& region, double time, const char* file) const {
  fs::path out = folder_ / "constant" / region / "polyMesh";
  for (const auto& [at, folder] : times_in(folder_)) {
    if (at <= time && there(folder / region / "polyMesh" / file)) out = folder / region / "polyMesh";
  }
  return out;
}

const FoamBoundaryReader::Mesh& FoamBoundaryReader::mesh_in(const fs::path& folder) {
  const auto known = meshes_.find(folder);
  if (known != meshes_.end()) return known->second;
  Mesh mesh;
  mesh.patches = read_foam_patches(FoamText(folder / "boundary").text(), (folder / "boundary").string());
  mesh.first_face = std::numeric_limits<std::size_t>::max();
  for (const FoamPatch& patch : mesh.patches) mesh.first_face = std::min(mesh.first_face, patch.first_face);
  mesh.faces =
      read_foam_faces(FoamText(folder / "faces").text(), mesh.first_face, (folder / "faces").string());
  std::size_t faces = 0;
  for (const FoamPatch& patch : mesh.patches) {
    faces += std::min(patch.faces, std::numeric_limits<std::size_t>::max() - faces);
  }
  if (faces > mesh.faces.begin.size()) {
    throw input_error({(folder / "boundary").string(), "", "has patches of more faces than there are",
                       "each face in one patch", "the file may be damaged"});
  }
  mesh.points = read_foam_count(FoamText(folder / "points").text(), (folder / "points").string());
  if (FoamBaffles::any(mesh.faces, mesh.first_face, mesh.patches)) {
    const FoamFaces all = read_foam_faces(FoamText(folder / "faces").text(), 0, (folder / "faces").string());
    const auto owner = read_foam_labels(FoamText(folder / "owner").text(), (folder / "owner").string());
    const auto neighbour =
        read_foam_labels(FoamText(folder / "neighbour").text(), (folder / "neighbour").string());
    // A cell has faces, so that there are fewer cells than faces.
    for (const auto* list : {&owner, &neighbour}) {
      const std::int64_t least = list == &owner ? 0 : -1;
      for (const std::int64_t cell : *list) {
        if (cell >= least && cell < static_cast<std::int64_t>(owner.size())) continue;
        throw input_error({(folder / (list == &owner ? "owner" : "neighbour")).string(), "",
                           "has a face of cell " + std::to_string(cell), "a cell of the mesh",
                           "the file may be damaged"});
      }
    }
    mesh.baffles = FoamBaffles(all, mesh.patches, owner, neighbour, mesh.points);
    for (std::size_t face = 0; face + 1 < mesh.faces.begin.size() && mesh.first_face + face < owner.size();
         ++face) {
      for (std::size_t p = mesh.faces.begin[face]; p < mesh.faces.begin[face + 1]; ++p)
        mesh.faces.points[p] = mesh.baffles.point_of(owner[mesh.first_face + face], mesh.faces.points[p]);
    }
  }
  return meshes_[folder] = std::move(mesh);
}

/// Of the case's own files alone.
std::string FoamBoundaryReader::included(const fs::path& folder, std::string_view name) const {
  constexpr std::size_t kMostBytes = std::size_t{1} << 20U;
  std::error_code error;
  const fs::path file = fs::weakly_canonical(folder / fs::path(name), error);
  const fs::path home = error ? fs::path() : fs::weakly_canonical(folder_, error);
  const auto [end, rest] = std::mismatch(home.begin(), home.end(), file.begin(), file.end());
  if (error || end != home.end() || !fs::is_regular_file(file, error) ||
      fs::file_size(file, error) > kMostBytes)
    return {};
  try {
    return std::string(FoamText(file).text());
  } catch (const Error&) {
    return {};
  }
}

void FoamBoundaryReader::restore_points(DataSet& block, const fs::path& region, double time,
                                        std::set<std::string>& problems) const {
  DataArray& positions = std::get<UnstructuredTopology>(block.topology).positions;
  if (positions.type != ScalarType::kFloat32) return;
  const fs::path file = mesh_folder(region, time, "points") / "points";
  try {
    const FoamText text(file);
    if (is_single_precision(text.text())) return;
    if (auto exact = in_double(positions, read_foam_points(text.text(), file.string()))) {
      positions = *std::move(exact);
      return;
    }
    problems.insert("points in single precision: those of " + file.string() + " are others than VTK's");
  } catch (const Error& error) {
    problems.insert(std::string("points in single precision: ") + error.what());
  }
}

void FoamBoundaryReader::restore_values(DataSet& block, const fs::path& folder,
                                        std::set<std::string>& problems) const {
  const FoamInclude include = [&](std::string_view name) { return included(folder, name); };
  for (DataArray& array : block.arrays) {
    if (array.type != ScalarType::kFloat32 || !there(folder / array.name)) continue;
    std::string why = "the order of its values is not VTK's";
    try {
      const FoamText text(folder / array.name);
      if (is_single_precision(text.text())) continue;
      const std::vector<double> values =
          values_of_cells(text.text(), array.components, array.tuples, include);
      if (auto exact = in_double(array, values)) {
        array = *std::move(exact);
        continue;
      }
    } catch (const FoamMalformed& problem) {
      why = problem.found;
    } catch (const Error& error) {
      why = error.what();
    }
    problems.insert("'" + array.name + "' in single precision: " + why);
  }
}

fs::path FoamBoundaryReader::folder_at(double time, const fs::path& region) const {
  fs::path at;
  for (const auto& [when, folder] : times_in(folder_)) {
    if (when == time) at = folder / region;
  }
  return at;
}

bool FoamBoundaryReader::add_values(DataSet& block, const std::string& name, double time) const {
  const fs::path at = folder_at(time, region_of(block.name));
  if (at.empty() || !there(at / name)) return false;
  const FoamInclude include = [&](std::string_view file) { return included(at, file); };
  try {
    const FoamText text(at / name);
    const int components = components_of_class(text.text());
    if (components == 0) return false;
    const std::vector<double> values = values_of_cells(text.text(), components, block.cell_count(), include);
    if (values.size() != block.cell_count() * as_size(components)) return false;
    block.arrays.push_back(make_array(name, Association::kCell, components, values));
    return true;
  } catch (const FoamMalformed&) {
    return false;
  } catch (const Error&) {
    return false;
  }
}

std::vector<std::string> FoamBoundaryReader::add(std::vector<DataSet>& blocks, double time) {
  std::set<std::string> problems;
  for (DataSet& block : blocks) {
    const auto* mesh_of_block = std::get_if<UnstructuredTopology>(&block.topology);
    if (mesh_of_block == nullptr) continue;
    const fs::path region = region_of(block.name);
    restore_points(block, region, time, problems);
    const fs::path at = folder_at(time, region);
    if (at.empty()) continue;
    restore_values(block, at, problems);
    const FoamInclude include = [&](std::string_view name) { return included(at, name); };
    std::size_t points = 0;
    try {
      const Mesh& mesh = mesh_in(mesh_folder(region, time));
      points = mesh.points;
      if (!mesh.baffles.empty()) {
        if (mesh.baffles.split(block)) {
          points = mesh.baffles.points();
        } else {
          problems.insert(
              "baffles are not parted: the mesh has other cells or points than its files; flow goes through "
              "them");
        }
      }
    } catch (const Error& error) {
      problems.insert(std::string("the boundary cannot be read: ") + error.what());
      continue;
    }
    const std::vector<DataArray> arrays = block.arrays;
    std::vector<Vec3> positions;
    for (const DataArray& array : arrays) {
      if (array.association != Association::kCell || !there(at / array.name)) continue;
      const auto problem = [&](const std::string& what) {
        problems.insert("boundary of '" + array.name + "', " + what + ": interpolated from the cells");
      };
      try {
        const Mesh& mesh = mesh_in(mesh_folder(region, time));
        std::vector<std::string> found;
        const FoamText field(at / array.name);
        auto values = read_foam_boundary(field.text(), array.components, mesh.patches, found, include);
        if (array.components == 6 && !is_uniform(field.text())) {
          for (auto& [patch, of_patch] : values) order_as_vtk(of_patch);
        }
        for (const std::string& what : found) problem(what);
        if (values.empty()) continue;
        if (points != mesh_of_block->positions.tuples) {
          problem(std::to_string(points) + " points where the mesh has " +
                  std::to_string(mesh_of_block->positions.tuples));
          continue;
        }
        if (positions.empty()) positions = positions_of(*mesh_of_block);
        std::vector<double> numbers =
            foam_point_values(mesh.patches, mesh.faces, mesh.first_face, values, array.components, positions);
        if (array.components == 3) {
          const std::vector<double> normals =
              foam_point_normals(mesh.patches, mesh.faces, mesh.first_face, values, positions, numbers);
          if (!normals.empty()) {
            block.arrays.push_back(make_array(sliding_array_of(array.name), Association::kPoint, 6,
                                              std::span<const double>(normals)));
          }
        }
        if (numbers.empty()) continue;
        leave_out_bad_cells(std::get<UnstructuredTopology>(block.topology), array, numbers);
        block.arrays.push_back(make_array(boundary_array_of(array.name), Association::kPoint,
                                          array.components, std::span<const double>(numbers)));
      } catch (const Error& error) {
        problem(error.what());
      }
    }
  }
  return {problems.begin(), problems.end()};
}

FoamProcessors foam_processors(const fs::path& folder, std::vector<std::string>& notes) {
  std::vector<std::pair<double, fs::path>> single, collated;
  std::error_code error, ignored;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    constexpr std::string_view kName = "processor";
    if (name.compare(0, kName.size(), kName) != 0 || !it->is_directory(ignored)) continue;
    const auto rank = parsed<int>(std::string_view(name).substr(kName.size()));
    if (rank && *rank >= 0) single.emplace_back(*rank, it->path());
    const auto [first, count] = foam_processors_of(name);
    if (count > 0) collated.emplace_back(first, it->path());
  }
  FoamProcessors out;
  if (single.empty() && collated.empty()) return out;
  std::sort(single.begin(), single.end());
  std::sort(collated.begin(), collated.end());
  const auto last_of = [](const auto& folders) {
    return folders.empty() ? std::nullopt : last_time(folders.front().second);
  };
  const std::optional<double> own = last_time(folder), of_single = last_of(single),
                              of_collated = last_of(collated);
  out.collated = !of_single || (of_collated && *of_collated > *of_single);
  const std::optional<double> parts = out.collated ? of_collated : of_single;
  if (own && !(parts && *parts > *own)) {
    notes.push_back("the case's own times are read, not those of its processor folders");
    return {};
  }
  if (own) {
    notes.push_back("the processor folders are read: they go on after time " + short_number(*own) +
                    ", the last of the case's own");
  }
  if (out.collated) {
    out.collated = !collated.empty();
    for (auto& [first, path] : collated) out.folders.push_back(std::move(path));
    return out;
  }
  if (!collated.empty()) notes.push_back("the collated processor folders are not read: the others go as far");
  if (single.back().first + 1.0 != static_cast<double>(single.size())) {
    notes.push_back("processor folders are missing: " + std::to_string(single.size()) +
                    " are there, the last is processor" + short_number(single.back().first));
  }
  for (auto& [rank, path] : single) out.folders.push_back(std::move(path));
  return out;
}

std::unique_ptr<Loader> make_decomposed_reader(std::vector<fs::path> folders,
                                               std::function<std::unique_ptr<Loader>()> make_case) {
  return std::make_unique<DecomposedReader>(std::move(folders), std::move(make_case));
}

}  // namespace palpate
