#include "tests/support/office_world.h"

#include <array>
#include <cmath>
#include <numbers>

namespace loopgrid::test_support {
namespace {

constexpr double kWallThickness = 0.12;
constexpr double kDoorWidth = 1.0;

// A wall along an axis from `from` to `to`, with open doors centred `doors` metres from `from`.
void AddWall(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
             const std::vector<double>& doors, World* world) {
  const double length = (to - from).norm();
  const Eigen::Vector2d along = (to - from) / length;
  const Eigen::Vector2d thickness = kWallThickness * Eigen::Vector2d(along.y(), along.x());
  const auto add_piece = [&](double begin, double end) {
    const Eigen::Vector2d size = ((end - begin) * along + thickness).cwiseAbs();
    world->AddBox(from + 0.5 * (begin + end) * along, size);
  };
  double begin = 0.0;
  for (double door : doors) {
    add_piece(begin, door - 0.5 * kDoorWidth);
    begin = door + 0.5 * kDoorWidth;
  }
  add_piece(begin, length);
}

void AddColumn(const Eigen::Vector2d& centre, double radius, World* world) {
  std::array<Eigen::Vector2d, 12> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const double angle = 2.0 * std::numbers::pi * static_cast<double>(i) / corners.size();
    corners[i] = centre + radius * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  world->AddPolygon(corners);
}

void AddWalls(World* world) {
  // The outer walls.
  AddWall({0.0, 0.0}, {32.0, 0.0}, {}, world);
  AddWall({0.0, 22.0}, {32.0, 22.0}, {}, world);
  AddWall({0.0, 0.0}, {0.0, 22.0}, {}, world);
  AddWall({32.0, 0.0}, {32.0, 22.0}, {}, world);
  // Between the corridor and the outer rooms. The east side has a window front of glass.
  AddWall({0.0, 6.0}, {32.0, 6.0}, {2.5, 9.0, 15.5, 21.0, 28.5}, world);
  AddWall({0.0, 16.0}, {32.0, 16.0}, {3.5, 11.0, 18.0, 24.5, 29.0}, world);
  AddWall({6.0, 6.0}, {6.0, 16.0}, {5.5}, world);
  AddWall({26.0, 6.0}, {26.0, 10.0}, {2.0}, world);
  world->AddBox({26.0, 12.0}, {kWallThickness, 4.0}, 0.0, true);
  AddWall({26.0, 14.0}, {26.0, 16.0}, {}, world);
  // Between the outer rooms.
  for (double x : {6.0, 12.0, 18.5, 24.5}) AddWall({x, 0.0}, {x, 6.0}, {}, world);
  for (double x : {7.0, 14.0, 21.5, 27.0}) AddWall({x, 16.0}, {x, 22.0}, {}, world);
  AddWall({26.0, 11.0}, {32.0, 11.0}, {}, world);
  // The core: two rooms.
  AddWall({8.0, 8.0}, {24.0, 8.0}, {4.0}, world);
  AddWall({8.0, 14.0}, {24.0, 14.0}, {12.0}, world);
  AddWall({8.0, 8.0}, {8.0, 14.0}, {}, world);
  AddWall({24.0, 8.0}, {24.0, 14.0}, {}, world);
  AddWall({15.0, 8.0}, {15.0, 14.0}, {}, world);
}

void AddFurniture(World* world) {
  struct Piece {
    double x, y, width, depth, angle;
  };
  constexpr Piece kPieces[] = {// Desks and cupboards of the southern rooms,
                               {0.5, 3.0, 0.8, 1.8, 0.0},
                               {4.5, 0.7, 1.6, 0.8, 0.0},
                               {7.0, 1.0, 1.6, 0.8, 0.3},
                               {11.3, 2.5, 0.7, 2.2, 0.0},
                               {13.2, 0.6, 1.8, 0.8, 0.0},
                               {17.6, 1.5, 1.2, 0.6, 1.0},
                               {19.2, 3.5, 0.6, 1.5, 0.0},
                               {23.3, 1.2, 1.8, 0.8, -0.5},
                               {26.0, 0.8, 2.2, 0.9, 0.0},
                               {30.9, 3.6, 0.8, 2.0, 0.0},
                               // of the northern ones,
                               {1.0, 20.9, 1.6, 0.9, 0.0},
                               {5.9, 18.5, 0.8, 1.8, 0.2},
                               {8.5, 21.2, 2.0, 0.8, 0.0},
                               {13.0, 18.8, 0.9, 1.6, 0.0},
                               {16.0, 20.5, 2.4, 1.1, 0.6},
                               {20.6, 17.8, 0.8, 1.4, 0.0},
                               {22.6, 21.0, 1.4, 0.8, 0.0},
                               {28.0, 20.6, 1.0, 1.8, 0.0},
                               {31.2, 18.2, 0.8, 1.6, 0.0},
                               // of the west and the east,
                               {0.9, 8.0, 1.0, 2.0, 0.0},
                               {3.4, 14.9, 1.8, 0.8, 0.1},
                               {1.5, 11.5, 1.4, 1.0, 0.8},
                               {30.8, 7.6, 1.0, 1.6, 0.0},
                               {29.5, 14.5, 2.0, 0.9, -0.3},
                               // and of the core; a copier and a cupboard stand in the corridor.
                               {9.2, 12.8, 1.6, 0.8, 0.0},
                               {13.8, 9.3, 0.8, 1.5, 0.0},
                               {17.0, 9.2, 2.2, 1.0, 0.4},
                               {22.8, 12.4, 0.9, 2.0, 0.0},
                               {16.5, 6.35, 1.1, 0.5, 0.0},
                               {25.65, 14.9, 0.4, 0.9, 0.0}};
  for (const Piece& piece : kPieces) {
    world->AddBox({piece.x, piece.y}, {piece.width, piece.depth}, piece.angle);
  }
  AddColumn({6.45, 15.5}, 0.2, world);
  AddColumn({25.5, 6.5}, 0.2, world);
  AddColumn({29.0, 9.5}, 0.25, world);
}

}  // namespace

World OfficeWorld() {
  World world;
  AddWalls(&world);
  AddFurniture(&world);
  return world;
}

std::vector<Eigen::Vector2d> OfficeRoute() {
  // clang-format off
  return {
      // East along the southern corridor, with two rooms.
      {7.0, 7.0}, {9.0, 7.0}, {9.0, 3.5}, {9.5, 4.5}, {9.0, 5.0}, {9.0, 7.0}, {15.5, 7.1},
      {15.5, 3.0}, {14.5, 4.0}, {15.5, 5.0}, {15.5, 7.0}, {21.0, 7.0}, {25.0, 7.2},
      // North along the eastern one, with the room behind its door.
      {25.0, 8.0}, {28.0, 8.0}, {28.0, 9.0}, {27.0, 8.0}, {25.0, 8.0}, {25.0, 14.5},
      // West along the northern one: a room of the core and two in the north.
      {24.0, 15.0}, {20.0, 15.0}, {20.0, 11.5}, {19.0, 11.0}, {20.0, 12.5}, {20.0, 15.0},
      {18.0, 15.0}, {18.0, 18.5}, {16.0, 18.0}, {18.0, 17.0}, {18.0, 15.0}, {11.0, 15.0},
      {11.0, 19.0}, {10.0, 18.0}, {11.0, 17.0}, {11.0, 15.0}, {7.2, 14.8},
      // South along the western one, with the big room, and the loop is closed.
      {7.0, 11.5}, {3.5, 11.5}, {3.0, 10.0}, {4.5, 11.5}, {7.0, 11.5}, {7.0, 7.5}, {8.0, 6.9},
      // Over known ground again, and two rooms that were passed the first time.
      {12.0, 7.0}, {12.0, 10.5}, {11.0, 11.0}, {12.0, 9.0}, {12.0, 7.0}, {21.0, 7.1},
      {21.0, 4.0}, {22.0, 3.5}, {21.0, 5.0}, {21.0, 7.0}, {25.0, 7.3}, {25.0, 12.0}};
  // clang-format on
}

SimulatedRun OfficeRun() {
  SimulationOptions options;
  options.seed = 20101210;
  return Simulate(OfficeWorld(), OfficeRoute(), options);
}

}  // namespace loopgrid::test_support
