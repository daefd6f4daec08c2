// netCDF by the CF conventions: fields and times beyond the single cells of flow_matrix_test, what numbers stand for, and damaged
// files.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/load/load.h"
#include "tests/loaders/hdf5_file.h"
#include "tests/support/refusal.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

bool says(const std::vector<std::string>& notes, const std::string& words) {
  for (const std::string& note : notes) {
    if (note.find(words) != std::string::npos) return true;
  }
  return false;
}

/// A classic file ("The NetCDF Classic Format Specification"), version 1. Dimensions and variables in their order.
class ClassicFile {
 public:
  struct Variable {
    std::string name;
    std::vector<std::uint32_t> dimensions;
    std::vector<std::pair<std::string, std::string>> words;  ///< attributes
    std::vector<double> values;
    std::vector<std::pair<std::string, double>> numbers = {};
    bool is_short = false;     ///< 16 bits, else double
    bool real_limits = false;  ///< attributes of shorts are doubles
    bool is_byte = false;      ///< 8 bits
    std::size_t repeats = 1;   ///< how often a number stands in an attribute of doubles
  };
  std::vector<std::pair<std::string, std::uint32_t>> dimensions;
  std::vector<Variable> variables;

  [[nodiscard]] std::string bytes() const {
    std::string head = header(std::vector<std::uint32_t>(variables.size(), 0));
    std::vector<std::uint32_t> begins;
    std::size_t at = head.size();
    for (const Variable& v : variables) {
      begins.push_back(static_cast<std::uint32_t>(at));
      at += size_of(v);
    }
    std::string out = header(begins);
    for (const Variable& v : variables) {
      const std::size_t end = out.size() + size_of(v);
      for (const double value : v.values)
        out += v.is_byte    ? raw(static_cast<std::int8_t>(value), true)
               : v.is_short ? raw(static_cast<std::int16_t>(value), true)
                            : raw(value, true);
      out.resize(end);
    }
    return out;
  }

 private:
  static std::size_t size_of(const Variable& v) {
    return v.is_byte    ? (v.values.size() + 3) / 4 * 4
           : v.is_short ? (2 * v.values.size() + 3) / 4 * 4
                        : 8 * v.values.size();
  }
  static std::string number(std::size_t value) { return raw(static_cast<std::uint32_t>(value), true); }
  static std::string name_of(const std::string& name) {
    return number(name.size()) + name + std::string((4 - name.size() % 4) % 4, '\0');
  }
  [[nodiscard]] std::string header(const std::vector<std::uint32_t>& begins) const {
    constexpr std::size_t kDimension = 10, kVariable = 11, kAttribute = 12, kByte = 1, kChar = 2, kShort = 3,
                          kDouble = 6;
    std::string out = std::string("CDF\1", 4) + number(0) + number(kDimension) + number(dimensions.size());
    for (const auto& [name, length] : dimensions) out += name_of(name) + number(length);
    out += number(0) + number(0) + number(kVariable) + number(variables.size());
    for (std::size_t v = 0; v < variables.size(); ++v) {
      const Variable& variable = variables[v];
      out += name_of(variable.name) + number(variable.dimensions.size());
      for (const std::uint32_t d : variable.dimensions) out += number(d);
      const std::size_t attributes = variable.words.size() + variable.numbers.size();
      out += number(attributes > 0 ? kAttribute : 0) + number(attributes);
      for (const auto& [name, text] : variable.words) out += name_of(name) + number(kChar) + name_of(text);
      for (const auto& [name, value] : variable.numbers) {
        const bool packed =
            variable.is_short && !variable.real_limits && name != "scale_factor" && name != "add_offset";
        out += name_of(name) + number(packed ? kShort : kDouble) + number(packed ? 1 : variable.repeats);
        if (packed) out += raw(static_cast<std::int16_t>(value), true) + std::string(2, '\0');
        for (std::size_t i = 0; !packed && i < variable.repeats; ++i) out += raw(value, true);
      }
      out += number(variable.is_byte    ? kByte
                    : variable.is_short ? kShort
                                        : kDouble) +
             number(size_of(variable)) + number(begins[v]);
    }
    return out;
  }
};

