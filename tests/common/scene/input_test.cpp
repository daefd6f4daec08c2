#include "common/scene/input.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/ledger.h"
#include "common/scene/flow_series.h"
#include "common/scene/time_steps.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

InputOptions made(const std::string& example, const std::string& field = "", const std::string& time = "") {
  InputOptions options;
  options.example = example;
  options.field = field;
  options.time = time;
  return options;
}

ExitCode code_of(const InputOptions& spec) {
  try {
    (void)Input::open(spec);
  } catch (const Error& error) {
    return error.code();
  }
  return ExitCode::kDone;
}

TEST(ChooseTime, TakesFirstLastAndTheNearest) {
  const std::vector<double> times{0.0, 0.5, 1.0};
  EXPECT_EQ(choose_time(times, "first").step, 0U);
  EXPECT_EQ(choose_time(times, "last").step, 2U);
  EXPECT_EQ(choose_time(times, "0.5").step, 1U);
  EXPECT_TRUE(choose_time(times, "0.5").exact);
  EXPECT_EQ(choose_time(times, "0.8").step, 2U);
  EXPECT_FALSE(choose_time(times, "0.8").exact);
  EXPECT_EQ(choose_time({}, "last").step, 0U);
}

TEST(ChooseTime, RefusesTimesFarOutsideAndWordsThatAreNone) {
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "7"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "-7"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "nan"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "soon"), Error);
  EXPECT_THROW((void)choose_time({0.0, 0.5, 1.0}, "1s"), Error);
  EXPECT_THROW((void)choose_time({2.0}, "3"), Error);
  EXPECT_THROW((void)choose_time({}, "1"), Error);
}

TEST(Input, WantsOneOfFilesAndExample) {
  EXPECT_EQ(code_of({}), ExitCode::kUsage);
  InputOptions both = made("abc");
  both.files = {"a.vtk"};
  EXPECT_EQ(code_of(both), ExitCode::kUsage);
  EXPECT_EQ(code_of(made("no-such-example")), ExitCode::kUsage);
  EXPECT_EQ(code_of(made("abc", "pressure")), ExitCode::kUsage);
  EXPECT_EQ(code_of(made("abc", "", "3")), ExitCode::kUsage);
  EXPECT_EQ(code_of(input_of({"/no/such/file.vtk"})), ExitCode::kBadInput);
}

TEST(Input, MakesTheFieldOfAnExample) {
  Input input = Input::open(made("abc"));
  EXPECT_EQ(input.title(), "example abc");
  EXPECT_EQ(input.file(), nullptr);
  EXPECT_NE(input.load_field(1)->analytic(), nullptr);
}

// In the order of time, whatever that of the file, and round at either end.
/// How often opening has read the array "tag", which numbers the tetrahedron and perhaps faces of it.
std::size_t readings(const InputOptions& spec) {
  Ledger::clear();
  const Input input = Input::open(spec);
  for (const LedgerEntry& entry : Ledger::entries())
    if (entry.what == "array tag") return entry.times;
  return 0;
}

// A heart's array of cells is read at opening only where there are faces whose numbers it may have.
TEST(Input, OpeningReadsNumbersOfFacesWhereThereAreFaces) {
  TempFolder folder;
  const auto mesh = [&](const std::string& name, const std::string& faces, int count,
                        const std::string& types, const std::string& tags) {
    return folder.write(name,
                        "# vtk DataFile Version 3.0\none\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
                        "0 0 0 1 0 0 0 1 0 0 0 1\nCELLS " +
                            std::to_string(count) + " " + std::to_string(5 + 4 * (count - 1)) +
                            "\n4 0 1 2 3\n" + faces + "CELL_TYPES " + std::to_string(count) + "\n10\n" +
                            types + "CELL_DATA " + std::to_string(count) +
                            "\nSCALARS tag int 1\nLOOKUP_TABLE default\n1\n" + tags);
  };
  const InputOptions bare = input_of({mesh("bare.vtk", "", 1, "", "")}, FieldKind::kFibre);
  EXPECT_EQ(readings(bare), 0U);
  InputOptions faced =
      input_of({mesh("faced.vtk", "3 0 1 2\n3 1 2 3\n", 3, "5\n5\n", "4\n9\n")}, FieldKind::kFibre);
  EXPECT_EQ(readings(faced), 1U);
  faced.kind = FieldKind::kScalar;
  EXPECT_EQ(readings(faced), 0U) << "no heart";
  InputOptions asked = bare;
  asked.surface_markers = "4/9";
  EXPECT_EQ(code_of(asked), ExitCode::kUsage) << "there are none";
}

