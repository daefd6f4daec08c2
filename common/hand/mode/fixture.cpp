#include "common/hand/mode/fixture.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/files/csv_reader.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/haptics/constraint/half_space.h"
#include "common/haptics/constraint/mesh_surface.h"
#include "common/haptics/constraint/shape.h"
#include "common/haptics/constraint/surface_friction.h"
#include "common/load/read_surface.h"
#include "common/load/read_tractogram.h"
#include "common/math/units.h"
#include "common/math/vec_text.h"

namespace palpate {
namespace {

using Links = std::vector<std::unique_ptr<Constraint>>;

constexpr std::string_view kFixtureGrammar =
    "a file of lines (.csv .vtp .trk .tck .trx) or of a surface (.stl .ply .obj .vtp), circle:x,y,z,nx,ny,nz,r, "
    "sphere:x,y,z,r, plane:nx,ny,nz,d, half-space:nx,ny,nz,d, magnet:x,y,z[,MM[,N]], well:x,y,z[,MM[,N]], forces:FILE.csv or mode";
constexpr std::size_t kMostPoints = 10'000'000;  // of the lines of a file

[[noreturn]] void refuse_fixture(const std::string& text, const std::string& why) {
  throw usage_error("--fixture " + text + ": " + why + "; expected is " + std::string(kFixtureGrammar));
}

/// The finite numbers behind the word, `least` to `most` of them; the rest is what `otherwise` has.
std::vector<double> fixture_numbers(const std::string& text, std::string_view rest, std::size_t least,
                                    std::vector<double> otherwise) {
  const std::vector<std::string_view> parts = split(rest, ',');
  if (parts.size() < least || parts.size() > otherwise.size())
    refuse_fixture(text, "found " + counted(parts.size(), "number"));
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const auto value = number(parts[i]);
    if (!value || !std::isfinite(*value))
      refuse_fixture(text, "'" + std::string(parts[i]) + "' is no number");
    otherwise[i] = *value;
  }
  return otherwise;
}

Vec3 fixture_direction(const std::string& text, const Vec3& n, double& length) {
  length = normal_length(n);
  if (!(length > 0.0) || !std::isfinite(length)) refuse_fixture(text, "a direction has no length");
  return n / length;
}

/// A shape by its numbers; nothing where the text names none.
std::optional<Fixture> shape_fixture(const std::string& text) {
  const std::size_t colon = text.find(':');
  const std::string_view word = std::string_view(text).substr(0, colon);
  if (colon == std::string::npos) return std::nullopt;
  const std::string_view rest = std::string_view(text).substr(colon + 1);
  Fixture made{.text = text};
  double length = 1.0;
  if (word == "circle") {
    const auto values = fixture_numbers(text, rest, 7, std::vector<double>(7));
    made.kind = Fixture::Kind::kCircle;
    made.at = vec_at(values, 0);
    made.normal = fixture_direction(text, vec_at(values, 3), length);
    made.radius = values[6];
  } else if (word == "sphere") {
    const auto values = fixture_numbers(text, rest, 4, std::vector<double>(4));
    made.kind = Fixture::Kind::kSphere;
    made.at = vec_at(values, 0);
    made.radius = values[3];
  } else if (word == "plane" || word == "half-space") {
    const auto values = fixture_numbers(text, rest, 4, std::vector<double>(4));
    made.kind = word == "plane" ? Fixture::Kind::kPlane : Fixture::Kind::kHalfSpace;
    made.normal = fixture_direction(text, vec_at(values, 0), length);
    made.at = (values[3] / length) * made.normal;
  } else if (word == "magnet" || word == "well") {
    const bool magnet = word == "magnet";
    const auto values = fixture_numbers(
        text, rest, 3, magnet ? std::vector{0.0, 0.0, 0.0, 5.0, 1.5} : std::vector{0.0, 0.0, 0.0, 50.0, 0.5});
    made.kind = Fixture::Kind::kLandmark;
    made.at = vec_at(values, 0);
    made.landmark = {.pull = magnet ? Landmark::Pull::kMagnet : Landmark::Pull::kWell,
                     .reach = kMetresPerMillimetre * values[3],
                     .force = values[4]};
    if (!(made.landmark.reach > 0.0)) refuse_fixture(text, "its reach is not above zero");
  } else {
    return std::nullopt;
  }
  const bool round = made.kind == Fixture::Kind::kCircle || made.kind == Fixture::Kind::kSphere;
  if (round && !(made.radius > 0.0)) refuse_fixture(text, "its radius is not above zero");
  return made;
}

std::vector<std::vector<Vec3>> table_of_lines(const std::string& file) {
  constexpr std::array<std::string_view, 3> kColumns{"x", "y", "z"};
  constexpr std::array<std::string_view, 1> kLineColumn{"line"};
  CsvReader table(file, kColumns, kLineColumn,
                  "a table of a line's points with the header x,y,z or x,y,z,line");
  std::vector<std::vector<Vec3>> lines;
  double before = 0.0;
  std::size_t points = 0;
  for (std::array<double, 4> row{}; table.next(row);) {
    const Vec3 x{row[0], row[1], row[2]};
    if (!is_finite(x)) table.refuse("holds a number that is not finite", "three finite numbers x,y,z");
    if (++points > kMostPoints) table.refuse("is one point too many", "at most 10 million points");
    const double line = std::isnan(row[3]) ? 0.0 : row[3];
    if (lines.empty() || line != before) lines.emplace_back();
    before = line;
    lines.back().push_back(x);
  }
  return lines;
}

class Fingerprint {
 public:
  void add(std::uint64_t word) noexcept {
    hash_ = (hash_ ^ word) * 0x100'0000'01b3U;
    hash_ ^= hash_ >> 29U;
  }
  void add(const Vec3& x) noexcept {
    for (int c = 0; c < 3; ++c) add(std::bit_cast<std::uint64_t>(x[c]));
  }
  [[nodiscard]] std::uint64_t value() const noexcept { return hash_; }

