#include "apps/view/view_routes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <utility>

#include "apps/view/view_page.h"
#include "backend/base/parse_number.h"

namespace loopgrid {
namespace {

// An output file that is served while mapping goes on.
struct ServedFile {
  std::string_view name;
  std::string_view type;
};

constexpr std::array<ServedFile, 6> kFiles = {{
    {"map.png", "image/png"},
    {"map.pgm", "image/x-portable-graymap"},
    {"map.yaml", "application/yaml"},
    {"graph.g2o", "text/plain; charset=utf-8"},
    {"trajectory.tum", "text/plain; charset=utf-8"},
    {"status.json", "application/json"},
}};

constexpr std::string_view kTiles = "/tiles/";

std::shared_ptr<const std::string> Shared(std::string_view text) {
  return std::make_shared<const std::string>(text);
}

// "1/-2/3.png" -> level 1, x = -2, y = 3.
bool ParseTile(std::string_view path, TileId* id) {
  constexpr std::string_view kEnd = ".png";
  const std::size_t first = path.find('/');
  const std::size_t second = path.find('/', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos) return false;
  if (!path.ends_with(kEnd)) return false;
  path.remove_suffix(kEnd.size());
  return second < path.size() && ParseNumber(path.substr(0, first), &id->level) &&
         ParseNumber(path.substr(first + 1, second - first - 1), &id->x) &&
         ParseNumber(path.substr(second + 1), &id->y);
}

}  // namespace

ViewRoutes::ViewRoutes(std::string run, HostCheck hosts, const MapTiles* tiles,
                       const PublishedFiles* files)
    : run_(std::move(run)), hosts_(std::move(hosts)), tiles_(tiles), files_(files) {}

Reply ViewRoutes::Answer(const Request& request) const {
  Reply reply = Dispatch(request);
  reply.headers.insert(reply.headers.end(),
                       {{"Content-Security-Policy", std::string(ViewPagePolicy())},
                        {"X-Content-Type-Options", "nosniff"},
                        {"Referrer-Policy", "no-referrer"},
                        {"Cross-Origin-Resource-Policy", "same-origin"}});
  return reply;
}

Reply ViewRoutes::Dispatch(const Request& request) const {
  if (!hosts_.Accepts(request.host)) {
    return Refusal(403, "this server answers to names of this machine only");
  }
  if (request.method != "GET" && request.method != "HEAD") {
    Reply reply = Refusal(405, "only GET and HEAD");
    reply.headers.emplace_back("Allow", "GET, HEAD");
    return reply;
  }
  const std::size_t mark = std::min(request.target.find('?'), request.target.size());
  const std::string_view path = request.target.substr(0, mark);
  const std::string_view query = request.target.substr(std::min(mark + 1, request.target.size()));
  Reply reply;
  if (path == "/") {
    reply.type = "text/html; charset=utf-8";
    reply.body = Shared(ViewPage());
    reply.headers = {{"Cache-Control", "no-cache"}};
    return reply;
  }
  if (path == "/events") {
    reply.type = "text/event-stream";
    reply.headers = {{"Cache-Control", "no-store"}};
    reply.follows_events = true;
    return reply;
  }
  if (path.starts_with(kTiles)) {
    return Tile(path.substr(kTiles.size()), query, request.if_none_match);
  }
  for (const ServedFile& file : kFiles) {
    if (path.starts_with('/') && path.substr(1) == file.name) return File(file.name, file.type);
  }
  return Refusal(404, "there is nothing here; the page is at /");
}

Reply ViewRoutes::File(std::string_view name, std::string_view type) const {
  Reply reply;
  reply.body = files_->Get(std::string(name));
  if (reply.body == nullptr) {
    reply = Refusal(503, fmt::format("there is no {} yet", name));
    reply.headers.emplace_back("Retry-After", "1");
    return reply;
  }
  reply.type = type;
  reply.headers = {{"Cache-Control", "no-store"}};
  return reply;
}

// If a tile is asked for with its version, the client may keep it, because the next version has
// another address.
Reply ViewRoutes::Tile(std::string_view path, std::string_view query,
                       std::string_view if_none_match) const {
  TileId id;
  std::uint64_t version = 0;
  Reply reply;
  if (ParseTile(path, &id)) reply.body = tiles_->Png(id, &version);
  if (reply.body == nullptr) return Refusal(404, "there is no such tile");
  const std::string tag = fmt::format("{}.{}", run_, version);
  reply.type = "image/png";
  reply.headers = {
      {"ETag", fmt::format("\"{}\"", tag)},
      {"Cache-Control", query == "v=" + tag ? "private, max-age=86400, immutable" : "no-cache"}};
  if (if_none_match == fmt::format("\"{}\"", tag)) {
    reply.status = 304;
    reply.body = nullptr;
  }
  return reply;
}

}  // namespace loopgrid
