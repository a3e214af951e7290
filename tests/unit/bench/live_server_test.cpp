// The live view answers this machine, by its own address, questions only, and as long as it lives; and whoever else
// connects, however much and however slowly he talks, takes nothing from the run but a file and a few kilobytes.
#include "tools/bench/live/live_server.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <httplib.h>
#include <ifaddrs.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <thread>
#include <vector>

namespace vobench {
namespace {

using testing::HasSubstr;
using testing::Not;

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

// A program that talks as no browser would.
class Peer {
 public:
  explicit Peer(const Address& at) : file_(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(at.port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{20, 0};
    setsockopt(file_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    setsockopt(file_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
    EXPECT_EQ(connect(file_, reinterpret_cast<const sockaddr*>(&address), sizeof address), 0);
  }
  ~Peer() { close(file_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  // Whether all of it went.
  bool Say(const std::string& text) const {
    return send(file_, text.data(), text.size(), MSG_NOSIGNAL) == static_cast<ssize_t>(text.size());
  }
  void End() const { shutdown(file_, SHUT_WR); }
  // All that comes until the other side closes.
  std::string Hear() const {
    std::string all;
    char block[4096];
    for (ssize_t got = 0; (got = recv(file_, block, sizeof block, 0)) > 0;)
      all.append(block, static_cast<std::size_t>(got));
    return all;
  }

 private:
  int file_;
};

double SecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Connections that this process has at the server's side.
std::size_t Served(int port) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/self/fd")) {
    const int file = std::stoi(entry.path().filename().string());
    sockaddr_in here{}, there{};
    socklen_t size = sizeof here;
    if (getsockname(file, reinterpret_cast<sockaddr*>(&here), &size) != 0 || here.sin_family != AF_INET) continue;
    size = sizeof there;
    count += ntohs(here.sin_port) == port && getpeername(file, reinterpret_cast<sockaddr*>(&there), &size) == 0;
  }
  return count;
}

double ResidentMegabytes() {
  std::ifstream stream("/proc/self/statm");
  double all = 0, resident = 0;
  stream >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) * 1e-6;
}

constexpr double kSoon_s = 1;  // a third of what a silent client is granted

TEST(LiveServer, StrangersMakeNoWork) {
  LiveServer server;
  const Address at = AddressOf(server);
  server.Publish("page", "data");
  httplib::Client client(at.host, at.port);
  EXPECT_EQ(client.Get("/")->status, 404);
  EXPECT_EQ(client.Get(at.path, {{"Host", "evil.example"}})->status, 404);
  EXPECT_EQ(client.Post(at.path)->status, 405);
  EXPECT_FALSE(server.Asked()) << "else the run would make a page for them";
}

TEST(LiveServer, ARequestThatNeverEndsIsCutOff) {
  LiveServer server;
  const Address at = AddressOf(server);
  const std::string megabyte(1 << 20, 'a');
  for (const std::string& begin : {"GET " + at.path + " HTTP/1.1\r\nX: ", std::string(), std::string("GET /")}) {
    const double before = ResidentMegabytes();
    const Peer peer(at);
    EXPECT_TRUE(peer.Say(begin));
    int taken = 0;
    while (taken < 64 && peer.Say(megabyte)) ++taken;
    EXPECT_LT(taken, 64) << "the connection is closed, and the rest has nowhere to go";
    EXPECT_LT(ResidentMegabytes() - before, 8);
  }
  // Many short headers, too.
  const Peer peer(at);
  peer.Say("GET " + at.path + " HTTP/1.1\r\n");
  std::string headers;
  while (headers.size() < 9000) headers += "X: y\r\n";
  peer.Say(headers);
  EXPECT_THAT(peer.Hear(), testing::StartsWith("HTTP/1.1 400 "));
  httplib::Client client(at.host, at.port);
  EXPECT_EQ(client.Get(at.path)->status, 200) << "others are served as before";
}

// No HTTP, half a request, two hosts: nothing is guessed at.
TEST(LiveServer, MalformedRequestsAreRefused) {
  LiveServer server;
  server.Publish("secret", "secret");
  const Address at = AddressOf(server);
  const std::string host = "Host: 127.0.0.1:" + std::to_string(at.port) + "\r\n";
  const auto answer = [&](const std::string& request) {
    const Peer peer(at);
    EXPECT_TRUE(peer.Say(request));
    peer.End();
    return peer.Hear();
  };
  EXPECT_THAT(answer("GET " + at.path + " HTTP/1.1\r\nhOST:  " + host.substr(6) + "\r\n"), HasSubstr("secret"));
  for (const std::string& request :
       {"\r\n\r\n" + host, "GET\r\n" + host + "\r\n", "GET " + at.path + "\r\n" + host + "\r\n",
        "GET " + at.path + " HTTP/2\r\n" + host + "\r\n", "\x16\x03\x01\r\n" + host + "\r\n",
        "GET " + at.path + " HTTP/1.1\r\n\r\n", "GET " + at.path + " HTTP/1.1\r\n" + host,
        "GET " + at.path + " HTTP/1.1\r\n" + host + host + "\r\n",
        "GET " + at.path + " HTTP/1.1\r\n" + host + "Host: b\r\n\r\n"}) {
    EXPECT_THAT(answer(request), Not(HasSubstr("secret"))) << request;
  }
}

TEST(LiveServer, SilentClients) {
  auto server = std::make_unique<LiveServer>();
  const Address at = AddressOf(*server);
  std::vector<std::unique_ptr<Peer>> slow;
  for (std::size_t n = 0; n + 1 < LiveServer::kMostConnections; ++n) {
    slow.push_back(std::make_unique<Peer>(at));
    slow.back()->Say("G");
  }
  httplib::Client client(at.host, at.port);
  EXPECT_LT(SecondsOf([&] { EXPECT_EQ(client.Get(at.path)->status, 200); }), kSoon_s);
  EXPECT_LT(SecondsOf([&] { server->Publish("page", "data"); }), kSoon_s);
  // A byte now and then buys no more time.
  const double lived_s = SecondsOf([&] {
    while (slow[0]->Say("E") && Served(at.port) > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
  });
  EXPECT_LT(lived_s, LiveServer::kRequestSeconds + kSoon_s);
  slow.push_back(std::make_unique<Peer>(at));
  slow.back()->Say("G");
  EXPECT_LT(SecondsOf([&] { server.reset(); }), kSoon_s) << "the end waits for no client";
}

TEST(LiveServer, DeafClient) {
  auto server = std::make_unique<LiveServer>();
  const Address at = AddressOf(*server);
  server->Publish(std::string(32 << 20, 'p'), "data");  // more than the kernel keeps for a socket
  const Peer deaf(at);
  EXPECT_TRUE(deaf.Say("GET " + at.path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(at.port) + "\r\n\r\n"));
  httplib::Client client(at.host, at.port);
  EXPECT_LT(SecondsOf([&] { EXPECT_EQ(client.Get(at.path + "data")->body, "data"); }), kSoon_s);
  EXPECT_EQ(client.Get(at.path)->body.size(), std::size_t{32} << 20);
  EXPECT_LT(SecondsOf([&] { server->Publish("page", "data"); }), kSoon_s);
  EXPECT_LT(SecondsOf([&] { server.reset(); }), kSoon_s);
}

TEST(LiveServer, ManyConnectionsTakeAFixedNumberOfFiles) {
  auto server = std::make_unique<LiveServer>();
  const Address at = AddressOf(*server);
  std::vector<std::unique_ptr<Peer>> crowd;
  for (std::size_t n = 0; n < LiveServer::kMostConnections; ++n) crowd.push_back(std::make_unique<Peer>(at));
  while (Served(at.port) < LiveServer::kMostConnections) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  for (std::size_t n = 0; n < LiveServer::kMostConnections; ++n) crowd.push_back(std::make_unique<Peer>(at));
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_EQ(Served(at.port), LiveServer::kMostConnections) << "the others wait in the kernel's queue";
  EXPECT_LT(SecondsOf([&] { server->Publish("page", "data"); }), kSoon_s);
  crowd.clear();
  httplib::Client client(at.host, at.port);
  EXPECT_LT(SecondsOf([&] { EXPECT_EQ(client.Get(at.path)->body, "page"); }), kSoon_s);
  EXPECT_LT(SecondsOf([&] { server.reset(); }), kSoon_s);
}

}  // namespace
}  // namespace vobench
