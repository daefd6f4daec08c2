// Surfaces of the wall, its coordinates and fibres by a rule, as a user asks for them: on the built-in ventricle,
// whose areas and angles are known, and on its mesh without fibres.

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>

#include "tests/e2e/explorer_test.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kFocus = 40.0, kInner = 0.5, kOuter = 0.8, kBase = 1.9;  // of the ventricle [mm, rad]

template <typename Function>
double integral(double from, double to, const Function& f) {
  constexpr int kParts = 400;
  double sum = 0.0;
  for (int i = 0; i < kParts; ++i) {
    const double a = from + (to - from) * i / kParts, b = from + (to - from) * (i + 1) / kParts;
    sum += (b - a) / 6.0 * (f(a) + 4.0 * f(0.5 * (a + b)) + f(b));
  }
  return sum;
}

/// Of the surfaces of the ventricle: h_mu = h_lambda = f sqrt(sinh^2 lambda + sin^2 mu), h_theta = f sinh lambda
/// sin mu.
double element(double lambda, double mu) {
  return 2.0 * kPi * kFocus * kFocus * std::hypot(std::sinh(lambda), std::sin(mu)) * std::sinh(lambda) *
         std::sin(mu);
}

class CardiacRule : public ExplorerTest {
 protected:
  CardiacRule() : ExplorerTest("cardiac") {}

  /// The ventricle's mesh in openCARP's files, without fibres.
  void write_bare() {
    (void)json({"convert", "--example", "ventricle", "--out", "bare.pts"});
    std::filesystem::remove(folder_.path("bare.lon"));
  }
  static Json part(const Json& info, const std::string& name) {
    for (const Json& each : info["surfaces"]["parts"])
      if (each["name"] == name) return each;
    return {};
  }
  static Json column(const Json& map, const std::string& name) {
    for (const Json& each : map["coordinates"])
      if (each["name"] == name) return each;
    return {};
  }
  static double mean_at(const Json& map, double depth) {
    for (const Json& band : map["bands"])
      if (std::abs(band["depth"].get<double>() - depth) < 1e-6) return band["mean"].get<double>();
    return std::nan("");
  }
};

TEST_F(CardiacRule, ShowsTheSurfacesThatWereFound) {
  write_bare();
  for (const bool bare : {false, true}) {
    const std::string out = bare ? "bare.vtp" : "tagged.vtp";
    const Json info = bare ? json({"info", "bare.pts", "--surfaces", out})
                           : json({"info", "--example", "ventricle", "--surfaces", out});
    constexpr double kChords = 3e-3;  // of edges of 3 degrees
    const auto near = [&](const std::string& name, double exact) {
      EXPECT_NEAR(part(info, name)["area"].get<double>() / exact, 1.0, kChords) << name;
      EXPECT_EQ(part(info, name)["pieces"], 1) << name;
    };
    near("endocardium", integral(0.0, kBase, [](double mu) { return element(kInner, mu); }));
    near("epicardium", integral(0.0, kBase, [](double mu) { return element(kOuter, mu); }));
    near("base", integral(kInner, kOuter, [](double lambda) { return element(lambda, kBase); }));
    EXPECT_EQ(info["surfaces"]["confidence"], 1.0);
    EXPECT_EQ(info["surfaces"]["monotone"], 1.0);
    const auto thickness = [](double mu) {
      return integral(kInner, kOuter,
                      [mu](double l) { return kFocus * std::hypot(std::sinh(l), std::sin(mu)); });
    };
    EXPECT_NEAR(info["surfaces"]["thickness_min"].get<double>(), thickness(0.0), 0.02 * thickness(0.0));
    EXPECT_NEAR(info["surfaces"]["thickness_max"].get<double>(), thickness(0.5 * kPi),
                0.02 * thickness(0.5 * kPi));
    const Json surfaces = json({"info", out});
    bool labelled = false;
    for (const Json& array : surfaces["arrays"]) labelled = labelled || array["name"] == "surface";
    EXPECT_TRUE(labelled) << surfaces;
  }
  const ProgramResult text = run({"info", "bare.pts", "--surfaces", "text.vtp"});
  EXPECT_NE(text.out.find("epicardium: area "), std::string::npos) << text.out;
  EXPECT_NE(text.out.find(" thick, median "), std::string::npos) << text.out;

  EXPECT_EQ(run({"info", "bare.pts", "--surfaces", "text.vtp"}).exit_code, 2) << "overwritten unasked";
  EXPECT_EQ(run({"info", "bare.pts", "--surfaces", "surfaces.stl"}).exit_code, 2);
  // A shell of triangles has no wall.
  const ProgramResult shell = run({"info", "bare.vtp", "--surfaces", "none.vtp"});
  EXPECT_EQ(shell.exit_code, 3);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("none.vtp")));
}

