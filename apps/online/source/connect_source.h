#pragma once

#include <memory>
#include <string>

#include "apps/net/host_port.h"
#include "apps/online/source/line_source.h"

namespace loopgrid {

struct ConnectOptions {
  HostPort address;
  bool end_with_sender = false;  ///< the stream ends when a sender that sent something has left
  double first_pause = 0.1;      ///< seconds before the second attempt to connect; then doubled ...
  double longest_pause = 10.0;   ///< ... up to this, until something was received
};

/// Lines that are fetched over TCP. Where there is no connection, or none any more, another attempt
/// is made, for ever. The last line of each connection is given out as it is.
class ConnectSource : public LineSource {
 public:
  /// Throws Error (kUsage) for port 0. Nothing is dialled before Run().
  explicit ConnectSource(const ConnectOptions& options);
  ~ConnectSource() override;

  void Run(LineQueue* queue) override;
  void Stop() override;
  std::string name() const override;
  SourceCounters counters() const override;

 private:
  class Client;
  std::unique_ptr<Client> client_;
};

}  // namespace loopgrid
