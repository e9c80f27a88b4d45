#pragma once

#include <boost/asio/ip/tcp.hpp>
#include <memory>
#include <string>

#include "apps/view/view_routes.h"
#include "apps/view/view_server.h"

namespace loopgrid {

/// One HTTP connection of a ViewServer. It belongs to the operations that it waits for, and is gone
/// when none is left. All on the server's thread.
class ViewConnection {
 public:
  /// What a connection needs of its server.
  class Server {
   public:
    virtual ~Server() = default;
    virtual const ViewServerOptions& options() const = 0;
    virtual Reply Answer(const Request& request) = 0;
    virtual std::shared_ptr<const std::string> Snapshot() = 0;
    virtual void AddViewer(ViewConnection* viewer) = 0;
    virtual void CountSkip() = 0;
    virtual void Remove(ViewConnection* connection) = 0;
  };

  virtual ~ViewConnection() = default;

  /// News for a viewer. If too much is waiting for it already, it skips to a fresh state instead.
  virtual void Offer(const std::shared_ptr<const std::string>& news) = 0;
  virtual bool HasBacklog() const = 0;
};

/// Serves a client until it or we have had enough.
void StartConnection(boost::asio::ip::tcp::socket socket, ViewConnection::Server* server);

}  // namespace loopgrid