TEST_F(CardiacRule, WritesTheCoordinatesOfAWallWithoutFibres) {
  write_bare();
  const Json map = json({"map", "bare.pts", "--coordinates", "--out", "coordinates.vtu"});
  EXPECT_EQ(column(map, "transmural")["min"], 0.0);
  EXPECT_EQ(column(map, "transmural")["max"], 1.0);
  EXPECT_EQ(column(map, "apicobasal")["min"], 0.0);
  EXPECT_EQ(column(map, "apicobasal")["max"], 1.0);
  EXPECT_GT(column(map, "rotational")["min"].get<double>(), -kPi);
  EXPECT_LE(column(map, "rotational")["max"].get<double>(), kPi);
  EXPECT_NEAR(column(map, "rotational")["max"].get<double>(), kPi, 1e-6);
  EXPECT_EQ(column(map, "rotational")["undefined"], 11);  // through the wall at the apex
  EXPECT_TRUE(column(map, "ventricle").is_null());
  EXPECT_NEAR(map["axis"][2].get<double>(), 1.0, 1e-6);
  EXPECT_NEAR(map["apex"]["outer"][2].get<double>(), -kFocus * std::cosh(kOuter), 1e-3);
  EXPECT_EQ(json({"info", "coordinates.vtu"})["arrays"].size(), 3U);

  EXPECT_EQ(run({"map", "bare.pts", "--coordinates", "--angle", "helix", "--json"}).exit_code, 2);
  EXPECT_EQ(run({"map", "bare.pts", "--coordinates"}).exit_code, 2);
  EXPECT_EQ(run({"map", "bare.pts", "--json"}).exit_code, 3) << "angles ask for fibres";
  const Json depth = json({"map", "bare.pts", "--angle", "depth", "--out", "depth.csv"});
  EXPECT_EQ(depth["points"], map["points"]) << "the depth asks for none";
  EXPECT_EQ(depth["undefined"], 0);
  EXPECT_GE(depth["bands"].size(), 10U);
}

TEST_F(CardiacRule, MakesFibresForAMeshWithoutThem) {
  write_bare();
  for (const std::string out : {"ruled.pts", "ruled.vtu"}) {
    const Json made =
        json({"fibers", "bare.pts", "--rule", "bayer", "--endo", "60", "--epi", "-60", "--out", out});
    EXPECT_EQ(made["rule"], "bayer");
    EXPECT_EQ(made["ventricles"], 1);
    EXPECT_EQ(made["without"], 0);
    EXPECT_GT(made["elements"].get<int>(), 100'000);
    // Its own program reads it, with layers, and sees the angles that were asked for: about the straight axis.
    const Json map = json({"map", out, "--angle", "helix", "--convention", "streeter", "--axis", "0,0,1"});
    // Points lie at ten depths: next to one half at 0.466, where the potential ln tanh(lambda / 2) is at lambda
    // 0.62. Those on the surfaces have the mean of the cells of half a layer, 0.045 and 0.04 deep.
    EXPECT_NEAR(mean_at(map, 0.5), 60.0 - 120.0 * 0.466, 1.0) << out;
    // openCARP's files keep the hexahedra: each has the mean of its layer, the first of which is 0.14 deep.
    EXPECT_NEAR(mean_at(map, 0.0), 60.0 - 120.0 * (out == "ruled.pts" ? 0.07 : 0.045), 2.0) << out;
    EXPECT_NEAR(mean_at(map, 1.0), -60.0 + 120.0 * 0.04, 2.0) << out;
    EXPECT_EQ(json({"info", out})["no_layers"], nullptr);
  }
  // The fibres fit the mesh.
  const auto rows = [this](const std::string& file) {
    std::ifstream in(folder_.path(file));
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  };
  EXPECT_EQ(rows("ruled.elem"), rows("bare.elem"));
  EXPECT_NE(rows("bare.elem").find("Hx"), std::string::npos);
  const Json drawn = json({"render", "ruled.pts", "--size", "200x160", "--out", "ruled.png"});
  EXPECT_GT(drawn["lines"].get<int>(), 100);

  const Json other =
      json({"fibers", "--example", "ventricle", "--endo", "80", "--epi", "-40", "--out", "other.vtu"});
  EXPECT_NE(other["notes"].dump().find("fibre"), std::string::npos)
      << "its own are left out, and that is said";
  const Json map =
      json({"map", "other.vtu", "--angle", "helix", "--convention", "streeter", "--axis", "0,0,1"});
  // The file's own depth is that in lambda, whose half is at 0.567 of the potential.
  EXPECT_NEAR(mean_at(map, 0.5), 80.0 - 120.0 * 0.567, 1.0);

  EXPECT_EQ(run({"fibers", "bare.pts", "--out", "ruled.vtu"}).exit_code, 2) << "overwritten unasked";
  EXPECT_EQ(run({"fibers", "bare.pts", "--rule", "guess", "--out", "no.vtu"}).exit_code, 2);
  EXPECT_EQ(run({"fibers", "bare.pts", "--endo", "100", "--out", "no.vtu"}).exit_code, 2);
  EXPECT_EQ(run({"fibers", "bare.pts", "--out", "no.vtp"}).exit_code, 2);
  EXPECT_EQ(run({"fibers", "bare.pts"}).exit_code, 2);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("no.vtu")));
}

