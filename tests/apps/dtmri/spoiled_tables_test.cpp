// What the window says by itself of every table of gradients in the sample data and the cases beside the checkout: nothing
// of axes where the table is right; where it is spoiled, what undoes that, with a button.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/dtmri/dtmri_model.h"
#include "common/base/error.h"
#include "common/field/tensor/vector_frame.h"
#include "common/scene/document/setting.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

/// Each row of a table in FSL's form, of another row and with another sign; and the options that undo it.
struct Spoil {
  std::array<std::size_t, 3> from;
  std::array<bool, 3> turned;
  std::vector<std::pair<std::string, std::string>> undone;
};
const std::vector<Spoil> kSpoils{{{0, 1, 2}, {true, false, false}, {{"flip", "i"}}},
                                 {{0, 1, 2}, {false, true, false}, {{"flip", "j"}}},
                                 {{0, 1, 2}, {false, false, true}, {{"flip", "k"}}},
                                 {{1, 0, 2}, {false, false, false}, {{"permute", "jik"}}},
                                 {{0, 2, 1}, {false, false, false}, {{"permute", "ikj"}}},
                                 {{2, 0, 1}, {false, false, false}, {{"permute", "jki"}}}};

std::vector<std::vector<std::string>> rows_of(const fs::path& table) {
  std::ifstream in(table);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string word; words >> word;) row.push_back(word);
    if (row.empty()) rows.pop_back();
  }
  EXPECT_EQ(rows.size(), 3U) << table;
  return rows;
}

std::string spoiled(const fs::path& table, const Spoil& how) {
  const auto rows = rows_of(table);
  std::string text;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const std::string& word : rows.at(how.from[axis])) {
      const bool minus = word.starts_with('-');
      text += !how.turned[axis] ? word : minus ? word.substr(1) : "-" + word;
      text += ' ';
    }
    text += '\n';
  }
  return text;
}

/// The table along the axes of another frame, as programs write it that know no FSL.
std::string in_frame(const fs::path& table, VectorFrame frame, const Mat3& axes) {
  const auto rows = rows_of(table);
  const Mat3 turn =
      glm::transpose(matrix_of(frame, axes)) * matrix_of(VectorFrame::kImage, axes);  // both are rotations
  std::array<std::ostringstream, 3> text;
  for (std::size_t v = 0; v < rows.front().size(); ++v) {
    const Vec3 g = turn * Vec3(std::stod(rows[0][v]), std::stod(rows[1][v]), std::stod(rows[2][v]));
    for (int axis = 0; axis < 3; ++axis) text[static_cast<std::size_t>(axis)] << g[axis] << ' ';
  }
  return text[0].str() + '\n' + text[1].str() + '\n' + text[2].str() + '\n';
}

SceneState opened(const fs::path& image, const fs::path& table, const fs::path& weights,
                  Document document = {}) {
  const TensorSpec asked = document.input.tensor;
  document.input = input_of({image}, FieldKind::kTensor);
  document.input.tensor = asked;
  document.input.tensor.bvec = table;
  document.input.tensor.bval = weights;
  DtmriModel model(document, "dtmri");
  Progress progress;
  return model.start(progress);
}

bool says(const SceneState& scene, const std::string& words, const std::string& first = {}) {
  return std::ranges::any_of(scene.notes, [&](const std::string& note) {
    return note.starts_with(first) && note.find(words) != std::string::npos;
  });
}

/// By how much the tensors of `b` differ from those of `a`: the median over voxels, of their size.
double apart(const SceneState& a, const SceneState& b) {
  std::vector<double> shares;
  const TensorField &one = *a.tensors->image->field, &other = *b.tensors->image->field;
  const auto size = [](const Mat3& m) {
    return std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  };
  const Index3 points = a.tensors->image->points;
  for (int k = 0; k < points.z; ++k) {
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        const TensorSample u = one.voxel({i, j, k}), v = other.voxel({i, j, k});
        if (u.status == SampleStatus::kOk && v.status == SampleStatus::kOk)
          shares.push_back(size(u.value - v.value) / size(u.value));
      }
    }
  }
  EXPECT_GT(shares.size(), 100U);
  if (shares.empty()) return HUGE_VAL;
  const auto middle = shares.begin() + static_cast<std::ptrdiff_t>(shares.size() / 2);
  std::ranges::nth_element(shares, middle);
  return *middle;
}

TEST(SpoiledTables, OfAllSampleDataAreSaidWithWhatUndoesThem) {
  PALPATE_NEED_DATA(head, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  std::set<fs::path> tables;
  for (const fs::path& folder : {head.parent_path(), shared_data("../cases/dtmri")}) {
    if (folder.empty()) continue;
    for (const auto& entry : fs::directory_iterator(folder)) {
      if (entry.path().extension() == ".bvec") tables.insert(entry.path());
    }
  }
  const TempFolder folder;
  std::size_t judged = 0, frames = 0;
  for (const fs::path& table : tables) {
    fs::path image = table, weights = table;
    image.replace_extension(".nii.gz");
    weights.replace_extension(".bval");
    if (!fs::exists(image)) continue;
    SceneState right;
    try {
      right = opened(image, table, weights);
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("is flat"), std::string::npos) << error.what();
      continue;  // one slice: fitted and measured without a window
    }
    EXPECT_TRUE(right.fixes.empty()) << image;
    EXPECT_FALSE(says(right, "WARNING: neighbouring")) << image;
    // Where the image does not decide it says that, or that its tensors are noise.
    const bool open = says(right, "cannot be told from this image") ||
                      says(right, "% of the tensors are not positive", "WARNING");
    judged += open ? 0 : 1;
    for (const Spoil& how : kSpoils) {
      const SceneState scene = opened(image, folder.write("spoiled.bvec", spoiled(table, how)), weights);
      const std::string which = image.filename().string() + " " + how.undone.front().second;
      EXPECT_EQ(says(scene, "WARNING: neighbouring"), !open) << which;
      if (open) {
        EXPECT_TRUE(says(scene, "cannot be told from this image") ||
                    says(scene, "% of the tensors are not positive", "WARNING"))
            << which;
        continue;
      }
      ASSERT_EQ(scene.fixes.size(), 1U) << which;
      EXPECT_EQ(scene.fixes.front().settings, how.undone) << which;
    }
    if (open) continue;
    for (const VectorFrame frame : {VectorFrame::kVoxel, VectorFrame::kScanner, VectorFrame::kLps}) {
      const std::string which = image.filename().string() + " along " + std::string(name_of(frame));
      const fs::path other = folder.write("frame.bvec", in_frame(table, frame, right.tensors->image->axes));
      const SceneState scene = opened(image, other, weights);
      constexpr double kRounding = 1e-3;              // of a table of six digits
      if (apart(right, scene) < kRounding) continue;  // this image has both frames along the same lines
      ++frames;
      ASSERT_EQ(scene.fixes.size(), 1U) << which;
      Document mended;
      for (const auto& [name, value] : scene.fixes.front().settings)
        set_value(*find_setting(name, FieldKind::kTensor), mended, value);
      EXPECT_LT(apart(right, opened(image, other, weights, mended)), kRounding)
          << which << ": " << scene.fixes.front().note;
    }
  }
  EXPECT_GE(frames, 1U);
  EXPECT_GE(judged, 1U);
}

}  // namespace
}  // namespace palpate::test