TEST(TimeSteps, GoOnByTimeAndRound) {
  const std::vector<double> times{0.5, 0.0, 2.0, 1.0};
  EXPECT_EQ(step_beside(times, 1, true), 0U);
  EXPECT_EQ(step_beside(times, 0, true), 3U);
  EXPECT_EQ(step_beside(times, 2, true), 1U);
  EXPECT_EQ(step_beside(times, 1, false), 2U);
  for (std::size_t step = 0; step < times.size(); ++step)
    EXPECT_EQ(step_beside(times, step_beside(times, step, true), false), step);
  EXPECT_EQ(nearest_step(times, 1.4), 3U);
  EXPECT_EQ(nearest_step(times, -7.0), 1U);
  EXPECT_EQ(nearest_step(times, 9.0), 2U);
}

/// A transient of 2 x 2 x 2 points at the times 0, 1, ...; at each its speed along x.
InputOptions transient(const TempFolder& folder, const std::vector<double>& speeds) {
  std::string list = R"(<VTKFile type="Collection"><Collection>)";
  for (std::size_t step = 0; step < speeds.size(); ++step) {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\n"
        "SPACING 1 1 1\nPOINT_DATA 8\nVECTORS v float\n";
    for (int p = 0; p < 8; ++p) text += std::to_string(speeds[step]) + " 0 0\n";
    const std::string name = "t" + std::to_string(step) + ".vtk";
    (void)folder.write(name, text);
    list += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
  }
  return input_of({folder.write("t.pvd", list + "</Collection></VTKFile>")});
}

double opened_at(const Input& input) { return input.times()[input.time().step]; }

bool says_why(const Input& input) {
  for (const std::string& note : input.notes()) {
    if (note.find("nothing moves at time 0") != std::string::npos) return true;
  }
  return false;
}

TEST(Input, ATransientOpensWhereSomethingMoves) {
  const TempFolder folder;
  Input input = Input::open(transient(folder, {0.0, 0.0, 3.0, 4.0}));
  EXPECT_EQ(opened_at(input), 2.0);
  EXPECT_TRUE(says_why(input));
  EXPECT_NE(input.choice_sentence().find("time 2"), std::string::npos) << input.choice_sentence();
  EXPECT_EQ(input.load_field(1)->max_speed(), 3.0);
  // Another time, and the same one once more.
  const std::size_t opened = input.time().step;
  input.set_time_step(step_beside(input.times(), opened, true));
  EXPECT_EQ(input.load_field(1)->max_speed(), 4.0);
  input.set_time_step(opened);
  EXPECT_EQ(input.load_field(1)->max_speed(), 3.0);

  EXPECT_EQ(opened_at(Input::open(transient(folder, {2.0, 3.0}))), 0.0);
  EXPECT_FALSE(says_why(Input::open(transient(folder, {2.0, 3.0}))));
}

// A step whose file is damaged costs itself and a word.
TEST(Input, ATransientPassesOverAStepThatCannotBeRead) {
  const TempFolder folder;
  const InputOptions spec = transient(folder, {0.0, 0.0, 3.0});
  (void)folder.write("t1.vtk",
                     "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\n");
  Input input = Input::open(spec);
  EXPECT_EQ(opened_at(input), 2.0);
  EXPECT_TRUE(says_why(input));
  EXPECT_TRUE(std::ranges::any_of(input.notes(), [](const std::string& note) {
    return note.find("WARNING: time 1 cannot be read: passed over") != std::string::npos;
  }));
  EXPECT_EQ(input.load_field(1)->max_speed(), 3.0);
}

TEST(Input, ATransientOpensAtTheTimeThatIsAskedFor) {
  const TempFolder folder;
  InputOptions first = transient(folder, {0.0, 2.0});
  first.time = "first";
  EXPECT_FALSE(says_why(Input::open(first)));
  Input asked = Input::open(first);
  EXPECT_EQ(asked.time().step, 0U);
  EXPECT_EQ(asked.load_field(1)->max_speed(), opened_at(asked) == 0.0 ? 0.0 : 2.0);
}

