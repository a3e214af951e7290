// The live view answers this machine, by its own address, questions only, and as long as it lives.
#include "tools/vobench/live_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <httplib.h>
#include <ifaddrs.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

namespace vobench {
namespace {

using testing::HasSubstr;

struct Address {
  std::string host;
  int port = 0;
  std::string path;
};

Address AddressOf(const LiveServer& server) {
  std::smatch part;
  static const std::regex form("http://(127\\.0\\.0\\.1):(\\d+)(/[0-9a-f]{32}/)");
  if (!std::regex_match(server.address(), part, form)) {
    ADD_FAILURE() << server.address();
    return {};
  }
  return {part[1], std::stoi(part[2]), part[3]};
}

TEST(LiveServer, ServesWhatWasPublishedLast) {
  LiveServer server;
  const Address at = AddressOf(server);
  httplib::Client client(at.host, at.port);
  EXPECT_TRUE(server.Asked()) << "whoever looks first sees something soon";
  EXPECT_THAT(client.Get(at.path)->body, HasSubstr("Nothing to show yet"));
  server.Publish("page 1", "data 1");
  EXPECT_FALSE(server.Asked());
  server.Publish("page 2", "data 2");
  const auto page = client.Get(at.path), data = client.Get(at.path + "data");
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->body, "page 2");
  EXPECT_EQ(data->body, "data 2");
  EXPECT_TRUE(server.Asked());
  EXPECT_THAT(page->get_header_value("Content-Security-Policy"), HasSubstr("default-src 'none'"));
  EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(page->get_header_value("Referrer-Policy"), "no-referrer");
}

TEST(LiveServer, RefusesWhoDoesNotKnowTheToken) {
  LiveServer server, another;
  server.Publish("secret", "secret");
  const Address at = AddressOf(server), other = AddressOf(another);
  EXPECT_NE(at.path, other.path);
  httplib::Client client(at.host, at.port);
  std::string wrong = at.path;
  wrong[5] = wrong[5] == '0' ? '1' : '0';
  for (const std::string& path : {std::string("/"), wrong, other.path, at.path.substr(0, 20), at.path + "../",
                                  std::string("/data"), wrong + "data"}) {
    const auto answer = client.Get(path);
    EXPECT_EQ(answer->status, 404) << path;
    EXPECT_EQ(answer->body, "") << path;
  }
  // By another name, as a page elsewhere would that has its own name lead here.
  EXPECT_EQ(client.Get(at.path, {{"Host", "evil.example:" + std::to_string(at.port)}})->status, 404);
}

TEST(LiveServer, TakesNothing) {
  LiveServer server;
  const Address at = AddressOf(server);
  httplib::Client client(at.host, at.port);
  EXPECT_EQ(client.Post(at.path, "x", "text/plain")->status, 405);
  EXPECT_EQ(client.Put(at.path, "x", "text/plain")->status, 405);
  EXPECT_EQ(client.Delete(at.path)->status, 405);
  EXPECT_EQ(client.Patch(at.path + "data", "x", "text/plain")->status, 405);
  EXPECT_EQ(client.Options(at.path)->status, 405);
}

// The kernel's list of sockets that listen: address and port in hexadecimal.
std::set<std::string> ListeningAt(int port) {
  std::set<std::string> found;
  for (const char* file : {"/proc/net/tcp", "/proc/net/tcp6"}) {
    std::ifstream stream(file);
    for (std::string line; std::getline(stream, line);) {
      std::istringstream words(line);
      std::string number, local, remote, state;
      words >> number >> local >> remote >> state;
      const std::size_t colon = local.find(':');
      if (state != "0A" || colon == std::string::npos || std::stoi(local.substr(colon + 1), nullptr, 16) != port)
        continue;
      found.insert(local.substr(0, colon));
    }
  }
  return found;
}

TEST(LiveServer, ListensOnTheLoopbackInterfaceAlone) {
  LiveServer server;
  const Address at = AddressOf(server);
  EXPECT_THAT(ListeningAt(at.port), testing::ElementsAre("0100007F"));  // 127.0.0.1, least significant byte first
  ifaddrs* all = nullptr;
  ASSERT_EQ(getifaddrs(&all), 0);
  for (const ifaddrs* one = all; one != nullptr; one = one->ifa_next) {
    if (one->ifa_addr == nullptr || one->ifa_addr->sa_family != AF_INET) continue;
    char text[INET_ADDRSTRLEN];
    inet_ntop(AF_INET, &reinterpret_cast<const sockaddr_in*>(one->ifa_addr)->sin_addr, text, sizeof text);
    if (std::string(text).starts_with("127.")) continue;
    httplib::Client client(text, at.port);
    client.set_connection_timeout(2);
    EXPECT_FALSE(client.Get(at.path)) << text;
  }
  freeifaddrs(all);
}

TEST(LiveServer, EndsWithItsLife) {
  auto server = std::make_unique<LiveServer>();
  const Address at = AddressOf(*server);
  httplib::Client client(at.host, at.port);
  EXPECT_TRUE(client.Get(at.path));
  server.reset();
  httplib::Client late(at.host, at.port);
  EXPECT_FALSE(late.Get(at.path));
}

}  // namespace
}  // namespace vobench
