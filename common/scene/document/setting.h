/// Settings: the one description of each value of a document.
///
/// A row says what a setting is called, where its value stands, what it may be, and who has it. From the rows
/// come the options of the command line and their help, sessions, the settings that JSON objects repeat,
/// labels and ranges of panels, equality of documents, and the reference page.
///
///   name      of the option without dashes, and of the key in a session
///   text      a value as options and sessions have it: numbers with as few digits as give the same number
///             back, "on" or "off", the values of a list with ';' between; empty: none
#pragma once

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/base/enum_set.h"
#include "common/scene/document/document.h"
#include "common/scene/document/field_kind.h"

namespace palpate {

/// Settings that a verb takes together.
enum class Group : std::uint8_t {
  kCommon,
  kInput,        ///< FILE, and how it is read
  kLines,        ///< seeds and limits of streamlines, fibres or tracts
  kLayer,        ///< which layer of a heart
  kAngle,        ///< which angle of its fibres
  kContours,     ///< lines of equal value on a layer, which are written
  kSurfaces,     ///< the surfaces of a wall, which are written
  kCoordinates,  ///< the coordinates of a wall, which are written
  kRule,         ///< a rule by which fibres are made
  kMeshPicture,  ///< a picture of a made mesh
  kSeries,       ///< which scalar over time, and where
  kPlot,         ///< which scalar is plotted at the probe
  kView,         ///< how the scene is drawn
  kTouch,        ///< what the hand feels
  kPath,         ///< a recorded path of the probe
  kHand,         ///< a simulated hand on that path
  kRecord,       ///< devices of a window, and recording them
  kReplay,       ///< a recording that is played back
  kNotes,        ///< annotations
  kOut,          ///< a file that is written
  kPicture,      ///< size and timing of a picture
  kReport,       ///< the folder of a report, and how thorough it is
  kImage,        ///< order and axes of an image that is written
  kMeasure,      ///< which measure of tensors is written
  kPanes,        ///< slices beside a volume
  kPanesSize,    ///< size of a picture of such slices
  kSlice,        ///< which slice is written
  kPart,         ///< a part of a volume
  kVoxelType,    ///< type of voxels that are written
  kFocal,        ///< where a view that a hand moves turns about
  kTurn,         ///< tracts that are compared and turned
  kCalibrate,    ///< measurements, and how a model is fitted to them
  kMade,         ///< made measurements
  kHeadErrors,   ///< a head before a screen
  kWalls,        ///< whose walls are swept
  kSurvey,       ///< devices that are plugged in
  kCheck,        ///< how well a device is linked
  kReadOut,      ///< what a device tells
  kFeel,         ///< an effect that a device shows
  kTune,         ///< the stiffness that a device bears
  kMenu,         ///< a menu in space under a recorded hand
  kStudy         ///< an experiment with participants
};
using Groups = EnumSet<Group>;
using Kinds = EnumSet<FieldKind>;
inline constexpr Kinds kAllFields{FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor,
                                  FieldKind::kFibre};
inline constexpr Kinds kAllPrograms = kAllFields.with(FieldKind::kNone);

/// Where a value of type T stands in a document.
template <typename T>
using ValueAt = T& (*)(Document&);
using Place = std::variant<ValueAt<bool>, ValueAt<std::optional<bool>>, ValueAt<int>, ValueAt<std::int64_t>,
                           ValueAt<std::uint64_t>, ValueAt<double>, ValueAt<std::optional<double>>,
                           ValueAt<std::string>, ValueAt<std::filesystem::path>,
                           ValueAt<std::optional<std::filesystem::path>>, ValueAt<std::vector<std::string>>,
                           ValueAt<std::vector<std::filesystem::path>>>;

namespace detail {
template <auto... Members>
[[nodiscard]] constexpr auto& follow(Document& document) {
  return (document.*....*Members);
}
}  // namespace detail

/// The place that pointers to members lead to, one after the other.
template <auto... Members>
inline constexpr Place kAt{&detail::follow<Members...>};

/// Numbers that a setting may have.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool above = false;  ///< `lower` itself is not allowed

