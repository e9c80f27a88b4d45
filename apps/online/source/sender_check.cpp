#include "apps/online/source/sender_check.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>

namespace loopgrid {
namespace {

// If the first two words are longer than this, the bytes are not from a log.
constexpr std::size_t kLongestStart = 8192;

constexpr std::string_view kNoProblem = "";
constexpr std::string_view kHttp = "it speaks HTTP, as web pages do";
constexpr std::string_view kNoLog = "what it sends does not begin as a log does";

/// First bytes of a connection that is not a log.
struct Magic {
  std::string_view bytes;
  std::string_view problem;
};

constexpr std::array<Magic, 2> kMagics = {{
    {"\x1F\x8B", "it sends gzipped data: unpack it on the way (gzip -dc)"},
    {"\x16\x03", "it speaks TLS, as web pages do"},
}};

/// The problem with a connection that begins with `start`; nothing if more bytes are needed to
/// decide.
std::optional<std::string_view> JudgeMagic(std::string_view start, const Magic& magic) {
  if (start.starts_with(magic.bytes)) return magic.problem;
  if (magic.bytes.starts_with(start)) return std::nullopt;
  return kNoProblem;
}

/// The same for HTTP: `METHOD TARGET HTTP/1.1`, or the `HTTP/1.1 200 OK` of a server.
std::optional<std::string_view> JudgeWords(std::string_view start) {
  constexpr Magic kProtocol = {"HTTP/", kHttp};
  if (start.starts_with(kProtocol.bytes)) return kHttp;
  const auto is_upper_case = [](char c) { return c >= 'A' && c <= 'Z'; };
  const auto method_end = std::find_if_not(start.begin(), start.end(), is_upper_case);
  const auto method_length = static_cast<std::size_t>(method_end - start.begin());
  if (method_length == start.size()) return std::nullopt;
  if (method_length == 0 || *method_end != ' ') return kNoProblem;
  const std::size_t target_end = start.find_first_of(" \r\n", method_length + 1);
  if (target_end == start.npos) return std::nullopt;
  if (start[target_end] != ' ') return kNoProblem;
  return JudgeMagic(start.substr(target_end + 1), kProtocol);
}

std::optional<std::string_view> Judge(std::string_view start) {
  for (const Magic& magic : kMagics) {
    const auto judgement = JudgeMagic(start, magic);
    if (judgement != kNoProblem) return judgement;
  }
  const auto judgement = JudgeWords(start);
  if (!judgement && start.size() > kLongestStart) return kNoLog;
  return judgement;
}

}  // namespace

std::string_view SenderCheck::Pass(std::string_view bytes) {
  if (!problem_.empty()) return {};
  if (judged_) return bytes;
  held_ += bytes;
  const auto judgement = Judge(held_);
  if (!judgement) return {};
  judged_ = true;
  problem_ = *judgement;
  return problem_.empty() ? std::string_view(held_) : std::string_view();
}

std::string_view SenderCheck::Rest() {
  if (std::exchange(judged_, true)) return {};
  return held_;
}

}  // namespace loopgrid
