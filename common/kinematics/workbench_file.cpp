#include "common/kinematics/workbench_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <sstream>
#include <utility>

#include "common/base/check.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/kinematics/workbench_section.h"
#include "common/math/lattice.h"

namespace palpate {
namespace {

/// The plane of the first screen, or the one that is given. For hands that are not tracked the screen is
/// where the view is.
Vec4 surface_of(const WorkbenchSection& s, const std::vector<ScreenGeometry>& screens, bool tracked) {
  if (s.at("surface").is_string()) {
    if (s.word("surface") != "screen")
      s.refuse_at("surface", "'" + s.word("surface") + "'", "\"screen\", or a plane [nx, ny, nz, d]");
    if (!tracked) return {0.0, 0.0, 1.0, 0.0};
    if (screens.empty()) s.refuse_at("surface", "\"screen\" without a screen", "a [screen] with its corners");
    const Vec3 n = axes(screens.front().corners)[2];
    return {n, glm::dot(n, center(screens.front().corners))};
  }
  const auto x = s.numbers(s.at("surface"), 4);
  const double length = glm::length(Vec3{x[0], x[1], x[2]});
  if (!(length > 0.0)) s.refuse_at("surface", "a normal without length", "a plane [nx, ny, nz, d]");
  return Vec4{x[0], x[1], x[2], x[3]} / length;
}

InteractionGeometry interaction_of(const WorkbenchSection& s, const std::vector<ScreenGeometry>& screens) {
  InteractionGeometry out;
  if (s.has("technique")) {
    const std::string technique = s.at("technique").value<std::string>().value_or("");
    out.immersive = technique == "immersive";
    if (!out.immersive && technique != "desktop")
      s.refuse_at("technique", "'" + technique + "'", "\"desktop\" or \"immersive\"");
  }
  if (out.immersive || s.has("middle")) out.middle = s.vector("middle");
  if (s.has("rotation")) out.rotation = s.rotation();
  if (s.has("gain")) out.gain = s.number("gain");
  if (!(out.gain > 0.0)) s.refuse_at("gain", short_number(out.gain), "a number above zero");
  const std::array<std::pair<const char*, int*>, 3> stations{{{"stylus_station", &out.stylus_station},
                                                              {"hand_station", &out.hand_station},
                                                              {"head_station", &out.head_station}}};
  for (const auto& [key, station] : stations) {
    if (!s.has(key)) continue;
    const std::int64_t said = s.at(key).value_exact<std::int64_t>().value_or(-1);
    if (said < 1 || said > InteractionGeometry::kStations)
      s.refuse_at(key, "another value", "a station of the tracker, from 1 to 16");
    *station = static_cast<int>(said);
  }
  // Two things on one sensor would move as one.
  for (const auto& [key, station] : stations) {
    for (const auto& [other, its] : stations) {
      if (key != other && *station == *its && s.has(key))
        s.refuse_at(key, "station " + std::to_string(*station) + ", which is " + other, "another station");
    }
  }
  if (s.has("enabling_button")) {
    constexpr std::int64_t kMost = InteractionGeometry::kButtons - 1;
    const toml::node& said = s.at("enabling_button");
    const std::int64_t button = said.value_exact<std::int64_t>().value_or(-1);
    const bool none = said.value_exact<std::string>() == "none";
    if (!none && (button < 0 || button > kMost))
      s.refuse_at("enabling_button", "another value", "a button from 0 to 31 or \"none\"");
    out.enabling_button = none ? InteractionGeometry::kNoButton : static_cast<int>(button);
  }
  if (s.has("enabling_device")) {
    out.enabling_device = s.at("enabling_device").value_exact<std::string>().value_or("");
    if (out.enabling_device.empty() || out.enabling_button == InteractionGeometry::kNoButton)
      s.refuse_at("enabling_device", "'" + out.enabling_device + "'",
                  "the name of a driver, with a button that is not \"none\"");
  }
  if (s.has("pick")) {
    const std::string by = s.word("pick");
    out.through_aperture = by == "aperture";
    if (!out.through_aperture && by != "ray") s.refuse_at("pick", "'" + by + "'", "\"ray\" or \"aperture\"");
  }
  if (s.has("aperture")) out.aperture = s.number("aperture");
  if (!(out.aperture > 0.0)) s.refuse_at("aperture", short_number(out.aperture), "a radius above zero");
  if (s.has("tip_offset")) out.tip_offset = s.vector("tip_offset");
  if (s.has("arm_rotation")) out.arm_rotation = s.rotation("arm_rotation");
  if (s.has("arm_middle")) out.arm_middle = s.vector("arm_middle");
  if (s.has("surface")) out.surface = surface_of(s, screens, out.immersive);
  return out;
}

/// Seconds, from 0 or above it to HeadGeometry::kLongest.
double seconds_of(const WorkbenchSection& s, const char* key, bool may_be_zero) {
  const double value = s.number(key);
  if (!(value >= 0.0 && value <= HeadGeometry::kLongest && (may_be_zero || value > 0.0)))
    s.refuse_at(key, short_number(value),
                std::string("seconds ") + (may_be_zero ? "from 0" : "above 0, up") + " to " +
                    short_number(HeadGeometry::kLongest));
  return value;
}

HeadGeometry head_of(const WorkbenchSection& s) {
  HeadGeometry out;
  if (s.has("source")) {
    out.source = s.word("source");
    if (out.source.empty())
      s.refuse_at("source", "no word", "\"hands\", \"replay:FILE.csv\" or the name of a driver");
  }
  if (s.has("resting_eye")) out.resting_eye = s.vector("resting_eye");
  if (s.has("sensor_latency")) out.sensor_latency = seconds_of(s, "sensor_latency", true);
  if (s.has("display_latency")) out.display_latency = seconds_of(s, "display_latency", true);
  if (s.has("latency")) out.latency = seconds_of(s, "latency", true);
  if (s.has("predict")) {
    const auto said = s.at("predict").value_exact<bool>();
    if (!said) s.refuse_at("predict", "another value", "true or false");
    out.predict = *said;
  }
  if (s.has("velocity_window")) out.velocity_window = seconds_of(s, "velocity_window", false);
  if (s.has("freeze")) out.freeze = seconds_of(s, "freeze", true);
  if (s.has("glide")) out.glide = seconds_of(s, "glide", true);
  return out;
}

/// Two whole numbers of a size that screens have.
std::array<int, 2> pixel_pair(const WorkbenchSection& s, const char* key, double least) {
  const auto given = s.numbers(s.at(key), 2);
  constexpr double kMost = 65536.0;
  std::array<int, 2> out{};
  for (std::size_t i = 0; i < 2; ++i) {
    if (!(given[i] >= least && given[i] <= kMost && given[i] == std::floor(given[i])))
      s.refuse_at(key, short_number(given[i]) + " pixels",
                  std::string("two whole numbers") + (least > 0.0 ? " above zero" : ""));
    out[i] = static_cast<int>(given[i]);
  }
  return out;
}

ScreenGeometry screen_of(const WorkbenchSection& s) {
  ScreenGeometry out{.corners = {s.vector("lower_left"), s.vector("lower_right"), s.vector("upper_left")},
                     .name = {}};
  if (const std::string fault = fault_of(out.corners); !fault.empty())
    s.refuse_at("lower_left", fault, "three corners of a rectangle, in metres");
  if (s.has("name")) {
    out.name = s.word("name");
    // It is part of file names, and 'all' means all of them.
    if (out.name.empty() || out.name == "all" || out.name.find('/') != std::string::npos)
      s.refuse_at("name", "'" + out.name + "'", "a word other than \"all\", without '/'");
  }
  if (s.has("pixels")) out.pixels = pixel_pair(s, "pixels", 1.0);
  if (s.has("position")) out.position = pixel_pair(s, "position", -65536.0);
  if (s.has("stereo")) {
    const std::string mode = s.word("stereo");
    const auto* const found = std::find(kStereoModeNames.begin(), kStereoModeNames.end(), mode);
    if (found == kStereoModeNames.end()) {
      std::string known;
      for (const std::string_view name : kStereoModeNames)
        known += (known.empty() ? "" : ", ") + std::string(name);
      s.refuse_at("stereo", "'" + mode + "'", known);
    }
    out.stereo = static_cast<StereoMode>(found - kStereoModeNames.begin());
  }
  return out;
}

TrackerCorrection tracker_of(const WorkbenchSection& s) {
  TrackerCorrection out;
  if (s.has("degree")) {
    const double degree = s.number("degree");
    if (degree != std::floor(degree) || degree < 0.0 || degree > kMaxDegree)
      s.refuse_at("degree", short_number(degree), "0 to " + std::to_string(kMaxDegree));
    if (!(s.number("scale") > 0.0)) s.refuse_at("scale", "not positive", "a length");
    const auto r = static_cast<int>(degree);
    const auto terms = as_size(term_count(r));
    out.position = {r, s.vector("center"), s.number("scale"), s.vectors("position", terms)};
    out.orientation = {r, s.vector("center"), s.number("scale"), s.vectors("orientation", terms)};
  }
  if (s.has("table_count")) {
    const Vec3 count = s.vector("table_count");
    constexpr double kMostNodes = 1000.0;
    for (int axis = 0; axis < 3; ++axis) {
      if (!(count[axis] >= 2.0 && count[axis] <= kMostNodes && count[axis] == std::floor(count[axis])))
        s.refuse_at("table_count", short_number(count[axis]) + " nodes", "2 to 1000 along each axis");
      if (!(s.vector("table_spacing")[axis] > 0.0)) s.refuse_at("table_spacing", "not positive", "lengths");
    }
    out.table = {s.vector("table_lower"), s.vector("table_spacing"), Index3(count), {}};
    const std::size_t nodes = count_of(out.table.count);
    const auto position = s.vectors("table_position", nodes), turn = s.vectors("table_orientation", nodes);
    for (std::size_t i = 0; i < nodes; ++i) out.table.values.push_back({position[i], turn[i]});
  }
  return out;
}

DhhChain arm_of(const WorkbenchSection& s) {
  DhhChain out;
  for (const toml::node& node : s.array("rows")) {
    const auto numbers = s.numbers(node, kDhhQuantities + 1);
    DhhRow row;
    std::copy_n(numbers.begin(), kDhhQuantities, row.values.begin());
    constexpr double kMostJoints = 32.0;
    const double joint = numbers.back();
    if (!(joint >= 0.0 && joint <= kMostJoints && joint == std::floor(joint)))
      s.refuse_at("rows", "joint " + short_number(joint), "0 for none, or its number");
    row.joint = static_cast<int>(joint) - 1;
    out.joint_count = std::max(out.joint_count, row.joint + 1);
    out.rows.push_back(row);
  }
  if (!s.has("free")) return out;
  const toml::array& free = s.array("free");
  if (free.size() != out.rows.size())
    s.refuse_at("free", std::to_string(free.size()) + " entries", std::to_string(out.rows.size()));
  for (std::size_t row = 0; row < free.size(); ++row) {
    std::istringstream words(free[row].value_or(std::string("?")));
    for (std::string word; words >> word;) {
      bool found = false;
      for (int q = 0; q < kDhhQuantities; ++q) {
        const std::string name = dhh_name(0, static_cast<DhhQuantity>(q));
        if (name.substr(0, name.size() - 1) != word) continue;
        out.rows[row].free[as_size(q)] = found = true;
      }
      if (!found) s.refuse_at("free", "'" + word + "'", "d, a, alpha, beta or gamma");
    }
  }
  return out;
}

}  // namespace

WorkbenchGeometry read_workbench(const std::filesystem::path& path) {
  const toml::table root = parsed_workbench(workbench_text(path), path);
  const auto section = [&](const char* name, std::initializer_list<const char*> known, const auto& read) {
    const toml::node* node = root.get(name);
    if (!node) return;
    const toml::table* table = node->as_table();
    if (!table)
      refuse(path, line_of(*node), std::string("'") + name + "' is no section",
             std::string("[") + name + "]");
    read(WorkbenchSection(*table, name, path, known));
  };
  WorkbenchGeometry out;
  section("tracker",
          {"degree", "center", "scale", "position", "orientation", "table_count", "table_lower",
           "table_spacing", "table_position", "table_orientation"},
          [&](const WorkbenchSection& s) { out.tracker = tracker_of(s); });
  section("apparatus", {"rotation", "translation", "markers"}, [&](const WorkbenchSection& s) {
    out.apparatus = {s.motion(), s.all_vectors("markers", true)};
  });
  section("arm", {"rows", "free"}, [&](const WorkbenchSection& s) { out.arm = arm_of(s); });
  section("coregistration", {"rotation", "translation", "sensor"}, [&](const WorkbenchSection& s) {
    out.coregistration = {s.motion(), s.vector("sensor")};
  });
  section("stylus", {"tip"}, [&](const WorkbenchSection& s) { out.stylus = s.vector("tip"); });
  section("eyes", {"left", "right"}, [&](const WorkbenchSection& s) {
    out.eyes.emplace();
    if (s.has("left")) out.eyes->left = s.vector("left");
    if (s.has("right")) out.eyes->right = s.vector("right");
  });
  const auto add_screen = [&](const toml::table& table) {
    ScreenGeometry screen = screen_of(WorkbenchSection(
        table, "screen", path,
        {"lower_left", "lower_right", "upper_left", "name", "pixels", "position", "stereo"}));
    const bool twice = std::any_of(out.screens.begin(), out.screens.end(), [&](const ScreenGeometry& other) {
      return !screen.name.empty() && other.name == screen.name;
    });
    if (twice)
      refuse(path, line_of(table), "a second screen with the name '" + screen.name + "'",
             "names that differ");
    out.screens.push_back(std::move(screen));
  };
  if (const toml::node* node = root.get("screen")) {
    const toml::array* several = node->as_array();
    if (const toml::table* one = node->as_table()) {
      add_screen(*one);
    } else if (several && several->is_array_of_tables()) {
      for (const toml::node& each : *several) add_screen(*each.as_table());
    } else {
      refuse(path, line_of(*node), "'screen' is no section", "[screen], or [[screen]] for each of several");
    }
  }
  out.device_options = device_options_of(root, path);
  out.tuned = tuned_of(root, path);
  section("head",
          {"source", "resting_eye", "sensor_latency", "display_latency", "latency", "predict",
           "velocity_window", "freeze", "glide"},
          [&](const WorkbenchSection& s) { out.head = head_of(s); });
  section("interaction",
          {"technique", "middle", "rotation", "gain", "stylus_station", "hand_station", "head_station",
           "enabling_button", "enabling_device", "tip_offset", "surface", "arm_rotation", "arm_middle",
           "pick", "aperture"},
          [&](const WorkbenchSection& s) { out.interaction = interaction_of(s, out.screens); });
  return out;
}

Rigid device_from_arm(const WorkbenchGeometry& geometry) {
  PALPATE_CHECK(geometry.arm.has_value());
  const std::vector<double> zeros(as_size(geometry.arm->joint_count), 0.0);
  const Vec3 middle = geometry.interaction.arm_middle.value_or(geometry.arm->forward(zeros).translation);
  const Quat& turn = geometry.interaction.arm_rotation;
  return {turn, -(turn * middle)};
}

}  // namespace palpate