/// u, v, w at two times along x, y, z, and depth along x and y alone. @param units of x and y.
ClassicFile ocean(const std::string& units) {
  ClassicFile file;
  file.dimensions = {{"time", 2}, {"z", kNz}, {"y", kNy}, {"x", kNx}};
  file.variables = {{"time", {0}, {{"units", "seconds since 2000-01-01"}}, {10.0, 20.0}},
                    {"z", {1}, {{"units", "m"}, {"axis", "Z"}}, {0.0, 2.0}},
                    {"y", {2}, {{"units", units}}, {0.0, 1.0, 2.0}},
                    {"x", {3}, {{"units", units}}, {0.0, 0.5, 1.5, 2.0}}};
  for (int axis = 0; axis < 3; ++axis) {
    ClassicFile::Variable variable{
        std::string(1, "uvw"[axis]), {0, 1, 2, 3}, {}, {}, {{"_FillValue", -999.0}}};
    for (int t = 0; t < 2; ++t) {
      for (const Vec3& x : lattice()) variable.values.push_back(flow_at(x)[axis] + 100.0 * t);
    }
    if (axis == 0) variable.values[5] = -999.0;
    file.variables.push_back(variable);
  }
  file.variables.push_back({"depth", {2, 3}, {}, std::vector<double>(kNx * kNy, 5.0)});
  return file;
}

TEST(Netcdf, GridsWithTimesAreRead) {
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.nc", ocean("m").bytes())}, {}});
  EXPECT_EQ(source.info().times, (std::vector<double>{10.0, 20.0}));
  EXPECT_TRUE(says(source.info().notes, "'depth'"));
  EXPECT_FALSE(says(source.info().notes, "WARNING"));
  for (std::size_t step = 0; step < 2; ++step) {
    const auto blocks = source.read({"u", "v", "w"}, step);
    const auto* const grid = std::get_if<RectilinearTopology>(&blocks.at(0).topology);
    ASSERT_NE(grid, nullptr);
    EXPECT_EQ(grid->coordinates[0], (std::vector<double>{0.0, 0.5, 1.5, 2.0}));
    const DataArray* const u = blocks[0].find("u", Association::kPoint);
    const DataArray* const w = blocks[0].find("w", Association::kPoint);
    ASSERT_TRUE(u != nullptr && w != nullptr);
    const std::vector<Vec3> nodes = lattice();
    for (std::size_t p = 0; p < nodes.size(); ++p) {
      EXPECT_EQ(w->at(p), flow_at(nodes[p]).z + 100.0 * static_cast<double>(step));
      if (p == 5 && step == 0) {
        EXPECT_TRUE(std::isnan(u->at(p))) << "a fill value is no value";
      } else {
        EXPECT_EQ(u->at(p), flow_at(nodes[p]).x + 100.0 * static_cast<double>(step));
      }
    }
  }
  EXPECT_EQ(source.read({}).at(0).point_count(), lattice().size()) << "the grid alone";
}

