#include "tests/support/carmen_text.h"

#include <gtest/gtest.h>

#include <string>

#include "backend/base/input_file.h"
#include "frontend/evaluation/tum_file.h"
#include "frontend/log/open_log.h"
#include "tests/support/memory_file.h"
#include "tests/support/office_world.h"

namespace loopgrid::test_support {
namespace {

std::string ReadAll(const std::string& path) {
  InputFile file(path);
  std::string content;
  std::string block(1 << 16, '\0');
  while (const std::size_t count = file.Read(block.data(), block.size())) {
    content.append(block, 0, count);
  }
  return content;
}

void ExpectReadsBack(const SimulatedRun& run, CarmenDialect dialect) {
  const MemoryFile file(CarmenText(run, dialect));
  const auto reader = OpenLog(file.path(), {.strict = true});
  Observation read;
  for (const Observation& written : run.observations) {
    ASSERT_TRUE(reader->Next(&read));
    EXPECT_NEAR(read.timestamp, written.timestamp, 1e-6);
    EXPECT_LT(read.T_odom_robot.Boxminus(written.T_odom_robot).norm(), 3e-6);
    EXPECT_LT(read.scan.T_robot_laser.Boxminus(written.scan.T_robot_laser).norm(), 1e-5);
    EXPECT_NEAR(read.scan.first_angle, written.scan.first_angle, 1e-6);
    EXPECT_NEAR(read.scan.angle_step, written.scan.angle_step, 1e-6);
    EXPECT_EQ(read.scan.ranges, written.scan.ranges);
  }
  EXPECT_FALSE(reader->Next(&read));
}

TEST(CarmenText, ReadsBackInBothDialects) {
  const SimulatedRun run = OfficeRun();
  ExpectReadsBack(run, CarmenDialect::kFlaser);
  ExpectReadsBack(run, CarmenDialect::kRobotLaser1);
}

TEST(SimulatedLog, IsWhatTheProgramMakes) {
  const std::string logs = LOOPGRID_SOURCE_DIR "/logs/";
  const SimulatedRun run = OfficeRun();
  // EXPECT_EQ would print a megabyte if they differ.
  EXPECT_TRUE(ReadAll(logs + "simulated-office.clf.gz") == CarmenText(run, CarmenDialect::kFlaser));
  EXPECT_TRUE(ReadAll(logs + "simulated-office.tum") == TrueTrajectoryText(run));
}

TEST(SimulatedLog, TruthIsTheTruePosesOfItsScans) {
  const SimulatedRun run = OfficeRun();
  const Trajectory truth = ReadTumFile(LOOPGRID_SOURCE_DIR "/logs/simulated-office.tum");
  ASSERT_EQ(truth.size(), run.true_poses.size());
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_NEAR(truth[i].timestamp, run.observations[i].timestamp, 1e-6);
    EXPECT_LT(truth[i].pose.Boxminus(run.true_poses[i]).norm(), 3e-6);
  }
}

}  // namespace
}  // namespace loopgrid::test_support