TEST(Input, ATransientWithoutMovementOpensAtItsFirstStep) {
  const TempFolder folder;
  Input input = Input::open(transient(folder, std::vector<double>(30, 0.0)));
  EXPECT_EQ(input.time().step, 0U);
  EXPECT_FALSE(says_why(input));
  EXPECT_EQ(input.load_field(1)->max_speed(), 0.0);
}

TEST(FlowSeries, ReadsStepsInTheOrderOfTimeAndKeepsTheGridThatStays) {
  const TempFolder folder;
  InputOptions spec = transient(folder, {1.0, 2.0, 3.0, 4.0});
  // The last comes first.
  spec.files = {folder.write("u.pvd", R"(<VTKFile type="Collection"><Collection>
<DataSet timestep="2" file="t2.vtk"/><DataSet timestep="0" file="t0.vtk"/><DataSet timestep="1" file="t1.vtk"/>
</Collection></VTKFile>)")};
  Input input = Input::open(spec);
  const std::size_t own = input.time().step;
  FlowSeries series(input, 1);
  EXPECT_EQ(series.times(), (std::vector<double>{0.0, 1.0, 2.0}));
  const auto first = series.read(0), last = series.read(2);
  EXPECT_EQ(first->max_speed(), 1.0);
  EXPECT_EQ(last->max_speed(), 3.0);
  EXPECT_EQ(first->grid(), last->grid());
  EXPECT_EQ(input.time().step, own);
}

TEST(FlowSeries, MakesAnotherGridWherePointsMove) {
  const TempFolder folder;
  std::string list = R"(<VTKFile type="Collection"><Collection>)";
  for (int step = 0; step < 2; ++step) {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 ";
    text +=
        std::to_string(1 + step) +
        "\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\nVECTORS v float\n1 0 0 1 0 0 1 0 0 1 0 0\n";
    const std::string name = "m" + std::to_string(step) + ".vtk";
    (void)folder.write(name, text);
    list += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
  }
  Input input = Input::open(input_of({folder.write("m.pvd", list + "</Collection></VTKFile>")}));
  FlowSeries series(input, 1);
  const auto first = series.read(0), second = series.read(1);
  EXPECT_NE(first->grid(), second->grid());
  EXPECT_EQ(second->bounds().upper.z, 2.0);
}

// Two cells with points of their own: apart where their values differ, joined where these agree.
TEST(FlowSeries, MakesAnotherGridWhereValuesHaveASayInIt) {
  const TempFolder folder;
  std::string list = R"(<VTKFile type="Collection"><Collection>)";
  for (int step = 0; step < 2; ++step) {
    std::string text =
        "# vtk DataFile Version 3.0\nt\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
        "0 0 0 1 0 0 0 1 0 0 0 1 0 0 0 0 1 0 1 0 0 0 0 -1\n"
        "CELLS 2 10\n4 0 1 2 3\n4 4 5 6 7\nCELL_TYPES 2\n10 10\nPOINT_DATA 8\nVECTORS v float\n";
    for (int point = 0; point < 8; ++point) text += point < 4 || step == 1 ? "1 0 1\n" : "3 0 1\n";
    const std::string name = "j" + std::to_string(step) + ".vtk";
    (void)folder.write(name, text);
    list += "<DataSet timestep=\"" + std::to_string(step) + "\" file=\"" + name + "\"/>";
  }
  Input input = Input::open(input_of({folder.write("j.pvd", list + "</Collection></VTKFile>")}));
  FlowSeries series(input, 1);
  const auto first = series.read(0), second = series.read(1);
  EXPECT_NE(first->grid(), second->grid());
  ASSERT_FALSE(first->notes().lines.empty());
  const auto notes = series.field_notes({});
  ASSERT_FALSE(notes.empty());
  EXPECT_NE(notes.front().find("the first of them at time 0"), std::string::npos) << notes.front();
  EXPECT_LT(series.field_notes(first->notes().lines).size(), notes.size());
}

}  // namespace
}  // namespace palpate::test