// What stands for no value is none, packed or not, however the file says so; and whole numbers may be stored as if they
// had a sign.
TEST(Netcdf, WhatStandsForNoValueIsNone) {
  struct Kind {
    std::string name;
    std::vector<std::pair<std::string, double>> numbers;
    double stored;  ///< at one place
    bool is_short;
    bool none = true;
    bool real_limits = false;
  };
  constexpr double kNeverShort = -32767.0, kNeverDouble = 9.9692099683868690e+36;
  const std::vector<Kind> kinds{
      {"fill of packed", {{"scale_factor", 0.5}, {"add_offset", 2.0}, {"_FillValue", -300.0}}, -300.0, true},
      {"fill of shorts", {{"_FillValue", -300.0}}, -300.0, true},
      {"missing", {{"missing_value", 1e20}}, 1e20, false},
      {"missing of packed", {{"scale_factor", 0.5}, {"missing_value", -300.0}}, -300.0, true},
      {"missing with offset alone", {{"add_offset", 2.0}, {"missing_value", -300.0}}, -300.0, true},
      {"beyond valid_max", {{"scale_factor", 0.5}, {"valid_max", 200.0}}, 201.0, true},
      {"below valid_min", {{"valid_min", -50.0}}, -50.5, false},
      {"never written", {}, kNeverShort, true},
      {"never written doubles", {}, kNeverDouble, false},
      {"a value", {{"scale_factor", 0.5}, {"valid_max", 201.0}, {"_FillValue", -300.0}}, 201.0, true, false},
      {"beyond what is meant", {{"scale_factor", 0.01}, {"valid_max", 0.5}}, 51.0, true, true, true},
      {"within what is meant", {{"scale_factor", 0.01}, {"valid_max", 0.5}}, 50.0, true, false, true},
      {"missing as it is meant",
       {{"scale_factor", 0.5}, {"missing_value", -150.0}},
       -300.0,
       true,
       true,
       true},
      {"a limit of a falling scale", {{"scale_factor", -0.01}, {"valid_min", -0.5}}, 51.0, true, true, true},
      {"zero is no fill", {{"_FillValue", -999.0}}, 0.0, false, false},
  };
  const TempFolder folder;
  for (const Kind& kind : kinds) {
    ClassicFile file = ocean("m");
    double scale = 1.0, offset = 0.0;
    for (const auto& [name, value] : kind.numbers) {
      if (name == "scale_factor") scale = value;
      if (name == "add_offset") offset = value;
    }
    for (ClassicFile::Variable& variable : file.variables) {
      if (variable.name != "u") continue;
      variable.numbers = kind.numbers;
      variable.is_short = kind.is_short;
      variable.real_limits = kind.real_limits;
      for (std::size_t i = 0; i < variable.values.size(); ++i) variable.values[i] = static_cast<double>(i);
      variable.values[7] = kind.stored;
    }
    Source source = Source::open({{folder.write("a.nc", file.bytes())}, {}});
    const auto blocks = source.read({"u"});
    const DataArray* const u = blocks.at(0).find("u", Association::kPoint);
    ASSERT_NE(u, nullptr) << kind.name;
    for (std::size_t p = 0; p < lattice().size(); ++p) {
      if (p == 7 && kind.none) {
        EXPECT_TRUE(std::isnan(u->at(p))) << kind.name << ": " << u->at(p);
      } else {
        const double stored = p == 7 ? kind.stored : static_cast<double>(p);
        EXPECT_DOUBLE_EQ(u->at(p), scale * stored + offset) << kind.name << " at " << p;
      }
    }
  }
}

TEST(Netcdf, NumbersWithoutASignAreNotNegative) {
  ClassicFile file = ocean("m");
  for (ClassicFile::Variable& variable : file.variables) {
    if (variable.name != "u") continue;
    variable.words = {{"_Unsigned", "true"}};
    variable.numbers = {{"scale_factor", 0.5}, {"_FillValue", -1.0}};
    variable.is_short = true;
    variable.values[0] = -2.0;  // 65534
    variable.values[1] = -1.0;  // 65535, the fill value
    variable.values[2] = 40.0;
  }
  const TempFolder folder;
  Source source = Source::open({{folder.write("a.nc", file.bytes())}, {}});
  const auto blocks = source.read({"u"});
  const DataArray* const u = blocks.at(0).find("u", Association::kPoint);
  ASSERT_NE(u, nullptr);
  EXPECT_EQ(u->at(0), 32767.0);
  EXPECT_TRUE(std::isnan(u->at(1)));
  EXPECT_EQ(u->at(2), 20.0);
}

// VTK's reader takes bytes for numbers without a sign.
TEST(Netcdf, BytesHaveASignUnlessTheySayOtherwise) {
  for (const bool has_sign : {true, false}) {
    ClassicFile file = ocean("m");
    for (ClassicFile::Variable& variable : file.variables) {
      if (variable.name != "u") continue;
      if (!has_sign) variable.words = {{"_Unsigned", "true"}};
      variable.numbers = {{"scale_factor", 0.5}, {"add_offset", 3.0}};
      variable.is_byte = true;
      for (std::size_t i = 0; i < variable.values.size(); ++i) variable.values[i] = 40.0;
      variable.values[0] = -2.0;
      variable.values[1] = -128.0;
    }
    const TempFolder folder;
    Source source = Source::open({{folder.write("a.nc", file.bytes())}, {}});
    const auto blocks = source.read({"u"});
    const DataArray* const u = blocks.at(0).find("u", Association::kPoint);
    ASSERT_NE(u, nullptr);
    EXPECT_EQ(u->at(0), has_sign ? 2.0 : 130.0);
    EXPECT_EQ(u->at(1), has_sign ? -61.0 : 67.0);
    EXPECT_EQ(u->at(2), 23.0);
  }
}

