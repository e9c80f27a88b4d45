#include "backend/solve/dog_leg_path.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <random>

namespace loopgrid {
namespace {

/// A random convex model 2 b^T x + x^T H x and its dog leg.
struct Model {
  explicit Model(unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    const auto draw = [&] { return normal(random); };
    const Eigen::MatrixXd root = Eigen::MatrixXd::NullaryExpr(6, 6, draw);
    H = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(6, 6);
    b = Eigen::VectorXd::NullaryExpr(6, draw);
    scale = H.diagonal();
    newton = H.llt().solve(-b);
    cauchy = -b.cwiseQuotient(scale);
    cauchy *= -b.dot(cauchy) / cauchy.dot(H * cauchy);
  }

  double operator()(const Eigen::VectorXd& x) const { return 2.0 * b.dot(x) + x.dot(H * x); }
  DogLegPath path() const { return DogLegPath(cauchy, newton, scale); }

  Eigen::MatrixXd H;
  Eigen::VectorXd b;
  Eigen::VectorXd scale;
  Eigen::VectorXd newton;
  Eigen::VectorXd cauchy;
};

TEST(DogLegPath, IsTheGaussNewtonStepWhereThatIsTrusted) {
  const Model model(1);
  const double length = model.path().Length(model.newton);
  EXPECT_EQ(model.path().PointWithin(std::numeric_limits<double>::infinity()), model.newton);
  EXPECT_EQ(model.path().PointWithin(length), model.newton);
  EXPECT_NE(model.path().PointWithin(0.999 * length), model.newton);
}

TEST(DogLegPath, GoesDownTheSteepestDescentFirst) {
  const Model model(2);
  const double length = model.path().Length(model.cauchy);
  const Eigen::VectorXd half = 0.5 * model.cauchy;
  EXPECT_TRUE(model.path().PointWithin(0.5 * length).isApprox(half, 1e-14));
  EXPECT_TRUE(model.path().PointWithin(length).isApprox(model.cauchy, 1e-14));
}

TEST(DogLegPath, ItsPointsAreAsLongAsAllowedAndTheModelFallsAlongIt) {
  for (unsigned seed = 1; seed <= 50; ++seed) {
    const Model model(seed);
    const DogLegPath path = model.path();
    const double whole = path.Length(model.newton);
    double last = 0.0;
    for (int k = 1; k <= 20; ++k) {
      const double radius = 0.05 * k * whole;
      const Eigen::VectorXd x = path.PointWithin(radius);
      EXPECT_NEAR(path.Length(x), radius, 1e-12 * whole) << "seed " << seed;
      EXPECT_LE(model(x), last + 1e-12) << "seed " << seed;
      last = model(x);
    }
    EXPECT_NEAR(last, model(model.newton), 1e-12 * std::abs(last));
  }
}

TEST(NextRadius, GrowsWhereTheModelIsRightAndShrinksWhereItIsNot) {
  EXPECT_EQ(NextRadius(2.0, 2.0, 1.0), 6.0);
  EXPECT_EQ(NextRadius(2.0, 0.1, 1.0), 2.0);  // the step was not at the edge
  EXPECT_EQ(NextRadius(2.0, 2.0, 0.5), 2.0);
  EXPECT_EQ(NextRadius(2.0, 2.0, 0.1), 1.0);
  EXPECT_EQ(NextRadius(std::numeric_limits<double>::infinity(), 4.0, -1.0), 1.0);
}

}  // namespace
}  // namespace loopgrid
