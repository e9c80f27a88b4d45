#include "apps/view/http_message.h"

namespace loopgrid {

Reply Refusal(int status, std::string_view text) {
  Reply reply;
  reply.status = status;
  reply.body = std::make_shared<const std::string>(std::string(text) + '\n');
  reply.headers = {{"Cache-Control", "no-store"}};
  return reply;
}

}  // namespace loopgrid
