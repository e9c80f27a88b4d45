#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/net/host_port.h"
#include "apps/online/source/line_source.h"

namespace loopgrid {

struct ConnectOptions {
  HostPort address;
  bool end_with_sender = false;  ///< the stream ends when a sender that sent something has left
  double first_pause = 0.1;      ///< seconds before the second attempt to connect; then doubled ...
  double longest_pause = 10.0;   ///< ... up to this, until something was received
};

/// Lines that are fetched over TCP. While there is no connection, further attempts are made without
/// end. A sender whose first bytes are no log (see SenderCheck) is disconnected and counts as a
/// failed attempt. The last line of each connection is passed on even if it has no end.
class ConnectSource : public LineSource {
 public:
  /// Throws Error (kUsage) for port 0. Run() makes the first attempt.
  explicit ConnectSource(const ConnectOptions& options);
  ~ConnectSource() override;

  void Run(LineQueue* queue) override;
  void Stop() override;
  std::string name() const override;
  SourceCounters counters() const override;
  std::vector<std::string> TakeNotices() override;

 private:
  class Client;
  std::unique_ptr<Client> client_;
};

}  // namespace loopgrid