 private:
  std::uint64_t hash_ = 0x9e37'79b9'7f4a'7c15U;
};

std::uint64_t fingerprint_of(const std::vector<std::vector<Vec3>>& lines) noexcept {
  Fingerprint print;
  for (const auto& line : lines) {
    print.add(line.size());
    for (const Vec3& x : line) print.add(x);
  }
  return print.value();
}

void take_forces(Fixture& made, const std::string& file) {
  constexpr std::array<std::string_view, 4> kColumns{"t", "fx", "fy", "fz"};
  CsvReader table(file, kColumns, {}, "a table of forces over time with the header t,fx,fy,fz");
  std::vector<TimedForce> rows;
  Fingerprint print;
  for (std::array<double, 4> row{}; table.next(row);) {
    const TimedForce next{row[0], {row[1], row[2], row[3]}};
    if (!std::isfinite(next.time) || !is_finite(next.force))
      table.refuse("holds a number that is not finite", "four finite numbers t,fx,fy,fz");
    if (!rows.empty() && !(next.time > rows.back().time))
      table.refuse("is no later than the row before it", "rising times t in seconds");
    if (rows.size() >= kMostPoints) table.refuse("is one row too many", "at most 10 million rows");
    rows.push_back(next);
    print.add(std::bit_cast<std::uint64_t>(next.time));
    print.add(next.force);
  }
  if (rows.size() < 2) throw input_error({file, "", counted(rows.size(), "row"), "two rows at least", ""});
  made.kind = Fixture::Kind::kForces;
  made.fingerprint = print.value();
  made.forces = std::make_shared<const std::vector<TimedForce>>(std::move(rows));
}

void take_surface(Fixture& made, Progress* progress) {
  const SurfaceTriangles read = read_surface(made.text, progress);
  if (read.triangles.size() > SurfaceMesh::kMostTriangles)
    throw input_error({made.text, "", "has " + counted(read.triangles.size(), "triangle"),
                       "at most 50 million", "coarsen it"});
  made.kind = Fixture::Kind::kSurface;
  made.mesh = std::make_shared<const SurfaceMesh>(read.points, read.triangles);
  if (made.mesh->triangles().empty())
    throw input_error({made.text, "", "has no triangle with an area", "a surface", ""});
  made.fingerprint = made.mesh->fingerprint();
  for (const std::string& note : made.mesh->care().sentences()) made.notes.push_back(made.text + ": " + note);
}

void take_lines(Fixture& made, std::vector<std::vector<Vec3>> lines) {
  const auto short_of = [](const std::vector<Vec3>& line) {
    return std::all_of(line.begin(), line.end(), [&line](const Vec3& x) { return x == line.front(); });
  };
  const std::size_t all = lines.size();
  std::erase_if(lines, short_of);
  if (lines.empty()) throw input_error({made.text, "", "holds no line", "two points that differ", ""});
  if (lines.size() < all)
    made.notes.push_back(made.text + ": " + counted(all - lines.size(), "line") + " of one point left out");
  made.kind = Fixture::Kind::kLines;
  made.fingerprint = fingerprint_of(lines);
  made.lines = std::move(lines);
}

std::vector<std::vector<Vec3>> lines_of(const Tractogram& tracts) {
  std::vector<std::vector<Vec3>> lines(tracts.line_count());
  for (std::size_t l = 0; l < lines.size(); ++l) {
    for (std::size_t p = tracts.starts[l]; p < tracts.starts[l + 1]; ++p)
      lines[l].emplace_back(tracts.points[p]);
  }
  return lines;
}

void take_file(Fixture& made, Progress* progress) {
  const std::string ending = lowered(std::filesystem::path(made.text).extension().string());
  if (ending == ".csv") {
    take_lines(made, table_of_lines(made.text));
  } else if (names_surface(made.text)) {
    take_surface(made, progress);
  } else if (ending == ".trk" || ending == ".tck" || ending == ".trx") {
    take_lines(made, lines_of(read_tractogram(made.text, progress).lines));
  } else if (ending == ".vtp" || ending == ".vtk") {
    // Lines where it has some, else the surface that it holds.
    Source source = Source::open({.files = {made.text}, .solution = {}}, {}, progress);
    const std::vector<DataSet> blocks = source.read({}, 0, progress);
    std::vector<std::vector<Vec3>> lines = lines_of(pack_lines(blocks));
    std::erase_if(lines, [](const std::vector<Vec3>& line) { return line.size() < 2; });
    if (lines.empty()) {
      take_surface(made, progress);
    } else {
      take_lines(made, std::move(lines));
    }
  } else {
    refuse_fixture(made.text, "neither a file that is read here nor a shape");
  }
}

/// The link of a fixture, and its friction behind it.
void append_fixture(const Fixture& fixture, const Workspace& workspace, bool rubs, Links& links) {
  const auto at = workspace.workspace_from_data(fixture.at);
  const double radius = fixture.radius * workspace.scale();
  const auto touched = [&]<typename Surface>(std::unique_ptr<Surface> surface) {
    const TouchedSurface& rubbed = *surface;
    links.push_back(std::move(surface));
    if (rubs) links.push_back(std::make_unique<SurfaceFriction>(rubbed));
  };
  switch (fixture.kind) {
    case Fixture::Kind::kMode:
      break;
    case Fixture::Kind::kCircle:
      links.push_back(std::make_unique<CircleConstraint>(at, fixture.normal, radius));
      break;
    case Fixture::Kind::kSphere:
      touched(std::make_unique<SphereConstraint>(at, radius));
      break;
    case Fixture::Kind::kPlane:
      touched(std::make_unique<PlaneConstraint>(at, fixture.normal));
      break;
    case Fixture::Kind::kHalfSpace:
      touched(std::make_unique<HalfSpaceConstraint>(at, fixture.normal));
      break;
    case Fixture::Kind::kLandmark: {
      Landmark landmark = fixture.landmark;
      landmark.at = at;
      links.push_back(std::make_unique<LandmarkPull>(std::vector{landmark}));
      break;
    }
    case Fixture::Kind::kForces:
      links.push_back(std::make_unique<ForcePlayback>(fixture.forces));
      break;
    case Fixture::Kind::kLines: {
      std::vector<std::vector<Vec3>> lines = fixture.lines;
      for (auto& line : lines) {
        for (Vec3& x : line) x = workspace.workspace_from_data(x);
      }
      links.push_back(std::make_unique<PolylineConstraint>(lines, PolylineConstraint::Ends::kJoined));
      break;
    }
    case Fixture::Kind::kSurface:
      touched(std::make_unique<MeshConstraint>(fixture.mesh, workspace));
      break;
  }
}

[[noreturn]] void refuse_word(const std::string& what) {
  throw Error(ExitCode::kBadInput, "the recording's fixtures: " + what);
}

/// Without what parts words and entries: as %20.
std::string escaped(std::string_view text) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code > ' ' && c != '%' && c != ';' && c != '#' && code != 127) {
      out += c;
    } else {
      out += '%';
      out += kDigits[code >> 4U];
      out += kDigits[code & 15U];
    }
  }
  return out;
}