  [[nodiscard]] bool contains(double value) const noexcept {
    return (above ? value > lower : value >= lower) && value <= upper;
  }
  /// "from 0 to 1", "above 0"; empty where every number is allowed.
  [[nodiscard]] std::string text() const;
};
inline constexpr Range kNotNegative{.lower = 0.0};
inline constexpr Range kAboveZero{.lower = 0.0, .above = true};
inline constexpr Range kShare{.lower = 0.0, .upper = 1.0};

/// How the command line says a setting.
enum class Spelling : std::uint8_t {
  kOption,      ///< --name VALUE
  kFlag,        ///< --name
  kWords,       ///< each word but the default is a flag of its own
  kPositional,  ///< VALUE alone
  kNone         ///< not at all: a hand made it
};

struct Setting {
  std::string_view name = {};
  Place place = {};
  std::string_view help = {};     ///< a clause, without range and default
  std::string_view value = {};    ///< what stands for the value in the help, "MM"; empty: `words`
  std::string_view heading = {};  ///< under which the help lists it
  Groups groups = {};
  Kinds kinds = kAllFields;  ///< which programs have it
  std::string_view unit = {};
  Range range = {};                 ///< of numbers
  Range slider = {};                ///< that sliders reach; without ends: `range`
  bool log_slider = false;          ///< they go by the logarithm
  std::string_view words = {};      ///< those that a text may be, with '|' between; empty: any text
  std::string_view otherwise = {};  ///< what is taken where the default stands for a choice by the program
  std::string_view title = {};      ///< for panels; empty: the name, its dashes as blanks
  std::string_view alias = {};      ///< another spelling, with its dashes: "-o"
  Spelling spelling = Spelling::kOption;
  bool saved = true;       ///< by sessions
  bool recorded = false;   ///< a recording of the hand has it
  bool preferred = false;  ///< a window begins with what its user chose in the last one
  bool file = false;       ///< its text may name a file

  /// "Line width"
  [[nodiscard]] std::string label() const;
  /// "--line-width"; of one that stands alone "FILE"
  [[nodiscard]] std::string option() const;
  /// What stands for the value in the help.
  [[nodiscard]] std::string_view value_name() const noexcept { return value.empty() ? words : value; }
  /// The help with range and default.
  [[nodiscard]] std::string full_help() const;
  [[nodiscard]] std::vector<std::string_view> word_list() const;
  /// Whether it is a list.
  [[nodiscard]] bool several() const noexcept;
  /// Whether a verb of such a program that takes `groups` has it.
  [[nodiscard]] bool belongs(FieldKind kind, Groups taken) const noexcept {
    return kinds.has(kind) && groups.meets(taken);
  }
};

/// All rows of all tables, in the order of the help.
[[nodiscard]] const std::vector<Setting>& settings();

/// The row that sessions of programs of `kind` have under `name`; null: none.
[[nodiscard]] const Setting* find_setting(std::string_view name, FieldKind kind);
/// The first row of that name: all of one name that panels show have the same unit and range. @pre there is
/// one.
[[nodiscard]] const Setting& setting(std::string_view name);
/// The name of a setting in sessions of `kind` that is most like `name`.
[[nodiscard]] std::string_view nearest_setting(std::string_view name, FieldKind kind);

/// The value as text.
[[nodiscard]] std::string value_text(const Setting& setting, const Document& document);
/// Takes a value from text; a list from its parts. @throws Error (usage) that names the option and what it
/// takes.
void set_value(const Setting& setting, Document& document, std::string_view text);
/// Whether the value is that of a new document.
[[nodiscard]] bool is_default(const Setting& setting, const Document& document);
/// Of a new document, as text.
[[nodiscard]] std::string default_text(const Setting& setting);
[[nodiscard]] bool same_value(const Setting& setting, const Document& a, const Document& b);

}  // namespace palpate