// Measured hearts have no closed form: of every point the depth has to fall to the inner and to rise to the outer surface.
TEST_F(CardiacRule, DepthsRiseThroughTheWallsOfMeasuredHearts) {
  PALPATE_NEED_DATA(dog, "cardiac/canine-heart/heart.exnode.gz");
  PALPATE_NEED_DATA(ellipsoid, "cardiac/chaste-ellipsoid/ellipsoid_8225_elements_quad.ele");
  (void)json({"convert", dog.string(), "--out", "dog.pts"});
  for (const auto& [file, name] :
       {std::pair{std::string("dog.pts"), "dog"}, {ellipsoid.string(), "ellipsoid"}}) {
    const Json info = json({"info", file, "--surfaces", std::string(name) + ".vtp"});
    RecordProperty(std::string("monotone_share_of_the_") + name, info["surfaces"]["monotone"].dump());
    EXPECT_GT(info["surfaces"]["monotone"].get<double>(), 0.998) << name;
    EXPECT_GT(part(info, "epicardium")["area"].get<double>(), 0.0) << name;
    const Json map = json({"map", file, "--angle", "depth", "--out", std::string(name) + ".csv"});
    EXPECT_EQ(map["undefined"], 0) << name;
  }
}

// The shell of an atrium with the openings of two veins: no wall, so no layers; drawn, with its fibres and regions.
TEST_F(CardiacRule, AnAtriumIsDrawnAndItsLayersAreRefused) {
  constexpr int kAround = 24, kAlong = 12;  // 30 to 150 degrees from the pole
  std::ostringstream points, cells, fibres;
  points << kAround * (kAlong + 1) << "\n";
  cells << 2 * kAround * kAlong << "\n";
  fibres << "1\n";
  for (int j = 0; j <= kAlong; ++j) {
    const double polar = kPi / 6.0 + 2.0 * kPi / 3.0 * j / kAlong;
    for (int i = 0; i < kAround; ++i) {
      const double around = 2.0 * kPi * i / kAround;
      points << 25000.0 * std::sin(polar) * std::cos(around) << " "
             << 25000.0 * std::sin(polar) * std::sin(around) << " " << 25000.0 * std::cos(polar) << "\n";
      if (j == kAlong) continue;
      const int a = j * kAround + i, b = j * kAround + (i + 1) % kAround;
      cells << "Tr " << a << " " << b << " " << a + kAround << " 1\nTr " << b << " " << b + kAround << " "
            << a + kAround << " 2\n";
      for (int half = 0; half < 2; ++half) fibres << -std::sin(around) << " " << std::cos(around) << " 0\n";
    }
  }
  (void)folder_.write("atrium.pts", points.str());
  (void)folder_.write("atrium.elem", cells.str());
  (void)folder_.write("atrium.lon", fibres.str());
  const Json info = json({"info", "atrium.pts"});
  EXPECT_TRUE(info["no_layers"].is_string() || info["not_volume"].is_string()) << info;
  const Json drawn = json({"render", "atrium.pts", "--size", "160x120", "--out", "atrium.png"});
  EXPECT_EQ(drawn["lines"], 2 * kAround * kAlong) << "a stroke a triangle";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"trace", "atrium.pts", "--layer", "0.5", "--seeds", "random:5", "--out",
                                 "no.vtp"},
        {"map", "atrium.pts", "--angle", "depth", "--out", "no.csv"},
        {"info", "atrium.pts", "--surfaces", "no.vtp"}}) {
    const ProgramResult result = run(command);
    EXPECT_EQ(result.exit_code, 3) << command.front() << result.err;
    EXPECT_NE(result.err.find("not a volume"), std::string::npos) << result.err;
  }
}

// A block has no inner surface: refused with what to do.
TEST_F(CardiacRule, RefusesAWallWithoutSurfaces) {
  (void)folder_.write("block.pts",
                      "8\n0 0 0\n1000 0 0\n0 1000 0\n1000 1000 0\n0 0 1000\n1000 0 1000\n0 1000 1000\n"
                      "1000 1000 1000\n");
  (void)folder_.write("block.elem",
                      "5\nTt 0 1 2 4 1\nTt 1 3 2 7 1\nTt 1 4 5 7 1\nTt 2 4 7 6 1\nTt 1 2 4 7 1\n");
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"info", "block.pts", "--surfaces", "no.vtp"},
        {"map", "block.pts", "--coordinates", "--out", "no.vtu"},
        {"fibers", "block.pts", "--out", "no.vtu"}}) {
    const ProgramResult result = run(command);
    EXPECT_EQ(result.exit_code, 3) << command.front();
    EXPECT_NE(result.err.find("'surface'"), std::string::npos) << result.err;
  }
}

}  // namespace
}  // namespace palpate::test
