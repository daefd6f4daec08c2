#include "common/field/transfer/label_table.h"

#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(LabelTable, ReadsEachKindOfRow) {
  const TempFolder folder;
  const LabelTable table = read_label_table(folder
                                                .write("labels.txt",
                                                       "# a comment\n"
                                                       "7 liver 255 0 51 255\n"
                                                       "\n"
                                                       "3 0 255 0 1 1 1 \"left kidney\"\n"
                                                       "12,spleen,0,0,255\n"
                                                       "2,bone\n")
                                                .string());
  ASSERT_EQ(table.labels().size(), 4U);
  EXPECT_EQ(table.labels().front().value, 2.0);
  ASSERT_NE(table.find(7.0), nullptr);
  EXPECT_EQ(table.find(7.0)->name, "liver");
  EXPECT_EQ(table.find(7.0)->color, (Vec3f{1.0F, 0.0F, 0.2F}));
  EXPECT_EQ(table.find(3.0)->name, "left kidney");
  EXPECT_EQ(table.find(3.0)->color, (Vec3f{0.0F, 1.0F, 0.0F}));
  EXPECT_EQ(table.find(12.0)->color, (Vec3f{0.0F, 0.0F, 1.0F}));
  EXPECT_EQ(table.find(8.0), nullptr);
}

TEST(LabelTable, LabelsWithoutARowAreToldApart) {
  const LabelTable table;
  EXPECT_EQ(table.at(5.0).name, "label 5");
  for (int a = 1; a < 40; ++a) EXPECT_GT(glm::length(table.at(a).color - table.at(a + 1).color), 0.2F) << a;
}

TEST(LabelTable, RefusesARowThatIsNone) {
  const TempFolder folder;
  for (const char* text :
       {"7 liver 255 0\n", "7 liver 255 0 300 255\n", "seven liver 1 2 3 4\n", "1.5 x 1 2 3 4\n", ""})
    EXPECT_THROW((void)read_label_table(folder.write("l.txt", text).string()), Error) << text;
}

}  // namespace
}  // namespace palpate::test
