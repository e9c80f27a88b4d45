#pragma once

#include <memory>
#include <string>

#include "apps/view/http_message.h"
#include "apps/view/view_options.h"

namespace boost::asio {
class io_context;
}

namespace loopgrid {

/// The content of an HTTP server. Called on the server's thread.
class HttpContent {
 public:
  virtual ~HttpContent() = default;

  virtual Reply Answer(const Request& request) = 0;

  /// Called once for each batch: the events since the last call, for all viewers; null if there are
  /// none.
  virtual std::shared_ptr<const std::string> TakeNews() = 0;

  /// The whole state as of the last batch, for a new viewer.
  virtual std::shared_ptr<const std::string> Snapshot() = 0;
};

/// A connected client. A client that follows events is a viewer.
class HttpClientConnection {
 public:
  virtual ~HttpClientConnection() = default;

  /// Sends events to a viewer. If too much is waiting to be sent, all of it is dropped, and the
  /// viewer gets a new snapshot instead.
  virtual void Offer(const std::shared_ptr<const std::string>& news) = 0;

  /// Whether something waits to be sent to a viewer.
  virtual bool HasBacklog() const = 0;
};

/// The functions of the service that its connections call.
class HttpHub {
 public:
  virtual ~HttpHub() = default;
  virtual const ViewServerOptions& options() const = 0;
  virtual HttpContent* content() = 0;

  /// From now on this client follows events.
  virtual void AddViewer(HttpClientConnection* viewer) = 0;

  /// Called once for each connection, when it ends.
  virtual void Remove(HttpClientConnection* connection) = 0;

  virtual void CountRequest() = 0;
  virtual void CountSkip() = 0;
};

/// Serves the client at the other end of `socket`, a descriptor that the connection owns from now
/// on, until the client leaves or breaks a limit. The work is done by the thread that runs `io`.
void ServeHttpClient(boost::asio::io_context* io, int socket, HttpHub* hub);

}  // namespace loopgrid
