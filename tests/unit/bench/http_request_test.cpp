// Requests as RFC 9112 writes them, and what is none.
#include "tools/bench/live/http_request.h"

#include <gmock/gmock.h>

namespace vobench {
namespace {

TEST(HttpRequest, TheHeadEndsWithAnEmptyLine) {
  EXPECT_EQ(HeadLength(""), std::nullopt);
  EXPECT_EQ(HeadLength("GET / HTTP/1.1\r\nHost: a\r\n"), std::nullopt);
  EXPECT_EQ(HeadLength("GET / HTTP/1.1\r\n\r\nbody"), 18u);
}

TEST(HttpRequest, NamesMethodPathAndHost) {
  const auto request = ParseHead("GET /x/data HTTP/1.1\r\nAccept: */*\r\nhOST:  127.0.0.1:80\t\r\n\r\n");
  ASSERT_TRUE(request);
  EXPECT_EQ(request->method, "GET");
  EXPECT_EQ(request->path, "/x/data");
  EXPECT_EQ(request->host, "127.0.0.1:80");
  EXPECT_EQ(ParseHead("GET / HTTP/1.0\r\n\r\n")->host, "");
}

TEST(HttpRequest, WhatIsNoneIsNotGuessedAt) {
  for (const char* head : {"\r\n\r\n", "GET\r\n\r\n", "GET /\r\n\r\n", "GET / HTTP/2\r\n\r\n", "\x16\x03\x01\r\n\r\n",
                           "GET / HTTP/1.1\r\nno colon\r\n\r\n", "GET / HTTP/1.1\r\nHost: a\r\nHost: b\r\n\r\n"}) {
    EXPECT_FALSE(ParseHead(head)) << head;
  }
}

TEST(HttpRequest, AnAnswerSaysHowLongItIsAndEndsTheConnection) {
  EXPECT_EQ(AnswerHead(405, 0, "Allow: GET\r\n"),
            "HTTP/1.1 405 Method Not Allowed\r\nContent-Length: 0\r\nConnection: close\r\nAllow: GET\r\n\r\n");
  EXPECT_THAT(AnswerHead(200, 12, ""), testing::HasSubstr("Content-Length: 12\r\n"));
}

}  // namespace
}  // namespace vobench
