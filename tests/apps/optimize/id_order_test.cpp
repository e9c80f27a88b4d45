#include "apps/optimize/id_order.h"

#include <gtest/gtest.h>

namespace loopgrid {
namespace {

TEST(IdOrder, NeighboursAreThoseWithNoIdBetweenThem) {
  const IdOrder order({10, 30, 20, -5, 1'000'000'000'000});
  EXPECT_TRUE(order.AreConsecutive(0, 2));  // 10 and 20
  EXPECT_TRUE(order.AreConsecutive(2, 0));
  EXPECT_TRUE(order.AreConsecutive(3, 0));
  EXPECT_TRUE(order.AreConsecutive(1, 4));
  EXPECT_FALSE(order.AreConsecutive(0, 1));  // 20 is between
  EXPECT_FALSE(order.AreConsecutive(3, 4));
  EXPECT_FALSE(order.AreConsecutive(2, 2));
}

}  // namespace
}  // namespace loopgrid
