#include <gnomon/io/box_finder.h>

#include <algorithm>
#include <limits>
#include <random>

#include <gtest/gtest.h>

namespace gnomon {
namespace {

TEST(BoxFinder, FindsWhatLookingAtAllBoxesFinds) {
  std::mt19937 random(7);
  for (const double spread : {10.0, 100.0, 5000.0}) {
    std::uniform_real_distribution<> place(0, spread), side(0, 20), wide(0, spread);
    std::vector<Bounds2> boxes;
    for (int k = 0; k < 300; ++k) {
      const double x = place(random), y = place(random);
      const bool large = k % 50 == 0;
      boxes.push_back({x, y, x + (large ? wide(random) : side(random)), y + side(random)});
    }
    boxes.push_back(boxes[5]);
    const BoxFinder finder(boxes);
    const auto even = [](std::size_t k) { return k % 2 == 0; };
    std::uniform_real_distribution<> asked(-spread, 2 * spread);
    for (int n = 0; n < 300; ++n) {
      const double x = asked(random), y = asked(random);
      std::size_t all = 0, of_even = 0;
      double least = std::numeric_limits<double>::infinity(), least_even = least;
      for (std::size_t k = 0; k < boxes.size(); ++k) {
        const double dx = std::max({boxes[k].x0 - x, 0.0, x - boxes[k].x1});
        const double dy = std::max({boxes[k].y0 - y, 0.0, y - boxes[k].y1});
        const double d = dx * dx + dy * dy;
        if (d < least) least = d, all = k;
        if (even(k) && d < least_even) least_even = d, of_even = k;
      }
      EXPECT_EQ(finder.nearest(x, y), all);
      EXPECT_EQ(finder.nearest(x, y, even), of_even);
    }
  }
}

TEST(BoxFinder, OfNoBoxesOrOfPointsIsNoTrouble) {
  EXPECT_FALSE(BoxFinder({}).nearest(1, 2));
  EXPECT_EQ(BoxFinder({{1, 1, 1, 1}}).nearest(1e9, -1e9), 0u);
  EXPECT_EQ(BoxFinder({{1, 1, 1, 1}, {1, 1, 1, 1}}).nearest(1, 1), 0u);
  EXPECT_FALSE(BoxFinder({{1, 1, 2, 2}}).nearest(1, 1, [](std::size_t) { return false; }));
}

}  // namespace
}  // namespace gnomon
