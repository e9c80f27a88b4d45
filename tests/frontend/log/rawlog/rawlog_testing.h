#pragma once

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose2D.h>
#include <mrpt/serialization/CArchive.h>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace loopgrid::test_support {

/// Collects the bytes of a rawlog.
class RawlogBytes {
 public:
  RawlogBytes& Add(const mrpt::serialization::CSerializable& object) {
    mrpt::io::CMemoryStream stream;
    auto archive = mrpt::serialization::archiveFrom(stream);
    archive.WriteObject(object);
    bytes_.append(static_cast<const char*>(stream.getRawBufferData()),
                  static_cast<std::size_t>(stream.getTotalBytesCount()));
    return *this;
  }
  RawlogBytes& AddMovement(const mrpt::poses::CPose2D& step) {
    mrpt::obs::CActionRobotMovement2D movement;
    movement.estimationMethod = mrpt::obs::CActionRobotMovement2D::emOdometry;
    movement.rawOdometryIncrementReading = step;
    mrpt::obs::CActionCollection actions;
    actions.insert(movement);
    return Add(actions);
  }
  RawlogBytes& AddFrame(const std::vector<mrpt::obs::CObservation2DRangeScan>& scans) {
    mrpt::obs::CSensoryFrame frame;
    for (const auto& scan : scans)
      frame.insert(std::make_shared<mrpt::obs::CObservation2DRangeScan>(scan));
    return Add(frame);
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A scan of a laser that looks 2 rad wide and 30 m far.
inline mrpt::obs::CObservation2DRangeScan Scan(const std::vector<float>& ranges,
                                               double time = 1.0) {
  mrpt::obs::CObservation2DRangeScan scan;
  scan.aperture = 2.0F;
  scan.maxRange = 30.0F;
  scan.timestamp = mrpt::Clock::fromDouble(time);
  scan.resizeScanAndAssign(ranges.size(), 0.0F, true);
  for (std::size_t i = 0; i < ranges.size(); ++i) scan.setScanRange(i, ranges[i]);
  return scan;
}

/// Three steps, each with a scan.
inline RawlogBytes SmallRawlog() {
  RawlogBytes bytes;
  for (int i = 0; i < 3; ++i) {
    bytes.AddMovement(mrpt::poses::CPose2D(0.5, 0.0, 0.1))
        .AddFrame({Scan({1.0F, 2.0F, 3.0F}, 5.0 + i)});
  }
  return bytes;
}

}  // namespace loopgrid::test_support
