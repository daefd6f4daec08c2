// Hearts over time as Exodus files (written by VTK's own writer) and as .vtu.series, through the verbs of
// cardiac; and the same files damaged.
#include <array>
#include <cmath>
#include <vector>

#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkExodusIIWriter.h>
#include <vtkInformation.h>
#include <vtkInformationVector.h>
#include <vtkMultiBlockDataSet.h>
#include <vtkMultiBlockDataSetAlgorithm.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStreamingDemandDrivenPipeline.h>
#include <vtkUnstructuredGrid.h>

#include "tests/e2e/explorer_test.h"

namespace palpate::test {
namespace {

template <typename T>
using Ptr = vtkSmartPointer<T>;

constexpr std::array<double, 3> kTimes{0.0, 0.25, 1.5};

double potential(const std::array<double, 3>& x, double time) { return x[0] + 2.0 * x[1] + 10.0 * time; }

/// A tetrahedron whose depth is z, with fibres along x and a potential that rises with time.
class BeatingHeart : public vtkMultiBlockDataSetAlgorithm {
 public:
  static BeatingHeart* New() { return new BeatingHeart; }

 protected:
  BeatingHeart() { SetNumberOfInputPorts(0); }

  int RequestInformation(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override {
    const std::array<double, 2> range{kTimes.front(), kTimes.back()};
    vtkInformation* about = output->GetInformationObject(0);
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_STEPS(), kTimes.data(),
               static_cast<int>(kTimes.size()));
    about->Set(vtkStreamingDemandDrivenPipeline::TIME_RANGE(), range.data(), 2);
    return 1;
  }

  int RequestData(vtkInformation*, vtkInformationVector**, vtkInformationVector* output) override {
    vtkInformation* about = output->GetInformationObject(0);
    auto* const wanted = vtkStreamingDemandDrivenPipeline::UPDATE_TIME_STEP();
    const double time = about->Has(wanted) != 0 ? about->Get(wanted) : kTimes.front();
    const auto grid = Ptr<vtkUnstructuredGrid>::New();
    const auto points = Ptr<vtkPoints>::New();
    points->SetDataTypeToDouble();
    const auto layer = Ptr<vtkDoubleArray>::New(), vm = Ptr<vtkDoubleArray>::New(),
               fibre = Ptr<vtkDoubleArray>::New();
    layer->SetName("layer");
    vm->SetName("vm");
    fibre->SetName("fibre");
    fibre->SetNumberOfComponents(3);
    for (const auto& x : std::array<std::array<double, 3>, 4>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}) {
      points->InsertNextPoint(x.data());
      layer->InsertNextValue(x[2]);
      vm->InsertNextValue(potential(x, time));
      fibre->InsertNextTuple3(1.0, 0.0, 0.0);
    }
    grid->SetPoints(points);
    const std::array<vtkIdType, 4> corners{0, 1, 2, 3};
    grid->InsertNextCell(VTK_TETRA, 4, corners.data());
    for (const auto& array : {layer, vm, fibre}) grid->GetPointData()->AddArray(array);
    auto* blocks = vtkMultiBlockDataSet::SafeDownCast(about->Get(vtkDataObject::DATA_OBJECT()));
    blocks->SetBlock(0, grid);
    blocks->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), time);
    return 1;
  }
};

class CardiacFormats : public ExplorerTest {
 protected:
  CardiacFormats() : ExplorerTest("cardiac") {}

  std::string exodus() const {
    std::string file = folder_.path("heart.ex2").string();
    const auto heart = Ptr<BeatingHeart>::New();
    const auto writer = Ptr<vtkExodusIIWriter>::New();
    writer->SetFileName(file.data());
    writer->WriteAllTimeStepsOn();
    writer->SetInputConnection(heart->GetOutputPort());
    EXPECT_EQ(writer->Write(), 1);
    return file;
  }

