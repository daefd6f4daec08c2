#include "common/scene/plan.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <set>

#include "common/base/text.h"
#include "common/field/grid/box_grid.h"
#include "common/field/grid/tet_mesh.h"
#include "common/field/scalar_choice.h"
#include "common/load/format.h"

namespace palpate {
namespace {

// A hexahedron becomes five or six tetrahedra (cell_split.h); a tetrahedron takes four vertices, four
// neighbours and a flag; its share of the search index is about one box.
constexpr std::uint64_t kTetsPerCell = 5;
constexpr std::uint64_t kBytesPerTet = sizeof(TetMesh::Tet) + sizeof(TetMesh::Neighbors) + 1 + 32;

constexpr const char* kHelper = "helper ";
constexpr const char* kArray = "array ";
constexpr const char* kTetrahedra = "tetrahedra with neighbours and cell index";
constexpr const char* kBoxes = "box grid, cells found directly";

// Rates of the estimates, measured on two cores of an AMD EPYC with the sample data (carotid, blunt fin,
// disk) and a software rasteriser: milliseconds.
constexpr double kPerArray = 0.5;
constexpr double kPerArrayByte = 5e-7;
constexpr double kPerBoxPoint = 1e-5;  // of one thread
constexpr double kPerTet = 1.6e-3;     // of one thread
constexpr double kPerLine = 0.25;      // of one thread, at the default tolerance; 0.06 to 0.55 were seen
constexpr double kPerPicture = 100.0;
constexpr double kPerDrawnLine = 0.5;

Need used(std::string what, std::string why, std::uint64_t bytes = 0, double milliseconds = 0.0) {
  return {std::move(what), std::move(why), true, bytes, milliseconds};
}
double array_milliseconds(std::uint64_t bytes) {
  return kPerArray + kPerArrayByte * static_cast<double>(bytes);
}
Need left_out(std::string what, std::string why, std::uint64_t bytes = 0) {
  return {std::move(what), std::move(why), false, bytes, 0.0};
}
/// @param milliseconds where it is used.
Need when(bool is_used, std::string what, std::string why_used, std::string why_not,
          double milliseconds = 0.0) {
  return is_used ? used(std::move(what), std::move(why_used), 0, milliseconds)
                 : left_out(std::move(what), std::move(why_not));
}

bool is_box(const FileInfo& file) {
  return file.blocks.size() == 1 &&
         (file.blocks[0].grid == "uniform" || file.blocks[0].grid == "rectilinear");
}

void plan_arrays(const Input& input, const SceneUse& use, Needs& plan) {
  const std::string field = "the " + std::string(name_of(input.spec().kind)) + " field";
  std::vector<std::string> wanted;
  if (use.field && !input.fields().empty()) wanted = input.field_arrays();
  for (const ArrayInfo& array : input.arrays()) {
    const std::uint64_t bytes = array.sparse_bytes > 0 ? array.sparse_bytes
                                                       : static_cast<std::uint64_t>(array.tuples) *
                                                             static_cast<std::uint64_t>(array.components) *
                                                             byte_size(array.type);
    const bool in_field = std::find(wanted.begin(), wanted.end(), array.name) != wanted.end();
    const bool colors = array.name == use.color_array;
    const bool in_lens =
        std::any_of(use.secondary.begin(), use.secondary.end(), [&](const std::string& name) {
          return input.names_field(name) &&
                 choose_scalar(input.arrays(), name, input.title()).array == array.name;
        });
    const bool drawn =
        std::find(use.volume_arrays.begin(), use.volume_arrays.end(), array.name) != use.volume_arrays.end();
    const std::string what = kArray + array.name;
    if (in_field) {
      plan.push_back(used(what, field, bytes, array_milliseconds(bytes)));
    } else if (in_lens) {
      plan.push_back(used(what, "another field, for lenses", bytes, array_milliseconds(bytes)));
    } else if (drawn) {
      plan.push_back(used(what, "drawn as a volume", bytes, array_milliseconds(bytes)));
    } else if (colors) {
      plan.push_back(used(what, "colours the lines", bytes, array_milliseconds(bytes)));
    } else if (use.all_arrays) {
      plan.push_back(used(what, "its range", bytes, array_milliseconds(bytes)));
    } else {
      plan.push_back(left_out(what, "nothing asks for it", bytes));
    }
  }
}

// Voxels of other files.
void plan_secondary(const Input& input, const SceneUse& use, Needs& plan) {
  for (const std::string& name : use.secondary) {
    if (!input.names_field(name)) plan.push_back(used("voxels of " + name, "another field, for lenses"));
  }
}

void plan_file(const Input& input, const FileInfo& file, const SceneUse& use, Needs& plan) {
  // It is at work already: what it took is known.
  if (file.loader.empty()) {
    plan.push_back(used("voxels of " + input.title(), "made on the fly", 0, 1e3 * input.seconds_open()));
  } else {
    plan.push_back(used(kHelper + file.loader, "reads " + file.format, 0, 1e3 * input.seconds_open()));
  }
  std::set<std::string> others;
  for (const FormatRow& row : format_rows()) others.emplace(row.helper);
  others.erase(file.loader);
  for (const std::string& helper : others) plan.push_back(left_out(kHelper + helper, "not for this format"));

  plan_arrays(input, use, plan);
  plan_secondary(input, use, plan);
  if (file.times.size() > 1) {
    plan.push_back(
        left_out(std::to_string(file.times.size() - 1) + " other time steps", "one is shown at a time"));
  }
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  for (const BlockInfo& block : file.blocks) {
    points += block.point_count;
    cells += block.cell_count;
  }
  const std::uint64_t tet_bytes = points * sizeof(Vec3) + kTetsPerCell * cells * kBytesPerTet;
  const int threads = std::max(1, use.threads);
  const double tet_time = kPerTet * static_cast<double>(kTetsPerCell * cells) / threads;
  if (is_box(file)) {
    if (use.field) {
      plan.push_back(used(kBoxes, "locating and interpolating", 0,
                          kPerBoxPoint * static_cast<double>(points) / threads));
    } else {
      plan.push_back(left_out(kBoxes, "no field is made"));
    }
    plan.push_back(left_out(kTetrahedra, "the grid is " + file.blocks[0].grid));
  } else if (use.field) {
    plan.push_back(used(kTetrahedra, "locating and interpolating", tet_bytes, tet_time));
  } else {
    plan.push_back(left_out(kTetrahedra, "no field is made", tet_bytes));
  }
}

std::string line_of(const Need& need) {
  std::array<char, 64> cost{};
  const std::string bytes = need.bytes == 0 ? "" : bytes_text(need.bytes);
  std::snprintf(cost.data(), cost.size(), "%10s ", bytes.c_str());
  std::string line = "  " + std::string(cost.data());
  if (need.milliseconds > 0.0) {
    std::snprintf(cost.data(), cost.size(), "%9.1f ms", need.milliseconds);
    line += cost.data();
  } else {
    line += std::string(12, ' ');
  }
  return line + "  " + need.what + ": " + need.why + "\n";
}

}  // namespace

Needs plan_scene(const Input& input, const SceneUse& use) {
  Needs plan;
  if (const FileInfo* file = input.file()) {
    plan_file(input, *file, use, plan);
  } else {
    plan.push_back(used("formula " + input.spec().example, "the vector field, exact everywhere"));
    plan.push_back(left_out("helper programs", "nothing is read"));
  }
  plan.push_back(left_out("derived fields (gradient, vorticity, Q, lambda-2)", "nothing asks for them"));
  const auto lines = static_cast<double>(use.lines);
  plan.push_back(when(use.tracing, use.lines > 0 ? "tracing " + counted(use.lines, "line") : "tracing",
                      "lines from the seeds", "this verb makes no lines",
                      kPerLine * lines / std::max(1, use.threads)));
  plan.push_back(when(use.drawing, "drawing: lines, outline, axes, colour bar", "the picture",
                      "nothing is drawn", use.lines > 0 ? kPerPicture + kPerDrawnLine * lines : 0.0));
  plan.push_back(when(use.window, "window and panels", "to look and touch", "nothing is shown"));
  plan.push_back(left_out("device drivers", "no probe is moved"));
  return plan;
}

std::string plan_text(const Needs& plan) {
  std::string text = "used (bytes and milliseconds expected):\n";
  for (const Need& need : plan) {
    if (need.used) text += line_of(need);
  }
  text += "left out:\n";
  for (const Need& need : plan) {
    if (!need.used) text += line_of(need);
  }
  return text;
}

std::vector<MeasuredCost> measured_costs(const Input& input, const TetMesh* mesh) {
  std::uint64_t bytes = 0;
  if (mesh != nullptr) bytes = mesh->points().size() * sizeof(Vec3) + mesh->cells().size() * kBytesPerTet;
  return {{.what = "opening", .milliseconds = 1e3 * input.seconds_open()},
          {.what = "arrays", .milliseconds = 1e3 * input.seconds_read()},
          {.what = "field", .milliseconds = 1e3 * input.seconds_field(), .bytes = bytes}};
}

std::string measured_text(const std::vector<MeasuredCost>& costs) {
  std::string text;
  for (const MeasuredCost& cost : costs) {
    text += (text.empty() ? "measured: " : ", ") + std::string(cost.what) + " " +
            short_number(cost.milliseconds) + " ms";
    if (cost.bytes > 0) text += " (" + bytes_text(cost.bytes) + ")";
  }
  return text + "\n";
}

}  // namespace palpate
