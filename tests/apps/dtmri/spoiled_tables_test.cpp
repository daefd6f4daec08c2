// What the window says by itself of every table of gradients in the sample data and the cases beside the checkout: nothing
// of axes where the table is right; where it is spoiled, what undoes that, with a button.

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/dtmri/dtmri_model.h"
#include "common/base/error.h"
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

std::string spoiled(const fs::path& table, const Spoil& how) {
  std::ifstream in(table);
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(in, line);) {
    std::istringstream words(line);
    std::vector<std::string>& row = rows.emplace_back();
    for (std::string word; words >> word;) row.push_back(word);
    if (row.empty()) rows.pop_back();
  }
  EXPECT_EQ(rows.size(), 3U) << table;
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

SceneState opened(const fs::path& image, const fs::path& table, const fs::path& weights) {
  Document document;
  document.input = input_of({image}, FieldKind::kTensor);
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
  std::size_t judged = 0;
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
  }
  EXPECT_GE(judged, 1U);
}

}  // namespace
}  // namespace palpate::test
