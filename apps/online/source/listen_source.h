#pragma once

#include <memory>
#include <string>

#include "apps/net/host_port.h"
#include "apps/online/source/line_source.h"

namespace loopgrid {

struct ListenOptions {
  HostPort address;              ///< port 0: any that is free
  bool end_with_sender = false;  ///< the stream ends when a sender that sent something has left
  double silence = 10.0;         ///< seconds without a line before a sender may lose its place
};

/// Lines that arrive over TCP, from one sender at a time. Others are turned away at once (their
/// connection is closed), with two exceptions: one who comes when the sender has said its last
/// (though not all of it was read yet) is the next; and a sender that completes no line for a while
/// loses its place to whoever wants it, for it may be long dead, or up to no good. The last line of
/// each is given out as it is.
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

  /// The real one.
  int port() const;

 private:
  class Server;
  std::unique_ptr<Server> server_;
};

}  // namespace loopgrid
