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
  double silence = 10.0;         ///< seconds without a line before a sender may lose its place
};

/// Lines that arrive over TCP, from one sender at a time. Others are turned away at once (their
/// connection is closed), with two exceptions. One that comes after the sender has closed its side,
/// while not all was read yet, is the next sender. And a sender that completes no line for a while
/// loses its place to the next one that connects, for it may be dead. A sender whose first bytes
/// are no log (see SenderCheck) is turned away as well. The last line of each sender is given out
/// even if it has no end.
class ListenSource : public LineSource {
 public:
  /// Listens from now on. Throws Error (kInput) if the address cannot be had.
  explicit ListenSource(const ListenOptions& options);
  ~ListenSource() override;

  void Run(LineQueue* queue) override;
  void Stop() override;
  /// The address with the real port.
  std::string name() const override;
  SourceCounters counters() const override;
  std::vector<std::string> TakeNotices() override;

  /// The real one.
  int port() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace loopgrid