// An axis that has a variable and no place ends VTK's reader.
TEST(Netcdf, AxesWithoutPlacesAreRefused) {
  ClassicFile file = ocean("m");
  const std::string name = file.dimensions[0].first;
  file.dimensions[0].second = 0;  // of records, of which there are none, and which stand behind the rest
  std::stable_partition(file.variables.begin(), file.variables.end(),
                        [](const ClassicFile::Variable& v) { return v.dimensions.front() != 0; });
  const TempFolder folder;
  const std::string why = refusal(folder.write("a.nc", file.bytes()));
  EXPECT_NE(why.find("no place along '" + name + "'"), std::string::npos) << why;
}

TEST(Netcdf, DegreesAndDaysAreWarnedOf) {
  const TempFolder folder;
  ClassicFile file = ocean("degrees_north");
  file.variables[0].words[0].second = "days since 2000-01-01";
  Source source = Source::open({{folder.write("a.nc", file.bytes())}, {}});
  EXPECT_TRUE(says(source.info().notes, "in degrees"));
  EXPECT_TRUE(says(source.info().notes, "days since"));
}

TEST(Netcdf, MeshesAreNamed) {
  const TempFolder folder;
  ClassicFile file = ocean("m");
  // Its topology far behind what is looked at to tell formats apart.
  constexpr std::size_t kFar = 100000;
  file.variables[4].words = {{"history", std::string(kFar, 'x')}};
  file.variables.push_back({"mesh", {0}, {{"cf_role", "mesh_topology"}}, {0.0, 0.0}});
  for (const bool far : {true, false}) {
    if (!far) file.variables[4].words.clear();
    const std::string why = refusal(folder.write("mesh.nc", file.bytes()));
    EXPECT_NE(why.find("UGRID"), std::string::npos) << why;
    EXPECT_NE(why.find("ParaView"), std::string::npos) << why;
  }
}

TEST(Netcdf, DamagedFilesAreRefused) {
  const TempFolder folder;
  std::string cut = ocean("m").bytes();
  cut.resize(cut.size() - 40);
  EXPECT_NE(refusal(folder.write("cut.nc", cut)).find("does not fit"), std::string::npos);
  ClassicFile flat;
  flat.dimensions = {{"y", 3}, {"x", 4}};
  flat.variables = {{"a", {0, 1}, {}, std::vector<double>(12, 1.0)}};
  EXPECT_NE(refusal(folder.write("flat.nc", flat.bytes())).find("three axes"), std::string::npos);
  ClassicFile endless = ocean("m");
  endless.dimensions.emplace_back("far", 2013265920);
  // Libraries have room for 256 bytes of a name, and for one number of a scale.
  ClassicFile long_name = ocean("m"), scales = ocean("m");
  long_name.dimensions[1].first = std::string(300, 'z');
  EXPECT_NE(refusal(folder.write("name.nc", long_name.bytes())).find("a name of 300 bytes"),
            std::string::npos);
  scales.variables[4].numbers = {{"scale_factor", 0.5}};
  scales.variables[4].repeats = 900;
  EXPECT_NE(refusal(folder.write("scales.nc", scales.bytes()))
                .find("has 900 numbers in the attribute scale_factor of 'u'"),
            std::string::npos);
  EXPECT_NE(refusal(folder.write("endless.nc", endless.bytes())).find("an axis 'far' of 2013265920 places"),
            std::string::npos);
}

TEST(Netcdf, WhatTimeIsNotToldFromIsSaid) {
  const TempFolder folder;
  ClassicFile file = ocean("m");
  file.variables[0].words.clear();
  const std::string why = refusal(folder.write("a.nc", file.bytes()));
  EXPECT_NE(why.find("'time', the first axis of 'u', is time"), std::string::npos) << why;
  EXPECT_NE(why.find("ncatted -a units,time,c,c,s"), std::string::npos) << why;
  file.variables[0].words = {{"units", "s"}};
  EXPECT_EQ(Source::open({{folder.write("b.nc", file.bytes())}, {}}).info().times,
            (std::vector<double>{10.0, 20.0}));
}

}  // namespace
}  // namespace palpate::test