std::optional<std::string> unescaped(std::string_view text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '%') {
      out += text[i];
      continue;
    }
    unsigned code = 0;
    const std::string_view digits = text.substr(std::min(i + 1, text.size()), 2);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), code, 16);
    if (error != std::errc() || digits.size() != 2 || end != digits.data() + 2) return std::nullopt;
    out += static_cast<char>(code);
    i += 2;
  }
  return out;
}

}  // namespace

std::shared_ptr<const Fixture> read_fixture(const std::string& text, Progress* progress) {
  if (text == "mode") return std::make_shared<const Fixture>(Fixture{.text = text});
  if (auto shape = shape_fixture(text)) return std::make_shared<const Fixture>(*std::move(shape));
  Fixture made{.text = text};
  constexpr std::string_view kForces = "forces:";
  if (text.starts_with(kForces)) {
    take_forces(made, text.substr(kForces.size()));
  } else {
    take_file(made, progress);
  }
  return std::make_shared<const Fixture>(std::move(made));
}

FixtureList FixtureStore::list(const std::vector<std::string>& texts, Progress* progress) {
  const auto modes = std::count(texts.begin(), texts.end(), "mode");
  if (modes > 1) throw usage_error("--fixture mode: the mode stands once in the chain");
  if (texts.size() - as_size(modes) > kMost)
    throw usage_error("--fixture: at most " + std::to_string(kMost) + " beside the mode");
  FixtureList fixtures;
  std::map<std::string, std::shared_ptr<const Fixture>> wanted;
  for (const std::string& text : texts) {
    const auto known = known_.find(text);
    fixtures.push_back(known != known_.end() ? known->second : read_fixture(text, progress));
    wanted[text] = fixtures.back();
  }
  known_ = std::move(wanted);  // what is no longer felt is given back
  return fixtures;
}

