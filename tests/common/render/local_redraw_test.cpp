#include "common/render/local_redraw.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(LocalRedraw, StaysOnWhereItIsFaster) {
  LocalRedraw local;
  EXPECT_TRUE(local.on());
  EXPECT_FALSE(local.drawn(100.0, true));
  for (int i = 0; i < 50; ++i) {
    EXPECT_FALSE(local.drawn(i % 5 == 4 ? 200.0 : 20.0, false)) << "single slow ones are no measure";
    EXPECT_TRUE(local.on());
  }
}

TEST(LocalRedraw, IsOffWhereItIsSlowerUntilTheViewIsAnother) {
  LocalRedraw local;
  (void)local.drawn(2.0, true);
  (void)local.drawn(2.1, false);
  (void)local.drawn(2.6, false);
  EXPECT_TRUE(local.on()) << "not judged by two";
  (void)local.drawn(2.0, false);
  EXPECT_FALSE(local.on()) << "no faster is slower: what it keeps takes memory";
  local.begin();
  EXPECT_TRUE(local.on());
}

TEST(LocalRedraw, KeepsAnewWhenMuchHasMoved) {
  LocalRedraw local;
  (void)local.drawn(100.0, true);
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(local.drawn(20.0, false));
  EXPECT_FALSE(local.drawn(61.0, false));
  EXPECT_FALSE(local.drawn(61.0, false));
  EXPECT_TRUE(local.drawn(61.0, false)) << "nearer to a full redraw than to what it began with";
  EXPECT_FALSE(local.drawn(100.0, true));
  EXPECT_FALSE(local.drawn(20.0, false));
  EXPECT_TRUE(local.on());
}

}  // namespace
}  // namespace palpate
