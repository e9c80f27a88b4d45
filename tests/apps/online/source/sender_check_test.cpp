#include "apps/online/source/sender_check.h"

#include <gtest/gtest.h>

#include <string>

#include "backend/base/gzip.h"

namespace loopgrid {
namespace {

constexpr std::size_t kPieces[] = {1, 3, 100'000};

/// The bytes passed on from a connection that sends `bytes` in pieces of a size and then closes.
std::string PassedOn(const std::string& bytes, std::size_t piece, std::string* problem) {
  SenderCheck check;
  std::string passed;
  for (std::size_t i = 0; i < bytes.size(); i += piece) {
    passed += check.Pass(std::string_view(bytes).substr(i, piece));
  }
  passed += check.Rest();
  *problem = check.problem();
  return passed;
}

TEST(SenderCheck, RefusesWhatIsNoLogAndPassesNothingOn) {
  const std::string rest = "Host: x\r\n\r\nFLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\n";
  const std::pair<std::string, std::string> senders[] = {
      {"GET / HTTP/1.1\r\n" + rest, "HTTP"},
      {"POST /map?x=1 HTTP/1.0\r\n" + rest, "HTTP"},
      {"OPTIONS * HTTP/1.1\n" + rest, "HTTP"},
      {"CONNECT 127.0.0.1:7070 HTTP/1.1\r\n" + rest, "HTTP"},
      {"PRI * HTTP/2.0\r\n" + rest, "HTTP"},
      {"HTTP/1.1 400 Bad Request\r\n" + rest, "HTTP"},
      {"POST /" + std::string(7'000, 'x') + " HTTP/1.1\r\n" + rest, "HTTP"},
      {"POST /" + std::string(500'000, 'x') + " HTTP/1.1\r\n" + rest, "does not begin as a log"},
      {Gzip("FLASER"), "gzip -dc"},
      {"\x16\x03\x01\x02\nFLASER", "TLS"}};
  for (const auto& [bytes, problem] : senders) {
    for (const std::size_t piece : kPieces) {
      SCOPED_TRACE(bytes.substr(0, 30) + " in pieces of " + std::to_string(piece));
      std::string told;
      EXPECT_EQ(PassedOn(bytes, piece, &told), "");
      EXPECT_NE(told.find(problem), std::string::npos) << told;
    }
  }
}

TEST(SenderCheck, PassesOnEverythingElse) {
  for (const std::string bytes : {"FLASER 3 1 2 3 0 0 0 0 0 0 1 h 1\nGET / HTTP/1.1\n",
                                  "PARAM robot_name x HTTP/1.1\n",
                                  "# GET / HTTP/1.1\n",
                                  "GET /\nFLASER\n",
                                  "GET",
                                  "GET ",
                                  "GET /",
                                  "GET / ",
                                  "GET / HTTP",
                                  "HTTP",
                                  "GET / HTTX/1.1\n",
                                  "GET /\r\nHTTP/1.1\n",
                                  "\x1F",
                                  "\x1Fx",
                                  "\x16",
                                  "\x16x",
                                  "\n",
                                  "get / http/1.1\n",
                                  "\xEF\xBB\xBF# a log\n",
                                  "",
                                  "ODOM\n",
                                  "1.0 2.0\n"}) {
    for (const std::size_t piece : kPieces) {
      SCOPED_TRACE(bytes + " in pieces of " + std::to_string(piece));
      std::string told;
      EXPECT_EQ(PassedOn(bytes, piece, &told), bytes);
      EXPECT_EQ(told, "");
    }
  }
}

TEST(SenderCheck, PassesALogOnAsSoonAsItIsKnownAndHoldsLittle) {
  SenderCheck log;
  EXPECT_EQ(log.Pass("FLASER 3"), "");
  EXPECT_TRUE(log.holds_bytes());
  EXPECT_EQ(log.Pass(" 1"), "FLASER 3 1");
  EXPECT_FALSE(log.holds_bytes());
  EXPECT_EQ(log.Pass(" 2"), " 2");
  EXPECT_EQ(log.Rest(), "");
  SenderCheck endless;
  for (int i = 0; i < 100; ++i) EXPECT_EQ(endless.Pass("X" + std::string(1000, 'X')), "");
  EXPECT_NE(endless.problem(), "");
}

}  // namespace
}  // namespace loopgrid