  /// One time step as text. @return its name.
  std::string step(const std::string& name, double time) const {
    std::string vm;
    for (const auto& x : std::array<std::array<double, 3>, 4>{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}})
      vm += std::to_string(potential(x, time)) + " ";
    (void)folder_.write(
        name,
        "<VTKFile type=\"UnstructuredGrid\" version=\"0.1\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" "
        "NumberOfCells=\"1\"><PointData><DataArray type=\"Float64\" Name=\"layer\" format=\"ascii\">0 0 0 "
        "1</DataArray><DataArray type=\"Float64\" Name=\"vm\" format=\"ascii\">" +
            vm +
            "</DataArray><DataArray type=\"Float64\" Name=\"fibre\" NumberOfComponents=\"3\" "
            "format=\"ascii\">1 0 0 1 "
            "0 0 1 0 0 1 0 0</DataArray></PointData><Points><DataArray type=\"Float64\" "
            "NumberOfComponents=\"3\" "
            "format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points><Cells><DataArray type=\"Int64\" "
            "Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray><DataArray type=\"Int64\" "
            "Name=\"offsets\" "
            "format=\"ascii\">4</DataArray><DataArray type=\"UInt8\" Name=\"types\" "
            "format=\"ascii\">10</DataArray></Cells></Piece></UnstructuredGrid></VTKFile>");
    return name;
  }
  std::string series(const std::string& files) const {
    return folder_.write("heart.vtu.series", R"({"file-series-version":"1.0","files":[)" + files + "]}")
        .string();
  }
  static std::string entry(const std::string& name, const std::string& time) {
    return R"({"name":")" + name + R"(","time":)" + time + "}";
  }

  /// A heart to feel and to trace, and its potential at a place at all times.
  void expect_beats(const std::string& file) {
    const Json info = json({"info", file});
    EXPECT_EQ(info["field"], "fibre");
    EXPECT_EQ(info["no_layers"], nullptr);
    EXPECT_EQ(info["times"], Json(kTimes));
    (void)json({"series", file, "--value", "vm", "--at", "0.2,0.25,0.3", "--out", "vm.csv", "--force"});
    std::string expected;
    std::istringstream rows(read_file(folder_.path("vm.csv")));
    std::string row;
    std::vector<double> values;
    std::getline(rows, row);
    while (std::getline(rows, row)) values.push_back(std::stod(row.substr(row.rfind(',') + 1)));
    ASSERT_EQ(values.size(), kTimes.size());
    for (std::size_t t = 0; t < kTimes.size(); ++t)
      EXPECT_NEAR(values[t], potential({0.2, 0.25, 0.3}, kTimes[t]), 1e-9) << t;
    const Json trace = json(
        {"trace", file, "--seeds", "point:0.2,0.2,0.3", "--layer", "0.3", "--out", "lines.csv", "--force"});
    EXPECT_EQ(trace["lines"], 2) << "both ways";
  }

  /// Ends with one line that names a file of the folder, and exit code 3.
  void expect_refused(const std::string& file, const std::string& what) {
    for (const char* verb : {"info", "trace"}) {
      std::vector<std::string> command{verb, file};
      if (std::string(verb) == "trace")
        command.insert(command.end(), {"--seeds", "point:0.2,0.2,0.3", "--out", "l.csv"});
      const ProgramResult result = run(command);
      EXPECT_EQ(result.exit_code, 3) << what << ": " << result.err;
      EXPECT_NE(result.err.find("heart"), std::string::npos) << what << ": " << result.err;
      EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << what << ": " << result.err;
    }
    EXPECT_FALSE(std::filesystem::remove(folder_.path("l.csv"))) << what;
  }
};

TEST_F(CardiacFormats, ExodusFilesAreHeartsOverTime) { expect_beats(exodus()); }

TEST_F(CardiacFormats, DamagedExodusFilesAreNamed) {
  const std::string whole = read_file(exodus());
  ASSERT_GT(whole.size(), 200U);
  for (const std::size_t kept : {std::size_t{0}, std::size_t{10}, whole.size() / 4, whole.size() / 2})
    expect_refused(folder_.write("heart.ex2", whole.substr(0, kept)).string(),
                   std::to_string(kept) + " bytes");
}

