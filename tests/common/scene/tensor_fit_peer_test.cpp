// Our fit of the head beside that of MRtrix's dwi2tensor, and what it writes read back.

#include <cmath>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

#include "common/field/tensor/diffusion_measures.h"
#include "common/math/symmetric3.h"
#include "common/scene/input.h"
#include "tests/support/shared_data.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TensorImage image_of(const std::filesystem::path& file, const TensorSpec& words) {
  InputOptions spec;
  spec.files = {file};
  spec.kind = FieldKind::kTensor;
  spec.tensor = words;
  return Input::open(spec).load_tensor_image(2);
}

SymmetricEigen eigen_of(const TensorImage& image, std::size_t voxel) {
  const auto d =
      read_tensor(*image.image.find(image.choice.array, Association::kPoint), voxel, image.choice.order);
  return symmetric_eigen({Vec3{d[0], d[1], d[2]}, Vec3{d[1], d[3], d[4]}, Vec3{d[2], d[4], d[5]}});
}

/// How often two images of tensors agree, of voxels where both have one of FA > 0.2.
struct Agreement {
  std::size_t voxels = 0;
  std::size_t within_half_degree = 0;
  std::size_t fa_within = 0;  ///< 0.005
};

Agreement compare(const TensorImage& ours, const TensorImage& theirs) {
  Agreement agreement;
  for (std::size_t v = 0; v < ours.image.point_count(); ++v) {
    const SymmetricEigen a = eigen_of(ours, v), b = eigen_of(theirs, v);
    if (!std::isfinite(a.values[0]) || !std::isfinite(b.values[0])) continue;
    const double fa = fractional_anisotropy(b.values);
    if (fa <= 0.2) continue;
    ++agreement.voxels;
    const double cosine = std::min(1.0, std::abs(glm::dot(a.vectors[0], b.vectors[0])));
    agreement.within_half_degree += std::acos(cosine) <= 0.5 * std::acos(-1.0) / 180.0 ? 1 : 0;
    agreement.fa_within += std::abs(fa - fractional_anisotropy(a.values)) <= 0.005 ? 1 : 0;
  }
  return agreement;
}

class FitBesideMrtrix : public ::testing::TestWithParam<bool> {};

TEST_P(FitBesideMrtrix, HasTheSameDirectionsAndAnisotropies) {
  const bool ordinary = GetParam();
  PALPATE_NEED_DATA(dwi, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  PALPATE_NEED_DATA(bval, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.bval");
  PALPATE_NEED_DATA(bvec, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.bvec");
  const TempFolder folder;
  const std::filesystem::path theirs = folder.path() / "dt.nii";
  const std::string command = "dwi2tensor -quiet -nthreads 1 " +
                              std::string(ordinary ? "-ols -iter 0 " : "") + "-fslgrad '" + bvec.string() +
                              "' '" + bval.string() + "' '" + dwi.string() + "' '" + theirs.string() + "'";
  if (std::system("command -v dwi2tensor >/dev/null") != 0) GTEST_SKIP() << "MRtrix's dwi2tensor is missing";
  ASSERT_EQ(std::system(command.c_str()), 0) << command;

  TensorSpec words;
  words.fit = ordinary ? "ordinary" : "weighted";
  const Agreement agreement = compare(image_of(dwi, words), image_of(theirs, {}));
  EXPECT_GT(agreement.voxels, 20'000U);
  EXPECT_GE(agreement.within_half_degree, agreement.voxels * 99 / 100);
  // The rest are voxels without signal in some volume: weights of 1e-12 leave the equations all but singular.
  EXPECT_GE(agreement.fa_within, agreement.voxels * 999 / 1000);
  RecordProperty("voxels", std::to_string(agreement.voxels));
  RecordProperty("within_half_degree", std::to_string(agreement.within_half_degree));
  RecordProperty("fa_within", std::to_string(agreement.fa_within));
}

INSTANTIATE_TEST_SUITE_P(Weights, FitBesideMrtrix, ::testing::Bool());

}  // namespace
}  // namespace palpate::test
