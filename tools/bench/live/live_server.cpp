#include "tools/bench/live/live_server.h"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <list>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "tools/bench/live/http_request.h"

namespace vobench {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::seconds;

constexpr std::size_t kMostDroppedBytes = 65536;

// Nobody may frame the page, guess at types, keep it or pass its address on.
constexpr const char* kHeaders =
    "Content-Security-Policy: default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src "
    "'unsafe-inline'; "
    "connect-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'\r\n"
    "X-Content-Type-Options: nosniff\r\n"
    "Referrer-Policy: no-referrer\r\n"
    "Cache-Control: no-store\r\n";

constexpr const char* kWaiting =
    "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"1\">"
    "<title>vobench</title></head><body><p>Nothing to show yet.</p></body></html>";

std::string Token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("--view: the system gives no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

// A file descriptor, closed at the end.
class Descriptor {
 public:
  explicit Descriptor(int file) : file_(file) {}
  Descriptor(Descriptor&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (file_ >= 0) close(file_);
  }
  int operator*() const { return file_; }

 private:
  int file_;
};

struct Connection {
  Descriptor socket;
  Clock::time_point until;  // then it is closed, whatever the client does
  std::string asked{};
  std::string answer{};
  std::size_t sent = 0;
  bool said = false;        // all of the answer: what still comes is read and dropped, until the client closes ...
  std::size_t dropped = 0;  // ... or has sent too much

  short Awaits() const { return answer.empty() || said ? POLLIN : POLLOUT; }
};

}  // namespace

class LiveServer::Loop {
 public:
  Loop() : listener_(socket(AF_INET, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)), wake_(eventfd(0, EFD_CLOEXEC)) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    auto* const at = reinterpret_cast<sockaddr*>(&address);
    if (*listener_ < 0 || *wake_ < 0 || bind(*listener_, at, size) != 0 || listen(*listener_, kMostConnections) != 0 ||
        getsockname(*listener_, at, &size) != 0) {
      throw std::runtime_error("--view: no port can be had on 127.0.0.1");
    }
    host_ = fmt::format("127.0.0.1:{}", ntohs(address.sin_port));
    thread_ = std::thread([this] { Run(); });
  }
  ~Loop() {
    eventfd_write(*wake_, 1);
    thread_.join();
  }
  Loop(const Loop&) = delete;
  Loop& operator=(const Loop&) = delete;

  std::string Address() const { return "http://" + host_ + path_; }
  bool asked() const { return asked_; }
  void Publish(std::string page, std::string data) {
    const std::lock_guard lock(mutex_);
    page_ = std::move(page);
    data_ = std::move(data);
    asked_ = false;
  }

 private:
  void Run() {
    for (;;) {
      std::vector<pollfd> files = {{*wake_, POLLIN, 0}};
      const bool room = connections_.size() < kMostConnections;
      files.push_back({room ? *listener_ : -1, POLLIN, 0});
      for (const Connection& connection : connections_) files.push_back({*connection.socket, connection.Awaits(), 0});
      poll(files.data(), files.size(), PatienceMs());
      if (files[0].revents != 0) return;
      std::size_t n = 2;
      const Clock::time_point now = Clock::now();
      for (auto at = connections_.begin(); at != connections_.end(); ++n) {
        const bool stays = now < at->until && (files[n].revents == 0 || Serve(*at));
        at = stays ? std::next(at) : connections_.erase(at);
      }
      if (files[1].revents != 0) Accept();
    }
  }

  // Until the first connection is due; for ever without one.
  int PatienceMs() const {
    if (connections_.empty()) return -1;
    const auto first = std::min_element(connections_.begin(), connections_.end(),
                                        [](const Connection& a, const Connection& b) { return a.until < b.until; });
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(first->until - Clock::now()).count();
    return static_cast<int>(std::max<std::int64_t>(0, left));
  }

  void Accept() {
    const int file = accept4(*listener_, nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC);
    if (file >= 0) connections_.push_back({Descriptor(file), Clock::now() + seconds(kRequestSeconds)});
    // No more files: rather than ask again at once, let those who are there come to their end.
    if (file < 0 && (errno == EMFILE || errno == ENFILE)) std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }

  // One step. Whether the connection goes on.
  bool Serve(Connection& connection) {
    if (connection.Awaits() == POLLIN) {
      char block[4096];
      const ssize_t got = recv(*connection.socket, block, sizeof block, 0);
      if (got < 0) return errno == EAGAIN || errno == EINTR;
      if (got == 0) return false;
      if (connection.said) return (connection.dropped += static_cast<std::size_t>(got)) < kMostDroppedBytes;
      connection.asked.append(block, static_cast<std::size_t>(got));
      const auto head = HeadLength(connection.asked);
      const bool too_long = head.value_or(connection.asked.size()) > kMostRequestBytes;
      if (!head && !too_long) return true;
      connection.answer = too_long ? Answer(431) : AnswerTo(std::string_view(connection.asked).substr(0, *head));
      connection.asked = {};
      connection.until = Clock::now() + seconds(kAnswerSeconds);
    }
    const std::string_view rest = std::string_view(connection.answer).substr(connection.sent);
    const ssize_t sent = send(*connection.socket, rest.data(), rest.size(), MSG_NOSIGNAL);
    if (sent < 0) return errno == EAGAIN || errno == EINTR;
    connection.sent += static_cast<std::size_t>(sent);
    if (connection.sent < connection.answer.size()) return true;
    // Closed at once, what the client has sent and nobody read would take the answer away from it.
    connection.said = true;
    return shutdown(*connection.socket, SHUT_WR) == 0;
  }

  static std::string Answer(int status, std::string_view more = "") {
    return AnswerHead(status, 0, std::string(kHeaders).append(more));
  }

  std::string AnswerTo(std::string_view head) {
    const std::optional<HttpRequest> request = ParseHead(head);
    if (!request) return Answer(400);
    if (request->method != "GET") return Answer(405, "Allow: GET\r\n");
    // Another name that leads here (DNS rebinding) is none of ours.
    const bool page = request->path == path_;
    if (request->host != host_ || (!page && request->path != path_ + "data")) return Answer(404);
    asked_ = true;
    const std::lock_guard lock(mutex_);
    const std::string& body = page ? page_ : data_;
    const char* type = page ? "text/html; charset=utf-8" : "application/json";
    return AnswerHead(200, body.size(), fmt::format("{}Content-Type: {}\r\n", kHeaders, type)) + body;
  }

  const std::string path_ = "/" + Token() + "/";
  std::string host_;
  Descriptor listener_, wake_;
  std::list<Connection> connections_;  // of the thread alone
  std::atomic<bool> asked_{true};
  std::mutex mutex_;  // of what follows
  std::string page_ = kWaiting, data_ = "{}";
  std::thread thread_;
};

LiveServer::LiveServer() : loop_(std::make_unique<Loop>()), address_(loop_->Address()) {}

LiveServer::~LiveServer() = default;

bool LiveServer::Asked() const { return loop_->asked(); }

void LiveServer::Publish(std::string page, std::string data) { loop_->Publish(std::move(page), std::move(data)); }

}  // namespace vobench