TEST_F(CardiacFormats, SeriesFilesAreHeartsOverTime) {
  // Out of order in the list: times rise all the same.
  expect_beats(series(entry(step("heart_2.vtu", 1.5), "1.5") + "," + entry(step("heart_0.vtu", 0.0), "0") +
                      "," + entry(step("heart_1.vtu", 0.25), "0.25")));
}

TEST_F(CardiacFormats, DamagedSeriesFilesAreNamed) {
  const std::string good = entry(step("heart_0.vtu", 0.0), "0");
  for (const auto& [files, what] : std::vector<std::pair<std::string, std::string>>{
           {"", "no step"},
           {good + R"(,{"time":1})", "a step without a file"},
           {good + "," + entry("heart_0.vtu", "\"late\""), "a time that is a word"},
           {good + "," + entry("heart_0.vtu", "1e999"), "a time beyond all numbers"},
           {entry("heart_9.vtu", "1"), "its only step is not there"},
           {entry("heart.vtu.series", "1"), "a series that is its own step"},
           {good + ",7", "a number for a step"},
           {good + ",", "a comma too many"}})
    expect_refused(series(files), what);
  for (const std::string& text : {std::string("{"), std::string("[]"), std::string(R"({"files":{}})"),
                                  std::string(R"({"files":)") + std::string(100'000, '[')})
    expect_refused(folder_.write("heart.vtu.series", text).string(), text.substr(0, 40));
}

TEST_F(CardiacFormats, AStepThatCannotBeReadCostsItselfAndAWord) {
  const std::string good =
      entry(step("heart_0.vtu", 0.0), "0") + "," + entry(step("heart_1.vtu", 0.5), "0.5");
  for (const std::string lost : {"heart_9.vtu", "heart.vtu.series"}) {
    const std::string file = series(good + "," + entry(lost, "1"));
    EXPECT_EQ(json({"info", file})["times"], Json({0.0, 0.5})) << lost;
    const ProgramResult traced =
        run({"trace", file, "--seeds", "point:0.2,0.2,0.3", "--out", "l.csv", "--force"});
    EXPECT_EQ(traced.exit_code, 0) << traced.err;
    EXPECT_NE(traced.err.find(lost), std::string::npos) << traced.err;
    EXPECT_NE(traced.err.find("left out"), std::string::npos) << traced.err;
  }
}

// What `cardiac mesh` writes of the long axis is taken from any VTK file that says it; what is no direction
// is not.
TEST_F(CardiacFormats, LongAxesOfVtkFilesAreTakenIfTheyAreDirections) {
  const std::string plain = read_file(folder_.path(step("heart.vtu", 0.0)));
  const auto axis_of = [&](const std::string& numbers, int components) {
    std::string text = plain;
    text.insert(text.find("<Piece"),
                "<FieldData><DataArray type=\"Float64\" Name=\"long_axis\" NumberOfTuples=\"1\" "
                "NumberOfComponents=\"" +
                    std::to_string(components) + "\" format=\"ascii\">" + numbers +
                    "</DataArray></FieldData>");
    (void)folder_.write("heart.vtu", text);
    const ProgramResult result = run({"map", "heart.vtu", "--json"});
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 2) << numbers << ": " << result.err;
    return result.exit_code == 0 ? parse_json(result.out)["axis"].dump() : "";
  };
  EXPECT_EQ(axis_of("0 0 4", 3), "[0.0,0.0,1.0]");
  (void)folder_.write("heart.vtu", plain);
  const ProgramResult without = run({"map", "heart.vtu", "--json"});
  const std::string own = without.exit_code == 0 ? parse_json(without.out)["axis"].dump() : "";
  for (const auto& [numbers, components] : std::vector<std::pair<std::string, int>>{
           {"0 0 0", 3}, {"nan 0 0", 3}, {"inf 1 0", 3}, {"1 2", 2}, {"1", 1}})
    EXPECT_EQ(axis_of(numbers, components), own) << numbers;
}

}  // namespace
}  // namespace palpate::test
