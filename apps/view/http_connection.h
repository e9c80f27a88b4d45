#pragma once

#include <memory>
#include <string>

#include "apps/view/http_message.h"
#include "apps/view/view_options.h"

namespace boost::asio {
class io_context;
}

namespace loopgrid {

/// What an HTTP server serves. It is asked on the server's thread.
class HttpContent {
 public:
  virtual ~HttpContent() = default;

  virtual Reply Answer(const Request& request) = 0;

  /// Called once a batch: what has happened since, for all that follow events; null if nothing.
  virtual std::shared_ptr<const std::string> TakeNews() = 0;

  /// The state as of the last news, for a viewer that knows nothing.
  virtual std::shared_ptr<const std::string> Snapshot() = 0;
};

/// A client, which may follow events.
class HttpClientConnection {
 public:
  virtual ~HttpClientConnection() = default;

  /// Sends news to a viewer. If too much waits for it already, all of that is dropped, and the
  /// viewer gets a fresh snapshot instead.
  virtual void Offer(const std::shared_ptr<const std::string>& news) = 0;

  /// Whether something waits to be sent to a viewer.
  virtual bool HasBacklog() const = 0;
};

/// What connections need of the service that they belong to.
class HttpHub {
 public:
  virtual ~HttpHub() = default;
  virtual const ViewServerOptions& options() const = 0;
  virtual HttpContent* content() = 0;

  /// From now on this client follows events.
  virtual void AddViewer(HttpClientConnection* viewer) = 0;

  /// The connection is gone. Called once for each connection.
  virtual void Remove(HttpClientConnection* connection) = 0;

  virtual void CountRequest() = 0;
  virtual void CountSkip() = 0;
};

/// Serves the client at the other end of `socket`, a descriptor that the connection owns from now
/// on, until the client leaves or breaks a limit. The work is done by the thread that runs `io`.
void ServeHttpClient(boost::asio::io_context* io, int socket, HttpHub* hub);

}  // namespace loopgrid
