#include "tools/vobench/live_server.h"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/random.h>

#include <array>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace vobench {
namespace {

constexpr int kThreads = 2;

// Besides the page's own: nobody may frame it, guess at types, keep it or pass its address on.
const httplib::Headers kHeaders = {
    {"Content-Security-Policy",
     "default-src 'none'; img-src data:; style-src 'unsafe-inline'; script-src 'unsafe-inline'; connect-src 'self'; "
     "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"},
    {"X-Content-Type-Options", "nosniff"},
    {"Referrer-Policy", "no-referrer"},
    {"Cache-Control", "no-store"}};

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

}  // namespace

struct LiveServer::State {
  httplib::Server server;
  std::thread thread;
  std::atomic<bool> asked{true};
  std::mutex mutex;  // of what follows
  std::string page = kWaiting, data = "{}";
};

LiveServer::LiveServer() : state_(std::make_unique<State>()) {
  State& state = *state_;
  const std::string host = "127.0.0.1";
  const std::string path = "/" + Token() + "/";
  state.server.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
  state.server.set_default_headers(kHeaders);
  state.server.set_keep_alive_timeout(1);  // [s]: the end waits for it
  const int port = state.server.bind_to_any_port(host);
  if (port <= 0) throw std::runtime_error("--view: no port can be had on " + host);
  address_ = fmt::format("http://{}:{}{}", host, port, path);
  // Another name that leads here (DNS rebinding) is none of ours.
  const std::string name = fmt::format("{}:{}", host, port);
  state.server.set_pre_routing_handler([name](const httplib::Request& request, httplib::Response& response) {
    using Next = httplib::Server::HandlerResponse;
    if (request.method != "GET") {
      response.status = 405;
      response.set_header("Allow", "GET");
      return Next::Handled;
    }
    if (request.get_header_value("Host") == name) return Next::Unhandled;
    response.status = 404;
    return Next::Handled;
  });
  const auto serve = [&state](const std::string State::*what, const char* type) {
    return [&state, what, type](const httplib::Request&, httplib::Response& response) {
      state.asked = true;
      const std::lock_guard lock(state.mutex);
      response.set_content(state.*what, type);
    };
  };
  state.server.Get(path, serve(&State::page, "text/html; charset=utf-8"));
  state.server.Get(path + "data", serve(&State::data, "application/json"));
  state.thread = std::thread([&state] { state.server.listen_after_bind(); });
  while (!state.server.is_running()) std::this_thread::yield();  // or stop() would come too early
}

LiveServer::~LiveServer() {
  state_->server.stop();
  state_->thread.join();
}

bool LiveServer::Asked() const { return state_->asked; }

void LiveServer::Publish(std::string page, std::string data) {
  const std::lock_guard lock(state_->mutex);
  state_->page = std::move(page);
  state_->data = std::move(data);
  state_->asked = false;
}

}  // namespace vobench