void add_fixtures(ProxyChain& chain, const FixtureList& fixtures, const Workspace& workspace) {
  const bool rubs = chain.settings().contact.rubs();
  Links before, after;
  bool past_mode = false;
  for (const auto& fixture : fixtures) {
    if (fixture->kind == Fixture::Kind::kMode) {
      past_mode = true;
    } else {
      append_fixture(*fixture, workspace, rubs, past_mode ? after : before);
    }
  }
  if (!before.empty() || !after.empty()) chain.surround(std::move(before), std::move(after));
}

std::string fixture_word(const FixtureList& fixtures) {
  std::string word;
  for (const auto& fixture : fixtures) {
    (word += word.empty() ? "" : ";") += escaped(fixture->text);
    if (fixture->fingerprint != 0) word += "#" + std::to_string(fixture->fingerprint);
  }
  return word;
}

FixtureList fixtures_of_word(const std::string& word, FixtureStore& store, Progress* progress) {
  std::vector<std::string> texts;
  std::vector<std::uint64_t> prints;
  for (const std::string_view entry : split(word, ';')) {
    const std::size_t mark = entry.find('#');
    const auto text = unescaped(entry.substr(0, mark));
    const auto print = mark == std::string_view::npos ? std::optional<std::uint64_t>(0)
                                                      : parsed<std::uint64_t>(entry.substr(mark + 1));
    if (!text || text->empty() || !print) refuse_word("'" + std::string(entry) + "' cannot be read");
    texts.push_back(*text);
    prints.push_back(*print);
  }
  FixtureList fixtures = store.list(texts, progress);
  for (std::size_t i = 0; i < fixtures.size(); ++i) {
    if (fixtures[i]->fingerprint != prints[i])
      refuse_word(texts[i] + " does not hold what it held when the run was recorded");
  }
  return fixtures;
}

}  // namespace palpate
