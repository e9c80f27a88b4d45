#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/net/host_port.h"
#include "apps/online/source/line_source.h"

namespace loopgrid {

struct ListenOptions {
  HostPort address;              ///< port 0: any that is free
  bool end_with_sender = false;  ///< the stream ends when a sender that sent something has left
  double silence = 10.0;         ///< seconds without a line before another sender may replace it
};

/// Lines that arrive over TCP, from one sender at a time. The connections of others are closed at
/// once, with two exceptions. If the sender has closed its side and not all of its bytes are read
/// yet, the one that connects is the next sender. If the sender has completed no line for some
/// time, it may be dead, and the one that connects replaces it. A sender whose first bytes are no
/// log (see SenderCheck) is refused. The last line of each sender is passed on even if it has no
/// end.
class ListenSource : public LineSource {
 public:
  /// Begins to listen. Throws Error (kInput) if that is not possible at this address.
  explicit ListenSource(const ListenOptions& options);
  ~ListenSource() override;

  void Run(LineQueue* queue) override;
  void Stop() override;
  /// The address with the real port.
  std::string name() const override;
  SourceCounters counters() const override;
  std::vector<std::string> TakeNotices() override;

  /// The real port.
  int port() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace loopgrid
