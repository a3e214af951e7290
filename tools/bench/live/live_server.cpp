#include "tools/bench/live/live_server.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <httplib.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <mutex>
#include <semaphore>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tools/base/child_process.h"
#include "tools/base/files.h"

namespace vobench {
namespace {

constexpr std::size_t kMostDroppedBytes = 65536;

constexpr const char* kWaiting =
    "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><meta http-equiv=\"refresh\" content=\"1\">"
    "<title>vobench</title></head><body><p>Nothing to show yet.</p></body></html>";

// Nobody may frame the page, guess at types, keep it or pass its address on.
httplib::Headers SafeHeaders() {
  return {{"Content-Security-Policy",
           "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src "
           "'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
          {"X-Content-Type-Options", "nosniff"},
          {"Referrer-Policy", "no-referrer"},
          {"Cache-Control", "no-store"}};
}

std::string Token() {
  std::array<unsigned char, 16> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("--view: the system gives no random numbers");
  }
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

// One connection with bounds on its time and on the length of its request, which httplib's own does not have.
class Connection : public httplib::Stream {
 public:
  // `stop` becomes readable when the server ends.
  Connection(int socket, int stop) : socket_(socket), stop_(stop) {}

  bool is_readable() const override { return true; }
  bool is_writable() const override { return true; }
  ssize_t read(char* to, std::size_t size) override {
    if (at_ == end_) {
      if (received_ > LiveServer::kMostRequestBytes || !Await(POLLIN)) return -1;
      const ssize_t got = recv(*socket_, block_.data(), block_.size(), MSG_DONTWAIT);
      if (got <= 0) return got;
      received_ += static_cast<std::size_t>(got);
      at_ = block_.data();
      end_ = at_ + got;
    }
    const std::size_t count = std::min(size, static_cast<std::size_t>(end_ - at_));
    std::copy_n(at_, count, to);
    at_ += count;
    return static_cast<ssize_t>(count);
  }
  ssize_t write(const char* from, std::size_t size) override {
    if (!std::exchange(answers_, true)) until_ = base::After(LiveServer::kAnswerSeconds);
    for (std::size_t sent = 0; sent < size;) {
      if (!Await(POLLOUT)) return -1;
      const ssize_t more = send(*socket_, from + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
      if (more < 0 && errno != EAGAIN) return -1;
      if (more > 0) sent += static_cast<std::size_t>(more);
    }
    return static_cast<ssize_t>(size);
  }
  void get_remote_ip_and_port(std::string&, int&) const override {}
  void get_local_ip_and_port(std::string&, int&) const override {}
  socket_t socket() const override { return *socket_; }

  // Reads and drops what the client still sends: a close before would take the answer away from it.
  void Finish() {
    shutdown(*socket_, SHUT_WR);
    for (std::size_t dropped = 0; dropped < kMostDroppedBytes && Await(POLLIN);) {
      const ssize_t got = recv(*socket_, block_.data(), block_.size(), MSG_DONTWAIT);
      if (got <= 0) return;
      dropped += static_cast<std::size_t>(got);
    }
  }

 private:
  // Whether the socket is ready before the deadline and the server's end.
  bool Await(short event) const {
    std::array<pollfd, 2> files = {{{*socket_, event, 0}, {stop_, POLLIN, 0}}};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(until_ - std::chrono::steady_clock::now()).count();
    return left > 0 && poll(files.data(), files.size(), static_cast<int>(left)) > 0 && files[1].revents == 0;
  }

  base::Descriptor socket_;
  int stop_;
  base::SteadyTime until_ = base::After(LiveServer::kRequestSeconds);
  std::array<char, 4096> block_;
  const char *at_ = nullptr, *end_ = nullptr;
  std::size_t received_ = 0;
  bool answers_ = false;
};

// A thread for each connection, and no more connections than threads.
class Workers : public httplib::TaskQueue {
 public:
  void enqueue(std::function<void()> serve) override {
    pool_.enqueue([this, serve] {
      serve();
      free_.release();
    });
    free_.acquire();  // before the next connection is accepted
  }
  void shutdown() override { pool_.shutdown(); }

 private:
  std::counting_semaphore<LiveServer::kMostConnections> free_{LiveServer::kMostConnections - 1};
  httplib::ThreadPool pool_{LiveServer::kMostConnections};
};

}  // namespace

class LiveServer::Loop : public httplib::Server {
 public:
  Loop() : stop_(eventfd(0, EFD_CLOEXEC)) {
    set_default_headers(SafeHeaders());
    set_pre_routing_handler([this](const httplib::Request& request, httplib::Response& response) {
      Answer(request, response);
      return HandlerResponse::Handled;
    });
    set_payload_max_length(kMostRequestBytes);
    set_socket_options([](socket_t) {});  // without SO_REUSEPORT: no other program may have the port, too
    new_task_queue = [] { return new Workers; };
    const int port = bind_to_any_port("127.0.0.1");
    if (!stop_ || port <= 0 || ::listen(svr_sock_, kMostConnections) != 0)
      throw std::runtime_error("--view: no port can be had on 127.0.0.1");
    host_ = fmt::format("127.0.0.1:{}", port);
    thread_ = std::thread([this] { listen_after_bind(); });
    while (!is_running()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ~Loop() override {
    eventfd_write(*stop_, 1);
    stop();
    thread_.join();
  }

  std::string Address() const { return "http://" + host_ + path_; }
  bool asked() const { return asked_; }
  void Publish(std::string page, std::string data) {
    const std::lock_guard lock(mutex_);
    page_ = std::move(page);
    data_ = std::move(data);
    asked_ = false;
  }

 private:
  bool process_and_close_socket(socket_t socket) override {
    Connection connection(socket, *stop_);
    bool closed = true;
    process_request(connection, true, closed, [](httplib::Request& request) {
      request.headers.erase("Accept-Encoding");  // compression costs the run more than the loopback interface gains
      request.ranges.clear();
    });
    connection.Finish();
    return true;
  }

  void Answer(const httplib::Request& request, httplib::Response& response) {
    response.status = 405;
    if (request.method != "GET") return response.set_header("Allow", "GET");
    response.status = 404;
    const bool page = request.target == path_;
    // Another name that leads here (DNS rebinding) is none of ours.
    if (request.get_header_value_count("Host") != 1 || request.get_header_value("Host") != host_) return;
    if (!page && request.target != path_ + "data") return;
    response.status = 200;
    asked_ = true;
    const std::lock_guard lock(mutex_);
    response.set_content(page ? page_ : data_, page ? "text/html; charset=utf-8" : "application/json");
  }

  const std::string path_ = "/" + Token() + "/";
  std::string host_;
  base::Descriptor stop_;
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
